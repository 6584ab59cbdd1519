"""Does the rule of simulation.time_step hold? Every cross-check at the number of steps it chooses, over many linkages.

    python -m studies.time_step [--random 200] [--seed 1] [--out results/time_step.md]

The paper's and the optimised designs at seven cadences with the moments of group p1p2 and with random ones, the former
at 1 and 2 rpm as well, and random linkages 0.15 to 30 mm from their dead centres, at two cadences each.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fes_mj
from fes_mj.common.checks import Check
from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.simulation.time_step import SHARE, TRIAL, predicted_errors, steps_per_turn
from studies.random_linkages import random_design, random_moments

ROOT = Path(__file__).parents[1]
CADENCES, SLOW = (10, 30, 60, 93, 120, 160, 200), (1, 2)  # rpm


@dataclass(frozen=True)
class Trial:
    """One run to be checked."""

    group: str
    design: Design
    moments: fes_mj.JointMoments
    rpm: float
    legs: int = 1


@dataclass(frozen=True)
class Outcome:
    """What became of it; no checks if it was refused."""

    trial: Trial
    steps: float  # a turn
    predicted: float  # W rms
    checks: tuple[Check, ...]
    seconds: float


def trials(count: int, seed: int = 1) -> Iterator[Trial]:
    """All cases; the same for the same seed."""
    rng, group = np.random.default_rng(seed), fes_mj.load_moments("p1p2")
    files = sorted((ROOT / "results" / "optimization").glob("*.toml"))
    named = [("paper", name) for name in DESIGNS] + [("optimised", str(path)) for path in files]
    for title, name in named:
        design = fes_mj.load_design(name)
        for rpm in (*CADENCES, *(SLOW if title == "paper" else ())):
            yield Trial(title, design, group, rpm, legs=1 + int(rng.random() < 0.3))
            yield Trial(title, design, random_moments(rng), rpm)
    for _ in range(count):
        design = random_design(rng)
        for rpm in rng.choice(CADENCES, 2, replace=False):
            yield Trial("random", design, group, float(rpm), legs=1 + int(rng.random() < 0.3))
            yield Trial("random", design, random_moments(rng), float(rpm))


def run(trial: Trial) -> Outcome:
    """Choose the steps, then check once."""
    cadence, start = trial.rpm * RPM, time.perf_counter()
    predicted = predicted_errors(trial.design, cadence, TRIAL).inverse_dynamics
    try:
        steps = steps_per_turn(trial.design, cadence)
    except fes_mj.InputError:
        return Outcome(trial, math.inf, predicted, (), 0.0)
    checks = Case(trial.design, trial.moments, cadence=cadence, legs=trial.legs).checks
    return Outcome(trial, steps, predicted * (2 * math.pi / TRIAL / steps) ** 2, checks, time.perf_counter() - start)


def checks_table(groups: dict[str, list[Outcome]]) -> Table:
    """Value over limit by check."""
    names = [check.name for check in next(iter(groups.values()))[0].checks]
    rows = []
    for group, outcomes in groups.items():
        done = [outcome for outcome in outcomes if outcome.checks]
        worst = [max(check.factor for o in done for check in o.checks if check.name == name) for name in names]
        rows.append((group, len(outcomes), len(outcomes) - len(done), *worst))
    columns = {"linkages": "", "runs": "d", "refused": "d", **{name.replace("_", " "): ".2g" for name in names}}
    failed = [
        f"{o.trial.design.name} at {o.trial.rpm:g} rpm, {o.trial.moments.name}, N = {o.steps}: {check.name}"
        for outcomes in groups.values()
        for o in outcomes
        for check in o.checks
        if not check.ok
    ]
    return Table("Largest value of each check, in limits", columns, rows, f"Failed: {'; '.join(failed) or 'none'}.")


def steps_table(groups: dict[str, list[Outcome]]) -> Table:
    """Steps a turn, and measured per predicted error where that decides their number."""
    rows = []
    for group, outcomes in groups.items():
        done = [outcome for outcome in outcomes if outcome.checks]
        share = np.percentile([outcome.steps for outcome in done], (50, 90, 99, 100))
        deciding = 0.98 * SHARE * next(c.limit for c in done[0].checks if c.name == "inverse_dynamics")
        ratios = [
            check.value / o.predicted
            for o in done
            for check in o.checks
            if check.name == "inverse_dynamics" and o.predicted > deciding and o.trial.legs == 1
        ]
        span = f"{min(ratios):.2f} to {max(ratios):.2f} ({len(ratios)} runs)" if ratios else "never decides"
        rows.append((group, *share, max(outcome.seconds for outcome in done), span))
    columns = {"linkages": "", "median": ".0f", "90 %": ".0f", "99 %": ".0f", "most": ".0f", "slowest, s": ".1f"}
    return Table("Steps a turn", columns | {"measured per predicted rms of the power": ""}, rows)


def main() -> None:
    """Run all, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--random", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "time_step.md")
    arguments = parser.parse_args()
    outcomes = [run(trial) for trial in track([*trials(arguments.random, arguments.seed)], "runs")]
    groups: dict[str, list[Outcome]] = {}
    for outcome in outcomes:
        groups.setdefault(outcome.trial.group, []).append(outcome)
    head = "# Does the chosen time step hold?\n\nWritten by `python -m studies.time_step`; see docs/theory.md.\n"
    write_text(arguments.out, "\n".join([head, checks_table(groups).markdown(), steps_table(groups).markdown()]))


if __name__ == "__main__":
    main()

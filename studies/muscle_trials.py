"""Write results/muscle_trials.md: do intervals from a user's trial hold what is true of riders who are known?

python -m studies.muscle_trials
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.common.writing import write_text
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.averaging import mean_of, weights_on
from fes_mj.moments.files import load_moments, moments_of
from fes_mj.moments.fourier import HARMONICS, TERMS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.muscles.chains import moved
from fes_mj.muscles.identification import Candidates, identify_riders
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.recovery import gains
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.trial import explained_share, measured_moments

ROOT = Path(__file__).parents[1]
PATH = ROOT / "results" / "muscle_trials.md"
SIX_BARS = ("r1", "r2", "d1", "d2")
RIDERS, TURNS = 24, 5
SCATTER = 0.8  # N m, of a turn about the mean in each coefficient of the first four harmonics
CANDIDATES, STEPS, MEMBERS = 600, 80, 100
SHARES = (0.5, 0.8, 0.9)  # of the intervals


def turns_of(values: FloatArray, measured_on: ReferenceTricycle, random: np.random.Generator) -> JointMoments:
    """The mean of turns that scatter about Fourier coefficients (N m, shape (98,)), with the covariance they show."""
    one = [first + order for first in (0, HARMONICS) for order in range(1, 5)]
    columns = [*one, *(TERMS + column for column in one)]
    rows = np.tile(values, (TURNS, 1))
    rows[:, columns] += SCATTER * random.standard_normal((TURNS, len(columns)))
    mean, covariance = mean_of(rows, [("one", "one")] * TURNS, weights_on(measured_on))
    return replace(moments_of(mean, "made up"), covariance=covariance, measured_on=measured_on)


def tables() -> list[Table]:
    """How many of the true gains lie within intervals of the posterior, by six-bar; and how much is explained."""
    example, random = load_moments(ROOT / "examples" / "trial" / "trial.toml"), np.random.default_rng(11)
    truth = replace(Riders("truth", prior_draws(RIDERS, random), np.zeros(RIDERS)), measured_on=example.measured_on)
    exact = measured_moments(example, HARMONICS)
    seen = Candidates.of(truth, exact._replace(covariance=np.zeros_like(exact.covariance) + 1e-9 * np.eye(2 * TERMS)))
    designs, base = [load_design(name) for name in SIX_BARS], load_design("trt")
    ranks, shares, sharper = [], [], []
    for row in range(RIDERS):
        trial = turns_of(seen.simulated(row, random), example.measured_on, random)
        measured = measured_moments(trial)
        members = moved(
            identify_riders(measured, random, CANDIDATES).flattened().members(MEMBERS), measured, random, STEPS
        )
        estimated = gains(members, designs, base)
        ranks.append(np.mean(estimated < gains(members, designs, base, actual=truth.taken([row])), axis=1))
        shares.append(explained_share(members, trial))
        sharper.append(estimated.std(axis=1))
    apart = np.abs(np.array(ranks) - 0.5)
    rows: list[tuple[Any, ...]] = []
    for name, column, deviation in zip(SIX_BARS, apart.T, np.median(sharper, axis=0), strict=True):
        rows.append((name.upper(), *(100 * float(np.mean(column <= share / 2)) for share in SHARES), float(deviation)))
    held = {f"{100 * share:.0f} % intervals hold, %": ".0f" for share in SHARES}
    least, middle = (100 * float(np.quantile(shares, end)) for end in (0, 0.5))
    return [
        Table("Intervals of gains", {"gain of": "", **held, "standard deviation, median": ".3f"}, rows),
        Table("Explained variance", {"least, %": ".0f", "median, %": ".0f"}, [(least, middle)]),
    ]


def main() -> None:
    write_text(PATH, "\n".join([HEADING, *(table.markdown() for table in tables())]))


HEADING = f"""# Muscles from a trial

Written by `python -m studies.muscle_trials`. {RIDERS} riders of the priors, measured on the tricycle of the example by
{TURNS} turns that scatter by {SCATTER:g} N m in every coefficient of four harmonics, with a residual of their own, and
fitted as `fes_mj moments TRIAL --fit-muscles` does ({CANDIDATES} candidates, {STEPS} steps of {MEMBERS} riders).
How many of the true gains, best stimulated, lie within the intervals of the posterior, and how wide that is. With
{RIDERS} riders a share of 80 % is known to {100 * (0.16 / RIDERS) ** 0.5:.0f} %. A trial of which less than 80 % is
explained is refused: none of a rider who fits the model may be.
"""


if __name__ == "__main__":
    main()

"""Write results/muscle_designs.*: is there a linkage that beats the best traditional tricycle under stimulated muscles?

    python -m studies.muscle_designs

The designs are those of results/optimization/muscles; each has the command that finds it in its first lines. Those that
were found for people have what that command said with --json beside them: whose seat is where.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fes_mj.budget.answer import rider_powers
from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.common.writing import json_text, write_text
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.riders import PEOPLE_PER_SEX
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.power import MuscleTurn, best_turn
from fes_mj.muscles.riders import load_riders
from fes_mj.optimization.buildable import Buildability
from fes_mj.optimization.people import sampled
from fes_mj.statics.muscle_static import MuscleStatic

RESULTS = Path(__file__).parents[1] / "results"
FOUND = RESULTS / "optimization" / "muscles"
KINDS = ("trt", "crt", "cdt")
ENDS = (0.05, 0.5, 0.95)


class Solved(NamedTuple):
    """A design under an ensemble: its turn with windows common to all riders; each one's power with his own, W.

    drawn: each one's power on a linkage and with legs that are drawn as well, W, NaN where these do not turn. agrees:
    whether a simulation of the most probable rider does with statics.
    """

    name: str
    static: MuscleStatic
    own: FloatArray
    drawn: FloatArray
    agrees: bool

    @property
    def turn(self) -> MuscleTurn:
        assert self.static.stimulated.turn
        return self.static.stimulated.turn


def solved(group: str) -> list[Solved]:
    """The paper's designs and those found for the group's riders, the best tricycle first."""
    riders, rows = load_riders(group), []
    names: list[str | Path] = [*(FOUND / f"{kind}-{group}.toml" for kind in KINDS), *DESIGNS]
    ending = "again-p1p3" if group == "p1p3" else ("again", "fast", "population")
    names += [path for path in sorted(FOUND.glob("*.toml")) if path.stem.endswith(ending)]
    for name in names:
        design = load_design(name)
        static = MuscleStatic.solve(design, riders, design.linkage.cadence, "best")
        each_best, _ = best_turn(riders, design, each_its_own=True)
        agrees = Case(design, Muscles(riders)).agrees
        rows.append(Solved(Path(name).stem, static, each_best.power_mean[:, 0], rider_powers(design, riders), agrees))
    return rows


def gains(group: str, designs: list[Solved]) -> Iterator[tuple[Any, ...]]:
    """Of each design over the best tricycle, member by member."""
    best = designs[0]
    for one in designs:
        ratio, unshared = one.static.powers / best.static.powers, one.own / best.own
        quantiles = (float(value) for value in np.quantile(ratio, ENDS))
        with_all = one.drawn / best.drawn
        drawn = (float(value) for value in np.nanquantile(with_all, ENDS))
        shares = (100 * float(np.mean(np.nan_to_num(gain) > 1)) for gain in (ratio, unshared, with_all))
        leaves = ", ".join(Buildability.of(one.static).broken()) or "none"
        yield (group, one.name, one.static.cadence / RPM, one.static.power_mean, one.static.power_sd, *quantiles,
               *(shares if one is not best else (None,) * 3), *drawn, leaves, _word(one.agrees))  # fmt: skip


def _word(agrees: bool) -> str:
    return "yes" if agrees else "NO"


def people() -> Iterator[tuple[Any, ...]]:
    """Of the designs for people: expected power over the sample, each in a seat of his or her own, member by member."""
    riders, share = load_riders("p1p2"), sampled("population", PEOPLE_PER_SEX, 0).plane.mean(axis=0)
    of_each: dict[str, FloatArray] = {}
    for kind in KINDS:
        design, powers, agree = load_design(FOUND / f"{kind}-population.toml"), [], []
        for seated in _seated(design):
            static = MuscleStatic.solve(seated, riders, seated.linkage.cadence, "best")
            powers.append(static.powers)
            agree.append(Case(seated, Muscles(riders)).agrees)
        of_each[kind] = np.array(share @ powers)
        ratio = of_each[kind] / of_each["trt"]
        quantiles = (float(value) for value in np.quantile(ratio, ENDS))
        more = None if kind == "trt" else 100 * float(np.mean(ratio > 1))
        yield (design.name, design.linkage.cadence / RPM, float(of_each[kind].mean()), float(of_each[kind].std()),
               float(np.mean(powers[0])), *quantiles, more, _word(all(agree)))  # fmt: skip


def _seated(design: Design) -> Iterator[Design]:
    """With each rider for whom it was searched, in his or her seat; as drawn first."""
    record = json.loads((FOUND / f"{design.name}.json").read_text(encoding="utf-8"))
    for rider in record["riders"]:
        ground = design.linkage.ground + rider["forward_m"] - 1j * rider["up_m"]
        one = design.with_rider(thigh=rider["thigh"], shank=rider["shank"])
        yield one.with_linkage(ground=ground, seat_angle=math.radians(rider["seat_angle_deg"]))


def reasons(group: str, designs: list[Solved]) -> Iterator[tuple[Any, ...]]:
    """Where the power comes from: work of each muscle group a turn, how fast joints move, when a leg brakes."""
    for one in designs:
        turn, static = one.turn, one.static
        power = np.mean(turn.activation * turn.pulled.power, axis=(1, 3))[:, 0]
        turns = turns_per_second(static.cadence)
        speeds = (360 * turns * float(np.abs(rate).mean()) for rate in static.motion.joint_rate)
        ranges = (float(np.ptp(ends)) for ends in static.joint_range_deg)
        extending = 100 * float(np.mean(static.motion.joint_rate.knee > 0))
        summary = static.summary()
        yield (group, one.name, *(power / turns).tolist(), *ranges, *speeds, extending,
               summary["power_two_legs_min_W"],
               100 * summary["negative_share"])  # fmt: skip


def verdict(group: str, designs: list[Solved]) -> str:
    """Whether a linkage beats the best tricycle with 95 %, in a sentence."""
    best, *others = (one for one in designs if one.name not in DESIGNS)
    share, ratio, name = max(
        (
            float(np.mean(np.nan_to_num(one.drawn) > np.nan_to_num(best.drawn))),
            one.static.power_mean / best.static.power_mean,
            one.name,
        )
        for one in others
    )
    error = np.sqrt(share * (1 - share) / len(best.own))
    word = "beats" if share - error >= 0.95 else "does not beat" if share + error < 0.95 else "may or may not beat"
    paper = next(one for one in designs if one.name == "trt").static.power_mean
    return (
        f"{group.upper()}: the best linkage found, {name}, {word} the best traditional tricycle with 95 %: "
        f"{100 * share:.0f} ± {100 * error:.0f} % of the members have more with everything drawn, in expectation "
        f"{ratio:.2f} times as much. That tricycle has {best.static.power_mean / paper:.2f} times the power of the "
        "paper's."
    )


def main() -> int:
    by_group = {group: solved(group) for group in RIDER_GROUPS}
    verdicts = [verdict(group, designs) for group, designs in by_group.items()]
    over = Table(
        "Power beside the best traditional tricycle",
        {"group": "", "design": "", "cadence, rpm": ".0f", "power, W": ".2f", "± over members, W": ".2f",
         **dict.fromkeys(("per the best TRT, 5 %", "50 %", "95 %"), ".2f"),
         **dict.fromkeys(("members with more, %", "with windows of their own, %", "with all drawn, %"), ".0f"),
         **dict.fromkeys(("all drawn, 5 %", "all drawn, 50 %", "all drawn, 95 %"), ".2f"), "limits it leaves": "",
         "simulated: agrees": ""},
        [row for group, designs in by_group.items() for row in gains(group, designs)],
        "One leg, all members of the ensemble, windows of at most 100 deg that are the best in expectation; and each "
        "member with windows of his own. All drawn: every member on a linkage and with legs that are drawn as well, "
        "which is all that is not known of a rider's power but the anatomy.",
    )  # fmt: skip
    why = Table(
        "Where it comes from",
        {"group": "", "design": "", **{f"{name}, J a turn": ".2f" for name in MUSCLE_GROUPS}, "knee range, deg": ".0f",
         "hip range, deg": ".0f", "knee speed, deg/s": ".0f", "hip speed, deg/s": ".0f",
         "knee extends, % of the turn": ".0f", "both legs, least, W": ".1f",
         "both legs below 0, %": ".0f"},
        [row for group, designs in by_group.items() for row in reasons(group, designs)],
        "Work of the stimulated muscles on the crank, mean absolute joint speeds, expected power of both legs.",
    )  # fmt: skip
    for_people = Table(
        "For people",
        {"design": "", "cadence, rpm": ".0f", "power, W": ".2f", "± over members, W": ".2f", "as drawn, W": ".2f",
         **dict.fromkeys(("per the best TRT, 5 %", "50 %", "95 %"), ".2f"), "members with more, %": ".0f",
         "simulated: agrees": ""},
        [*people()],
        f"P1P2's muscles in the legs of {PEOPLE_PER_SEX:,} men and as many women (ANSUR II), of whom five stand for "
        "all, each in a seat of his or her own; power of one leg in the mean of all, and as drawn that of the "
        "paper's rider.",
    )  # fmt: skip
    tables = (over, why, for_people)
    rows = {table.title: table.records() for table in tables}
    write_text(RESULTS / "muscle_designs.json", json_text({"provenance": provenance(), "verdicts": verdicts, **rows}))
    parts = [HEADING, "\n\n".join(verdicts) + "\n", *(table.markdown() for table in tables)]
    write_text(RESULTS / "muscle_designs.md", "\n".join(parts))
    return 0


HEADING = """# Designs for muscles

Written by `python -m studies.muscle_designs`. All classes were searched under the same limits: those of what can be
built, mean joint speeds up to the TRT's, gear ratio up to 2.10, windows of at most 100 deg; twelve members stood for
the ensemble in the search (3 searches of 4,000 evaluations), all 200 count here. The members differ in all that is
unknown of a rider but the anatomy, which is one. A design is the best of those tried: on another ensemble it would have
less of a lead. Every turn was simulated in MuJoCo, by the muscles of the most probable rider, and compared with
statics. trt-fast and crt-fast were found without limits on joint speeds (one search of 4,000 evaluations). Designs for
people were searched for once each (CMA-ES) from the best for the paper's rider, with 5,000 evaluations for the TRT and
2,500 for the others; all five who stand for people have to keep all limits, and the paper's rider as well. That
crt-population gives him more than crt-p1p2 shows that the searches for six-bars had not come to their end: those named
*again* are one more each, for every class and group alike, from the best then known (CMA-ES, 4,000 evaluations). They
add nothing to the TRT. No rider has been measured on any of these linkages.
"""


if __name__ == "__main__":
    sys.exit(main())

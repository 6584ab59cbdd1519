"""Write results/muscles.*: what stimulated muscles leave of the paper's gains, with intervals.

python -m studies.muscles [ANATOMY.toml], a second anatomy that tools/make_muscles.py wrote and that may not be passed
on; without it its rows are left as they were measured.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.common.writing import json_text, write_text
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.joint_moments import GROUPS as RIDER_GROUPS
from fes_mj.muscles.anatomy import GROUPS, Anatomy, anatomy
from fes_mj.muscles.by_angle import null_test
from fes_mj.muscles.power import MuscleTurn, best_turn
from fes_mj.muscles.prior import drawn, priors
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.rules import RULES, stimulated
from fes_mj.muscles.timing import ANGLES, DUTY, activation, best_windows
from fes_mj.paper.evidence import load_evidence, of_group

PATH = Path(__file__).parents[1] / "results" / "muscles.md"
SECOND = "Each group alone, another anatomy"
SIX_BARS = ("r1", "r2", "d1", "d2")
KNOWN = 400  # riders of the prior in the null test
WIDTHS = (70, 100, 130)  # deg
MEASURED_W = (8, 35)  # both legs, of FES cycling (Szecsi 2014, doi:10.1186/1743-0003-11-123)
ENDS = (0.05, 0.5, 0.95)


def riders_of_prior(count: int, **fixed: float) -> Riders:
    """Riders of the prior, with these quantities at one value."""
    values = drawn(count, np.random.default_rng(26)) | {name: np.full(count, value) for name, value in fixed.items()}
    return Riders("prior", values, np.zeros(count))


def null_rows() -> Iterator[tuple[Any, ...]]:
    """True and by-angle gain of riders who are known."""
    gains = null_test(riders_of_prior(KNOWN), [load_design(name) for name in SIX_BARS])
    paper = {row.design: row.value for row in of_group(load_evidence(), "p1p2") if row.quantity == "power"}
    for name, true, said in zip(SIX_BARS, gains.true, gains.by_angle, strict=True):
        correlation = float(np.corrcoef(true, said)[0, 1])
        yield name.upper(), *quantiles(true), *quantiles(said), paper[name] / paper["trt"], correlation


def quantiles(values: FloatArray) -> list[float]:
    return [float(value) for value in np.quantile(values, ENDS)]


def group_powers(riders: Riders, name: str, muscles: Anatomy) -> FloatArray:
    """Mean power of each group alone, W, each member best stimulated, shape (groups, members)."""
    design = load_design(name)
    pulled = pull(riders, kinematics.solve(design, ANGLES), design.linkage.cadence, muscles)
    windows, _ = best_windows(pulled.power, riders, design.linkage.cadence, each_its_own=True)
    answers = activation(windows, riders, design.linkage.cadence)
    return np.asarray(np.mean(answers * pulled.power, axis=-1)[..., 0])


def group_rows(muscles: Anatomy, title: str) -> Iterator[tuple[Any, ...]]:
    """Gain of each group alone for time constants, without any fit; and of the vasti alone."""
    centre = {name: float(np.median(values)) for name, values in drawn(4001, np.random.default_rng(1)).items()}
    groups = [*((name, number, 1.0) for number, name in enumerate(GROUPS)), ("vasti", 0, 0.0)]
    for rise in (0.05, 0.07, 0.10):
        for group, number, rectus in groups:
            rider = riders_of_prior(1, **centre | {"rise_s": rise, "rectus_recruitment": rectus})
            powers = {name: float(group_powers(rider, name, muscles)[number, 0]) for name in DESIGNS}
            yield title, group, rise, *(powers[name] / powers["trt"] for name in SIX_BARS)


def gain_rows(cadence_rpm: float | None) -> Iterator[tuple[Any, ...]]:
    """Gains of both rider groups by rule and width; at the paper's gears, or all at one cadence."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        cases = [(rule, DUTY) for rule in RULES[1:]] + [(RULES[0], width / 360) for width in WIDTHS]
        for rule, duty in cases:
            powers = {}
            for name in DESIGNS:
                design = load_design(name)
                cadence = design.linkage.cadence if cadence_rpm is None else cadence_rpm * RPM
                powers[name] = stimulated(rule, riders, design, cadence, duty).power.mean(axis=1)
            title = f"best, {360 * duty:.0f} deg" if rule == RULES[0] else rule
            for name in SIX_BARS:
                gain = powers[name] / powers["trt"]
                above = [100 * float(np.mean(gain > least)) for least in (1, 1.25, 2)]
                beats = 100 * float(np.mean(powers[name] > powers["r1"])) if name != "r1" else None
                yield group, title, name.upper(), float(powers[name].mean()), *quantiles(gain), *above, beats


def power_rows() -> Iterator[tuple[Any, ...]]:
    """Powers, dead spots, windows and what mistimed windows cost, of both rider groups best stimulated."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        for name in DESIGNS:
            design = load_design(name)
            turn, windows = best_turn(riders, design)
            both, power = turn.two_legs[:, 0].mean(axis=0), turn.power_mean[:, 0]
            work = power / turns_per_second(design.linkage.cadence)
            mistimed = [
                MuscleTurn(turn.pulled, activation(windows.shifted(shift), riders, design.linkage.cadence))
                for shift in (-20, 20)
            ]
            losses = [100 * (1 - float(late.power_mean.mean() / power.mean())) for late in mistimed]
            ends = "; ".join(
                f"{on:.0f} to {(on + width) % 360:.0f}" if width else "-"
                for on, width in zip(windows.on[:, 0, 0], windows.width[:, 0, 0], strict=True)
            )
            above = 100 * float(np.mean(2 * power > MEASURED_W[1]))
            dead = (float(both.min()), 100 * float(np.mean(both < 0)))
            yield group, name.upper(), *quantiles(2 * power), above, float(work.mean()), *dead, *losses, ends


def posterior_rows() -> Iterator[tuple[Any, ...]]:
    """Prior beside posterior of every quantity, and its share of the variance of D1's gain."""
    prior = drawn(20_000, np.random.default_rng(2))
    columns = {}
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        d1, trt = (best_turn(riders, load_design(name))[0].power_mean[:, 0] for name in ("d1", "trt"))
        columns[group] = riders.values, d1 / trt
    for name, row in priors().items():
        cells: list[Any] = [name, row["unit"], *quantiles(prior[name])]
        for values, gain in columns.values():
            narrowed = float(values[name].std() / prior[name].std())
            said = "not identified" if narrowed > 0.9 else f"{narrowed:.2f}"
            cells += [*quantiles(values[name]), said, 100 * float(np.corrcoef(values[name], gain)[0, 1] ** 2)]
        yield tuple(cells)


def experiment_rows() -> Iterator[tuple[Any, ...]]:
    """How well the power of a standard tricycle at two cadences predicts D1's gain."""
    for group in RIDER_GROUPS:
        riders, trt = load_riders(group), load_design("trt")
        fast, slow = (best_turn(riders, trt, rpm * RPM)[0].power_mean[:, 0] for rpm in (96, 60))
        gain = best_turn(riders, load_design("d1"))[0].power_mean[:, 0] / slow
        slope, level = np.polyfit(fast / slow, gain, 1)
        yield group, *quantiles(fast / slow), float(np.corrcoef(fast / slow, gain)[0, 1]), float(level), float(slope)


def spread(name: str, spec: str = ".2f") -> dict[str, str]:
    """Columns of the quantiles of something."""
    return {f"{name} {100 * end:.0f} %": spec for end in ENDS}


GAIN = {"group": "", "timing": "", "design": "", "power, W": ".1f", **spread("gain")} | {
    f"P(gain > {least}), %": ".1f" for least in (1, 1.25, 2)
}
ALONE = {"anatomy": "", "muscles": "", "rise, s": ".2f", **{name.upper(): ".2f" for name in SIX_BARS}}


def tables(second: Anatomy | None) -> list[Table]:
    """All tables of the page; without a second anatomy its rows as they were measured."""
    alone = [*group_rows(anatomy(), "gait2392")]
    if second:
        other = [*group_rows(second, "rajagopal")]
    else:
        other = [tuple(row.values()) for row in json.loads(PATH.with_suffix(".json").read_text())[SECOND]]
    posterior = {"quantity": "", "unit": "", **spread("prior", ".3g")}
    for group in RIDER_GROUPS:
        posterior |= spread(group, ".3g") | {f"{group} narrowed to": "", f"{group} of D1's variance, %": ".0f"}
    power = {"group": "", "design": "", **spread("both legs, W,", ".1f"), f"P(> {MEASURED_W[1]} W), %": ".0f"}
    power |= {"work of a leg, J": ".1f", "both legs, least, W": ".1f", "both legs below 0, % of the turn": ".0f"}
    power |= {"20 deg early costs, %": ".0f", "20 deg late, %": ".0f", "windows, deg": ""}
    null = {"design": "", **spread("true"), **spread("by angle"), "the paper": ".2f", "correlation": ".2f"}
    trial = {"group": "", **spread("P96/P60"), "correlation with D1's gain": ".2f", "level": ".2f", "slope": ".2f"}
    return [
        Table("Null test", null, [*null_rows()]),
        Table("Each group alone", ALONE, alone),
        Table(SECOND, ALONE, other),
        Table("Gains at the paper's gears", GAIN | {"P(> R1), %": ".1f"}, [*gain_rows(None)]),
        Table("Gains at 60 rpm", GAIN | {"P(> R1), %": ".1f"}, [*gain_rows(60.0)]),
        Table("Powers and dead spots", power, [*power_rows()]),
        Table("Prior beside posterior", posterior, [*posterior_rows()]),
        Table("An experiment without a six-bar", trial, [*experiment_rows()]),
    ]


def main() -> None:
    second = anatomy(Path(sys.argv[1])) if sys.argv[1:] else None
    made = tables(second)
    write_text(PATH, "\n".join([HEADING, *(table._replace(note=NOTES[table.title]).markdown() for table in made)]))
    write_text(PATH.with_suffix(".json"), json_text({table.title: table.records() for table in made}))


HEADING = """# Muscles: what is left of the gain

Written by `python -m studies.muscles`; the model, its sources and the rules of timing: [muscles](../docs/muscles.md).
Gains are mean power per the TRT's, under one rule in every column; 5, 50 and 95 % are over the riders who may have been
measured. No rider has been measured on any of these linkages.
"""
NOTES = {
    "Null test": f"""\
{KNOWN} riders of the priors, each stimulated at its own best on every linkage (*true*), and what the
paper's rule makes of their moments on the TRT. It makes gains for riders who lose, and hardly knows who gains.""",
    "Each group alone": """\
A rider at the middle of every prior but for the rise; *vasti* are the quadriceps without rectus
femoris. Before any fit: a design's gain is a mixture of these.""",
    SECOND: """\
The same with lengths and parameters of Rajagopal et al. 2016 (doi:10.1109/TBME.2016.2586891), knees by Lai et
al. 2017 and Uhlrich et al. 2022, which may not be passed on.""",
    "Gains at the paper's gears": """\
*best* is for a largest width of the windows. *by-angle* is the paper's rule on the
muscles' part of the moments.""",
    "Gains at 60 rpm": "All linkages at the cadence of the measurement: what of a loss is speed.",
    "Powers and dead spots": f"""\
Best stimulation. Measured FES cycling gives {MEASURED_W[0]} to {MEASURED_W[1]} W with both
legs (Szecsi et al. 2014, doi:10.1186/1743-0003-11-123): absolute watts are not identified. *Least* and *below 0* are of
the expected power of both legs: whether a linkage removes dead spots.""",
    "Prior beside posterior": """\
*Narrowed to*: standard deviation per the prior's; above 0.9 the evidence does not identify a
quantity. The last column of each group: the squared correlation with D1's gain.""",
    "An experiment without a six-bar": """\
Best-timed power of a standard tricycle at 96 rpm per that at 60 rpm, and the line
by which it predicts D1's gain.""",
}


if __name__ == "__main__":
    main()

"""Write results/muscles.* and their pictures: what stimulated muscles leave of the paper's gains, with intervals.

python -m studies.muscles [ANATOMY.toml], a second anatomy that tools/make_muscles.py wrote and that may not be passed
on; without it its rows are left as they were measured.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from fes_mj.common.markdown import Table
from fes_mj.common.writing import json_text, write_text
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.fatigue import FALL, FLOOR, RECOVERY
from fes_mj.muscles.trial import ENDS
from studies.muscles import figures, gains, unknowns, use
from studies.muscles.gains import MEASURED_W

PATH = Path(__file__).parents[2] / "results" / "muscles.md"
ALONE_SECOND = "Each group alone, another anatomy"
SECOND = "Two anatomies"


def spread(name: str, spec: str = ".2f") -> dict[str, str]:
    """Columns of the quantiles of something."""
    return {f"{name} {100 * end:.0f} %": spec for end in ENDS}


GAIN = {"group": "", "timing": "", "design": "", "power, W": ".1f", **spread("gain"), **spread("per turn")}
GAIN |= {f"P(gain > {least}), %": ".1f" for least in (1, 1.25, 2)} | {"P(> R1), %": ".1f"}
ALONE = {"anatomy": "", "muscles": "", "rise, s": ".2f", **{name.upper(): ".2f" for name in SIX_BARS}}
POWER = {"group": "", "design": "", **spread("both legs, W,", ".1f")}
POWER |= {f"P({MEASURED_W[0]} to {MEASURED_W[1]} W), %": ".0f", f"P(> {MEASURED_W[1]} W), %": ".0f"}
POWER |= {"work of a leg, J": ".1f", "both legs, least, W": ".1f", "both legs below 0, % of the turn": ".0f"}
POWER |= {"20 deg early costs, %": ".0f", "20 deg late, %": ".0f", "windows, deg": ""}
POSTERIOR = {"quantity": "", "unit": "", **spread("prior", ".3g")}
for _group in RIDER_GROUPS:
    POSTERIOR |= spread(_group, ".3g") | {f"{_group} narrowed to": "", f"{_group} of D1's variance, %": ".0f"}
SENSITIVITY = {"group": "", "quantity": "", "what": "", "low": ".3g", "high": ".3g"}
SENSITIVITY |= {f"{name} {end}": ".2f" for name in ("R1", "D1") for end in ("low", "high")}
REVERSAL = {"group": "", "riders": "", "how many": ".0f", **spread("D1"), "P(D1 > TRT), %": ".0f"}
CADENCE = {"group": "", "rpm": ".0f", **{f"{name}, W": ".1f" for name in ("TRT", *map(str.upper, SIX_BARS))}}
CADENCE |= {"P(D1 > TRT), %": ".0f", "P(D1 > TRT at its best), %": ".0f"}
BEST_CADENCE = {"group": "", "design": "", "rpm": ".0f", "both legs, W": ".1f", **spread("per TRT")}
BEST_CADENCE |= {"P(> TRT), %": ".0f"}
FATIGUE = {"group": "", "design": "", "widest, deg": ".0f", "recovery": "", "duty": ".2f"}
FATIGUE |= {f"both legs, W, {when}": ".1f" for when in ("fresh", "2 min", "30 min", "mean")}
FATIGUE |= {f"force of {group} at 30 min": ".2f" for group in ("quadriceps", "hamstrings", "gluteus")}
CHECK = {
    "recovery": "",
    "its time, s": ".0f",
    "force in the end at half the time, %": ".0f",
    "measured, %": ".0f",
}
NULL = {"design": "", **spread("true"), **spread("by angle"), "the paper": ".2f", "correlation": ".2f"}
TRIAL = {"group": "", **spread("P96/P60"), "correlation with D1's gain": ".2f", "level": ".2f", "slope": ".2f"}
ANATOMIES = {"anatomy": "", "group": "", "design": "", **spread("gain"), "P(gain > 1), %": ".0f"}


def tables(second: Path | None) -> list[Table]:
    """All tables of the page; without a second anatomy its rows as they were measured."""
    other = anatomy(second) if second else None
    kept = {} if other else json.loads(PATH.with_suffix(".json").read_text())

    def again(title: str) -> list[tuple[Any, ...]]:
        rows = (tuple(row.values()) for row in kept[title])
        return [row for row in rows if row[0] == "rajagopal"]

    alone = [*gains.group_rows(other, "rajagopal")] if other else again(ALONE_SECOND)
    both = [*unknowns.anatomy_rows("gait2392", None)]
    both += [*unknowns.anatomy_rows("rajagopal", other)] if other else again(SECOND)
    return [
        Table("Null test", NULL, [*gains.null_rows()]),
        Table("Each group alone", ALONE, [*gains.group_rows(anatomy(), "gait2392")]),
        Table(ALONE_SECOND, ALONE, alone),
        Table("Gains at the paper's gears", GAIN, [*gains.gain_rows(None)]),
        Table("Gains at 60 rpm", GAIN, [*gains.gain_rows(60.0)]),
        Table("Powers and dead spots", POWER, [*gains.power_rows()]),
        Table("Power by cadence", CADENCE, [*use.cadence_rows()]),
        Table("Every design at its best cadence", BEST_CADENCE, [*use.best_cadence_rows()]),
        Table("Half an hour", FATIGUE, [*use.fatigue_rows()]),
        Table("Fatigue beside a measurement", CHECK, [*use.fatigue_check()]),
        Table("Prior beside posterior", POSTERIOR, [*unknowns.posterior_rows()]),
        Table("Sensitivity", SENSITIVITY, [*unknowns.sensitivity_rows()]),
        Table(SECOND, ANATOMIES, both),
        Table("What would reverse the verdict", REVERSAL, [*unknowns.reversal_rows()]),
        Table("An experiment without a six-bar", TRIAL, [*unknowns.experiment_rows()]),
    ]


def main() -> None:
    page_tables = tables(Path(sys.argv[1]) if sys.argv[1:] else None)
    write_text(
        PATH, "\n".join([HEADING, *(table._replace(note=NOTES[table.title]).markdown() for table in page_tables)])
    )
    write_text(PATH.with_suffix(".json"), json_text({table.title: table.records() for table in page_tables}))
    figures.write(PATH.parent, {table.title: table.records() for table in page_tables})


HEADING = """# Muscles: what is left of the gain

Written by `python -m studies.muscles`; the model, its sources and the rules of timing: [muscles](../docs/muscles.md).
Gains are mean power per the TRT's, under one rule in every column; 5, 50 and 95 % are over the riders who may have been
measured. No rider has been measured on any of these linkages.

![True gains, by-angle gains and the paper's](muscles-null-test.png)

![Gains with their intervals, by rule, at the paper's gears and at one cadence](muscles-gains.png)

![Best windows and the power of both legs over the turn](muscles-windows.png)

![Power by cadence, and over half an hour](muscles-fatigue.png)
"""
NOTES = {
    "Null test": f"""\
{gains.KNOWN} riders of the priors, each stimulated at its own best on every linkage (*true*), and what the
paper's rule makes of their moments on the TRT. It makes gains for riders who lose, and hardly knows who gains.""",
    "Each group alone": """\
A rider at the middle of every prior but for the rise; *vasti* are the quadriceps without rectus
femoris. Before any fit: a design's gain is a mixture of these.""",
    ALONE_SECOND: """\
The same with lengths and parameters of Rajagopal et al. 2016 (doi:10.1109/TBME.2016.2586891), knees by Lai et
al. 2017 and Uhlrich et al. 2022, which may not be passed on.""",
    "Gains at the paper's gears": """\
*best* is for a largest width of the windows. *by-angle* is the paper's rule on the
muscles' part of the moments. *power* is one leg's, *per turn* the gain of work per turn.""",
    "Gains at 60 rpm": "All linkages at the cadence of the measurement: what of a loss is speed.",
    "Powers and dead spots": f"""\
Best stimulation. Measured FES cycling gives {MEASURED_W[0]} to {MEASURED_W[1]} W with both
legs (Szecsi et al. 2014, doi:10.1186/1743-0003-11-123): absolute watts are not identified. *Least* and *below 0* are of
the expected power of both legs: whether a linkage removes dead spots.""",
    "Power by cadence": """\
Expected power of both legs, best stimulation at every cadence. *At its best*: D1 at this cadence, the TRT at the one
that is best for it.""",
    "Every design at its best cadence": """\
What gears can do: every linkage at the cadence of the table above with the largest expected power.""",
    "Half an hour": f"""\
Expected power of both legs at one cadence (the paper's gears) under best stimulation of a largest width, with force
that falls with activation within {FALL:g} s towards {FLOOR:g} and comes back (fes_mj/muscles/fatigue.py). *Published*:
within {RECOVERY:g} s; *as Bickel measured*: as slowly as their measurement asks for. Either falls for minutes and then
stays: what tires a rider for longer is in neither.""",
    "Fatigue beside a measurement": """\
Paralysed quadriceps lost 67 % of their force in 180 contractions, half of the time stimulated (Bickel et al. 2004, JRRD
41:33).""",
    "Prior beside posterior": """\
*Narrowed to*: standard deviation per the prior's; above 0.9 the evidence does not identify a
quantity. The last column of each group: the squared correlation with D1's gain.""",
    "Sensitivity": """\
Median gain with one quantity changed in all riders, everything else as it is; of what was learned from the evidence, in
the third of the riders with least and in that with most of it. The anatomy: next table.""",
    SECOND: "The same riders with the lengths and parameters of either anatomy, stimulated as is best for each.",
    "What would reverse the verdict": """\
Riders of the ensemble of whom this were known, and all of them if this were so. P96/P60: best-timed power of a standard
tricycle at 96 rpm per that at 60 rpm.""",
    "An experiment without a six-bar": """\
Best-timed power of a standard tricycle at 96 rpm per that at 60 rpm, and the line
by which it predicts D1's gain.""",
}


if __name__ == "__main__":
    main()

"""Write the table of the ten runs into README.md; the tests hold it against fresh runs."""

from pathlib import Path

from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.paper.printed import table1

README = Path(__file__).parents[1] / "README.md"
START, END = "<!-- ten runs: written by tools/update_readme.py -->\n", "<!-- end of ten runs -->\n"


def ten_runs() -> Table:
    """Design and group, cadence, static, dynamic, their difference, and the paper's power."""
    rows = []
    for name in DESIGNS:
        for group in GROUPS:
            case = Case(load_design(name), load_moments(group))
            difference = round(100 * case.relative_difference, 3) + 0.0  # no minus zero
            powers = (case.static.power_mean, case.simulation.power_mean, difference, table1()[name].power[group])
            rows.append((name.upper(), group.upper(), case.cadence / RPM, *powers))
    columns = {
        "design": "",
        "group": "",
        "cadence, rpm": ".1f",
        "static, W": ".2f",
        "dynamic, W": ".2f",
        "difference, %": "+.3f",
        "paper, W": ".2f",
    }
    return Table("", columns, rows)


def main() -> None:
    """Replace what stands between the two marks."""
    text = README.read_text(encoding="utf-8")
    before, rest = text.split(START)
    write_text(README, before + START + ten_runs().markdown() + END + rest.split(END)[1])


if __name__ == "__main__":
    main()

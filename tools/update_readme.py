"""Write the table of the ten runs into README.md; the tests hold it against fresh runs."""

import math
from pathlib import Path

from fes_mj.crosscheck import cross_check
from fes_mj.design_file import CATALOGUE, load_design
from fes_mj.files import write_text
from fes_mj.paper.printed import table1
from fes_mj.torque import GROUPS, load_moments

README = Path(__file__).parents[1] / "README.md"
START, END = "<!-- ten runs: written by tools/update_readme.py -->\n", "<!-- end of ten runs -->\n"


def ten_runs() -> str:
    """The table in Markdown: design and group, cadence, static, dynamic, their difference, and the paper's power."""
    lines = [
        "| design | group | cadence, rpm | static, W | dynamic, W | difference, % | paper, W |",
        "|---|---|---:|---:|---:|---:|---:|",
    ]
    for name in CATALOGUE:
        for group in GROUPS:
            result = cross_check(load_design(name), load_moments(group))
            difference = round(100 * result.relative_difference, 3) + 0.0  # no minus zero
            rpm = load_design(name).linkage.cadence * 30 / math.pi
            lines.append(
                f"| {name.upper()} | {group.upper()} | {rpm:.1f} | {result.static.power_mean:.2f} "
                f"| {result.simulation.power_mean:.2f} | {difference:+.3f} "
                f"| {table1()[name].power[group]:.2f} |"
            )
    return "\n".join(lines) + "\n"


def main() -> None:
    """Replace what stands between the two marks."""
    text = README.read_text(encoding="utf-8")
    before, rest = text.split(START)
    write_text(README, before + START + ten_runs() + END + rest.split(END)[1])


if __name__ == "__main__":
    main()

"""`fes_mj stimulation --drive moments`: where the linkage alone lets moments drive the crank."""

from collections.abc import Sequence
from pathlib import Path

from fes_mj.cli.drive import MusclesFirst
from fes_mj.cli.options import MomentsOptions, PrintOptions
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import InputError
from fes_mj.common.writing import write_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import CRANK_ZERO
from fes_mj.muscles.rules import BEST
from fes_mj.muscles.timing import DUTY
from fes_mj.riding.stimulation import CORE, Window, stimulation as find_windows, summary, table_csv


def by_moments(
    design: Design,
    legs: int,
    cadence: list[float] | None,
    whose: MomentsOptions,
    drive: MusclesFirst,
    csv: Path | None,
    pages: Sequence[Path],
    options: PrintOptions,
) -> None:
    """Windows of the linkage alone."""
    given = {
        "--cadence": cadence,
        "--moments": whose.moments,
        "--group": whose.group,
        "--muscles": drive.muscles,
        "--duty": drive.duty != DUTY,
        "--timing": drive.timing != BEST,
    }
    if said := [flag for flag, value in given.items() if value]:
        raise InputError(
            f"{said[0]}: where moments drive the crank depends on the linkage alone; leave it out, or use --drive "
            "muscles"
        )
    windows = find_windows(design, legs)
    if pages:
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.rings import windows_figure

        for page in pages:
            write_figure(page, windows_figure, design, windows)
    if csv:
        write_text(csv, table_csv(design, windows))
    options.show(lambda: summary(design, windows), lambda: _print(design, windows), windows=csv)
    for page in pages:
        options.name_files(page=page)


def _print(design: Design, windows: list[Window]) -> None:
    rows = []
    for record in (window.record(design) for window in windows if window.leg == "right"):
        spans = (
            f"{on:.0f} to {off:.0f}" for on, off in (record[f"{w}_deg"] for w in ("works", "works_from_tdc", "core"))
        )
        works, from_top, core = spans
        name = f"{record['muscle']} ({record['moment']})"
        rows.append(
            (name, f"{works} ({record['width_deg']:.0f})", from_top, f"{core} ({record['core_width_deg']:.0f})")
        )
    columns = ("muscle", "drives the crank (width)", "from top dead centre", "core of it (width)")
    print_table(f"{design.name}, right leg; crank angles in deg", columns, rows)
    left = "; the left leg's are 180 deg later" if any(window.leg == "left" for window in windows) else ""
    say(f"0: {CRANK_ZERO}{left}.")
    say(f"Core: the joint moves at least {CORE:g} times as fast per crank angle as at best in the window.")
    say("A stimulated muscle answers late and weakens with speed: --drive muscles says when to stimulate.")

"""`fes_mj stimulation`: settings of a stimulator for a design and seat, or where moments drive its crank."""

from functools import partial
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.drive import MusclesFirst
from fes_mj.cli.options import (
    Cadence,
    DesignName,
    Dims,
    LegCount,
    MomentsOptions,
    PrintOptions,
    bounds,
    changed,
    refuse_beside,
    speed_at,
)
from fes_mj.cli.tables import span, with_error
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.units import RPM
from fes_mj.common.writing import PAGES, require_writable, write_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.turning import CRANK_ZERO
from fes_mj.muscles.rules import BEST
from fes_mj.muscles.setting import MISTIMED, Setting
from fes_mj.muscles.settings import Settings
from fes_mj.riding.stimulation import CORE, Window, stimulation as find_windows, table_csv, windows_summary

_SLOWEST, _STEP, _APART = 30, 10, 5  # rpm: of the cadences below the main one, by which a start passes


def stimulation(
    design: DesignName,
    /,
    *,
    cadence: Annotated[list[Cadence] | None, Parameter(negative="", validator=bounds("cadence_rpm"))] = None,
    legs: LegCount = 2,
    dims: Dims = "identified",
    whose: MomentsOptions = MomentsOptions(),
    drive: MusclesFirst = MusclesFirst(),
    csv: Path | None = None,
    out: Annotated[list[Path] | None, Parameter(name=["--out", "-o"], json_list=False, negative="")] = None,
    options: PrintOptions = PrintOptions(),
) -> None:
    """When to stimulate: crank angles for a stimulator, what every muscle group gives and costs, for this seat.

    Args:
        cadence: Crank speed in rpm, by default the one at which the tricycle does 5.71 km/h, and slower ones that a
            start passes; or several times these alone, the first in full.
        legs: Both, half a turn apart, or the right one alone: whose windows are given, and what they do together.
        csv: Write the windows by cadence as a table (.csv).
        out: Draw the page (.svg, .pdf or .png); may be given several times.
    """
    by_muscles = drive.drive == "muscles"
    if not by_muscles:  # where they drive the crank is the linkage's alone
        refuse_beside("--drive moments", {"--cadence": cadence, **changed(whose)})
    loaded, pages = load_design(design, dims), out or []
    inputs = drive.inputs(whose, design)
    require_writable(csv, "the windows", ".csv", inputs)
    for page in pages:
        require_writable(page, "the page", PAGES, inputs)
        require_extra("report", "matplotlib")
    if by_muscles and drive.timing != BEST:
        raise InputError(
            f"--timing is {drive.timing}; windows that suit all riders who may be this one are those of `best`, "
            f"others are compared by `fes_mj static {design} --drive muscles --timing {drive.timing}`"
        )
    result: tuple[Any, ...]
    if by_muscles:
        speeds = [speed_at(rpm, loaded) for rpm in cadence or (None,)]
        slower = np.arange(_SLOWEST, speeds[0] / RPM - _APART, _STEP) * RPM if len(speeds) == 1 else ()
        riders, cadences = drive.load_riders(whose), [*speeds, *map(float, slower)]
        settings = Settings.solve(loaded, riders, cadences, speeds[0], drive.duty, legs)
        result, content, tables, table = (settings,), settings.summary, partial(_print, settings), settings.table_csv
    else:
        result = loaded, find_windows(loaded, legs)
        content, tables = partial(windows_summary, *result), partial(_print_windows, *result)
        table = partial(table_csv, *result)
    if pages:
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.rings import windows_figure
        from fes_mj.viewing.settings_page import settings_figure

        for page in pages:
            write_figure(page, settings_figure if by_muscles else windows_figure, *result)
    if csv:
        write_text(csv, table())
    options.show(content, tables, windows=csv, page=pages)


def _print(settings: Settings) -> None:
    main, content = settings.main, settings.summary()
    rows = []
    for record in main.records():
        if record["leg"] == "right":
            power, per = with_error(record["power_W"], record["power_sd_W"]), record["power_per_effort_W"]
            lost = (f"{record[f'{when}_loss_W']:.1f}" for when in ("early", "late"))
            cells = (_span(record, "deg"), _span(record, "from_tdc_deg"), power, f"{record['stimulation_effort']:.2f}")
            rows.append((record["muscle"], *cells, "-" if per is None else f"{per:.1f}", *lost))
    columns = (
        "muscles", "stimulate, deg", "from top dead centre", "gives, W", "effort", "W per effort",
        f"{MISTIMED:g} deg early costs, W", "late",
    )  # fmt: skip
    title = f"{main.design.name} at {content['cadence_rpm']:.1f} rpm, right leg; {main.riders.name} muscles"
    print_table(title, columns, rows)
    whole = "both legs" if main.legs == 2 else "one leg"
    print_table("What it gives", ("", whole), _totals(main))
    if len(settings.by_cadence) > 1:
        print_table("By cadence, right leg", ("rpm", *(row[0] for row in rows), f"{whole}, W"), _by_cadence(settings))
    left = "; the left leg's windows are 180 deg later" if main.legs == 2 else ""
    say(f"0: {CRANK_ZERO}{left}. Delay and rise of the muscles are counted in.")
    for note in content["notes"]:
        say(f"note: {note}")
    say(
        "Effort: share of the turn x strength x largest force, per that of the measurement. +-: standard deviation "
        "over the riders alone."
    )


def _totals(main: Setting) -> list[tuple[str, str]]:
    content, over_turn = main.summary(), main.together.mean(axis=0)
    return [
        ("power, W", with_error(float(over_turn.mean()), main.legs * content["power_sd_W"])),
        ("after half an hour of it, W", span(main.tired)),
        ("least power over the turn, W", f"{over_turn.min():.1f}"),
        ("below zero, % of the turn", f"{100 * content['negative_share']:.0f}"),
        ("power of a leg per stimulation, W", f"{content['power_per_effort_W']:.2f}"),
        (f"{MISTIMED:g} deg early costs, %", f"{100 * content['early_loss_share']:.0f}"),
        (f"{MISTIMED:g} deg late costs, %", f"{100 * content['late_loss_share']:.0f}"),
        ("widest window allowed, deg", f"{360 * main.duty:.0f}"),
    ]


def _by_cadence(settings: Settings) -> list[tuple[str, ...]]:
    rows = []
    for setting in settings.by_cadence:
        spans = [_span(record, "deg") for record in setting.records() if record["leg"] == "right"]
        power = setting.power.sum(axis=0)
        together = with_error(setting.legs * float(power.mean()), setting.legs * float(power.std()))
        rows.append((f"{setting.cadence / RPM:.1f}", *spans, together))
    return rows


def _span(record: dict[str, float | None], unit: str) -> str:
    on, off = record[f"on_{unit}"], record[f"off_{unit}"]
    return "-" if on is None or off is None else f"{on:.0f} to {off:.0f}"


def _print_windows(design: Design, windows: list[Window]) -> None:
    """Where moments drive the crank, of the right leg."""
    rows = []
    for record in (window.record(design) for window in windows if window.leg == "right"):
        works, from_top, core = (
            f"{on:.0f} to {off:.0f}" for on, off in (record[f"{w}_deg"] for w in ("works", "works_from_tdc", "core"))
        )
        name, widths = f"{record['muscle']} ({record['moment']})", (record["width_deg"], record["core_width_deg"])
        rows.append((name, f"{works} ({widths[0]:.0f})", from_top, f"{core} ({widths[1]:.0f})"))
    columns = ("muscle", "drives the crank (width)", "from top dead centre", "core of it (width)")
    print_table(f"{design.name}, right leg; crank angles in deg", columns, rows)
    left = "; the left leg's are 180 deg later" if any(window.leg == "left" for window in windows) else ""
    say(f"0: {CRANK_ZERO}{left}.")
    say(f"Core: the joint moves at least {CORE:g} times as fast per crank angle as at best in the window.")
    say("A stimulated muscle answers late and weakens with speed: --drive muscles says when to stimulate.")

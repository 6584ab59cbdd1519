"""`fes_mj stimulation`: at which crank angles to stimulate which muscles."""

import math
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from fes_mj.cli.options import Cadence, DesignName, Dims, Lag, Legs, PrintOptions, bounds, require_lag, speed_at
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import require_extra
from fes_mj.common.writing import PICTURES, require_writable, write_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.riding.stimulation import CORE, ZERO, Window, stimulation as find_windows, summary, table_csv


def stimulation(
    design: DesignName,
    /,
    *,
    cadence: Annotated[list[Cadence] | None, Parameter(negative="", validator=bounds("cadence_rpm"))] = None,
    legs: Legs = 2,
    lag: Lag = 0.0,
    dims: Dims = "identified",
    csv: Path | None = None,
    plot: Path | None = None,
    options: PrintOptions = PrintOptions(),
) -> None:
    """When to stimulate: the crank angles at which each muscle group drives the crank, for a stimulator.

    Args:
        cadence: Crank speed in rpm, also several times; by default the one at which the tricycle does 5.71 km/h.
        legs: Windows of the right leg alone, or in JSON and CSV of both.
        lag: Of the muscles behind the stimulation, in s; the windows are advanced by what the crank turns in it. Cycles
            in use: 0.06 to 0.15.
        csv: Write the windows as a table (.csv).
        plot: Draw those of the right leg as rings (.png or .svg).
    """
    loaded, inputs = load_design(design, dims), [Path(design)]
    cadences = [speed_at(rpm, loaded) for rpm in cadence or (None,)]
    for speed in cadences:
        require_lag(lag, loaded, speed)
    require_writable(csv, "the windows", ".csv", inputs)
    require_writable(plot, "the plot", PICTURES, inputs)
    if plot:
        require_extra("report", "matplotlib")
    windows = [window for window in find_windows(loaded, cadences, lag) if window.leg == "right" or legs == 2]
    if plot:
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.rings import windows_figure

        write_figure(plot, windows_figure, loaded, windows)
    if csv:
        write_text(csv, table_csv(loaded, windows))
    options.show(lambda: summary(loaded, windows), lambda: _print(loaded, windows), windows=csv, plot=plot)


def _print(design: Design, windows: list[Window]) -> None:
    rows = [
        (
            f"{record['muscle']} ({record['moment']})",
            f"{record['cadence_rpm']:.1f} ({record['cadence_Hz']:.2f} Hz)",
            f"{_span(record['works_deg'])} ({record['width_deg']:.0f})",
            _span(record["stimulate_deg"]),
            _span(record["stimulate_from_tdc_deg"]),
            f"{_span(record['stimulate_core_deg'])} ({record['core_width_deg']:.0f})",
        )
        for record in (window.record(design) for window in windows if window.leg == "right")
    ]
    lead = ", ".join(f"{degrees:.1f}" for degrees in dict.fromkeys(math.degrees(window.lead) for window in windows))
    title = f"{design.name}, right leg; crank angles in deg, lag {windows[0].lag:g} s = {lead} deg of crank"
    columns = ("muscle", "cadence, rpm", "works (width)", "stimulate", "from top dead centre", "core of it (width)")
    print_table(title, columns, rows)
    say(f"Zero: {ZERO}. The left leg's are 180 deg later.")
    say(f"Core: the joint moves at least {CORE:g} times as fast per crank angle as at best in the window.")
    if windows[0].lag == 0:
        say("Stimulated muscle answers 0.06 to 0.15 s late on cycles in use: --lag advances the windows.")


def _span(angles: list[float]) -> str:
    begin, end = (round(angle) % 360 for angle in angles)
    return f"{begin} to {end}"

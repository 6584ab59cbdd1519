"""`fes_mj stimulation`: at which crank angles to stimulate which muscles."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from fes_mj.cli.options import PrintOptions, crank_speed, require_lag, require_picture
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import require_extra
from fes_mj.common.writing import json_text, require_writable, write_files
from fes_mj.linkage.design_file import load_design

if TYPE_CHECKING:
    from fes_mj.linkage.design import Design
    from fes_mj.riding.stimulation import Window

_DEFAULTS = PrintOptions()


def stimulation(
    design: str,
    /,
    *,
    cadence: Annotated[list[float] | None, Parameter(negative="")] = None,
    lag: float = 0.0,
    dims: Literal["identified", "printed"] = "identified",
    csv: Path | None = None,
    plot: Path | None = None,
    options: PrintOptions = _DEFAULTS,
) -> int:
    """When to stimulate: the crank angles at which each muscle group drives the crank, for a stimulator.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    cadence
        Crank speed in rpm, also several times; by default the one at which the tricycle does 5.71 km/h.
    lag
        Of the muscles behind the stimulation, in s; the windows are advanced by what the crank turns in it. Cycles in
        use: 0.06 to 0.15.
    dims
        Dimensions of one of the paper's designs: as identified, or as the paper prints them.
    csv
        Write the windows of both legs as a table (.csv).
    plot
        Draw those of the right leg as rings (.png or .svg).
    """
    loaded, inputs = load_design(design, dims), [Path(design)]
    cadences = [crank_speed(each, loaded) for each in cadence or (None,)]
    for each in cadences:
        require_lag(lag, loaded, each)
    if csv:
        require_writable(csv, "the windows", ".csv", inputs)
    if plot:
        require_writable(plot, "the plot", "", [*inputs, *([csv] if csv else [])])
        require_picture(plot)
        require_extra("report", "matplotlib")
    from fes_mj.riding.stimulation import stimulation as find_windows, summary, table_csv

    windows = find_windows(loaded, cadences, lag)
    if plot:
        from fes_mj.viewing.rings import write_windows

        write_windows(plot, loaded, windows)
    if csv:
        write_files({csv: table_csv(loaded, windows)})
    if options.json:
        sys.stdout.write(json_text(summary(loaded, windows)))
    elif not options.quiet:
        _print(loaded, windows)
        for output, what in ((csv, "windows"), (plot, "plot")):
            if output:
                say(f"{what}: {output}")
    return 0


def _print(design: Design, windows: list[Window]) -> None:
    from fes_mj.riding.stimulation import CORE, ZERO

    rows = []
    for window in windows:
        if window.leg == "right":
            found = window.record(design)
            rows.append(
                (
                    f"{window.muscle} ({found['moment']})",
                    f"{found['cadence_rpm']:.1f} ({found['cadence_Hz']:.2f} Hz)",
                    f"{_span(found['works_deg'])} ({found['width_deg']:.0f})",
                    _span(found["stimulate_deg"]),
                    _span(found["stimulate_from_tdc_deg"]),
                    f"{_span(found['stimulate_core_deg'])} ({found['core_width_deg']:.0f})",
                )
            )
    lead = ", ".join(f"{degrees:.1f}" for degrees in dict.fromkeys(math.degrees(each.lead) for each in windows))
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

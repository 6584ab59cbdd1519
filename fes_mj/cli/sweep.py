"""`fes_mj sweep`: many designs, riders, cadences and moments; killed and started again, it goes on where it was."""

import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import Cadence, Cluster, Jobs, LegCount, Out, PrintOptions, warn_of
from fes_mj.common.console import print_table, progress_bar, say
from fes_mj.common.errors import InputError, MissingPartError, require_extra
from fes_mj.common.parallel import Workers
from fes_mj.common.writing import made_folder, require_writable
from fes_mj.sweep.study import MuscleOptions, Study, label, load_study

if TYPE_CHECKING:
    from fes_mj.sweep.sweep import Sweep

MOST_PLOTTED = 10**6  # points


def sweep(
    study: Path,
    /,
    *,
    out: Out,
    cadence: Cadence | None = None,
    legs: LegCount = 1,
    jobs: Jobs | None = None,
    cluster: Cluster | None = None,
    csv: Path | None = None,
    plot: Path | None = None,
    drive: DriveOptions = DriveOptions(),
    options: PrintOptions = PrintOptions(),
) -> None:
    """Evaluate every point of a study; started again with the same folder, it does only what is missing.

    Args:
        study: Study file (.toml): analysis, grid and sample.
        out: Folder of the results, a Parquet file a chunk; made if it is not there.
        cadence: Crank speed of all points in rpm, for a study that says nothing of it; by default each design's own.
        legs: One leg, or two half a turn apart on the same crank: how even they are together, and both simulated.
        jobs: Processes (default: one a core).
        cluster: Dask scheduler, tcp://host:port, to send the chunks to.
        csv: Write all rows as one CSV file too.
        plot: Where one or two numbers vary, draw the mean crank power over them: a picture (.png).
    """
    from fes_mj.sweep.sweep import Sweep

    require_extra("optimize", "pyarrow")
    workers = Workers(jobs if jobs is not None else os.cpu_count() or 1, cluster)
    muscles = MuscleOptions(drive.timing, drive.duty, drive.muscles) if drive.drive == "muscles" else None
    sweep = Sweep(load_study(study, cadence, muscles, legs), out)
    for moments in sweep.study.moments.values():
        warn_of(moments)
    if plot:
        _require_plottable(sweep.study, study)
    inputs = [*sweep.study.files, *([drive.muscles] if drive.muscles else [])]
    with made_folder(out, "the results"):
        require_writable(csv, "the rows", ".csv", inputs)
        require_writable(plot, "the plot", ".png", inputs)
        summary = _run(sweep, workers, study.stem, options.silent)
    if csv:
        sweep.write_csv(csv)
    if plot:
        from fes_mj.sweep.plot import write_plot

        write_plot(sweep, plot)
    options.show(lambda: summary, lambda: _print(summary, study.stem, sweep.study), rows=csv, plot=plot)
    if not summary["computed"]:
        raise InputError(f"{study}: none of its {summary['points']:,} points could be computed: {summary['why']}")


def _run(sweep: "Sweep", workers: Workers, name: str, silent: bool) -> dict[str, Any]:
    """Evaluate what is missing; the result as JSON names and units it."""
    sweep.claim()
    finished = sweep.finished()
    before = sum(len(sweep.study.numbers(chunk)) for chunk in finished)
    start = time.perf_counter()
    # each process compiles the loop of a dynamic study, which takes seconds
    first = ", its loop is compiled first" if sweep.study.analysis == "dynamic" else ""
    with progress_bar(f"{name}, points{first}", sweep.study.points, silent, before) as advance:
        try:
            sweep.run(workers, advance, finished)
        except (InputError, MissingPartError):  # no scheduler: the folder is as it was
            sweep.release()
            raise
    seconds = time.perf_counter() - start
    summary = sweep.summary() | {"found_finished": before, "seconds": seconds}
    return summary | {"points_per_second": (summary["points"] - before) / seconds}


def _require_plottable(study: Study, path: Path) -> None:
    """Raise InputError unless --plot can show the study, MissingPartError without matplotlib."""
    require_extra("report", "matplotlib")
    numbers, names = study.varied_numbers, [axis for axis in study.varied if axis not in study.varied_numbers]
    if len(numbers) not in (1, 2) or (len(numbers) == 2 and names):
        raise InputError(
            f"--plot shows one number that varies, for any designs and moments, or two for one design and moments; in "
            f"{path} {', '.join(study.varied) or 'none'} varies; leave out --plot, or vary as many"
        )
    if study.points > MOST_PLOTTED:
        raise InputError(f"--plot: {path} has {study.points:,} points; at most {MOST_PLOTTED:,} are drawn")


def _print(summary: dict[str, Any], name: str, study: Study) -> None:
    cells = [
        ("points", f"{summary['points']:,}"),
        ("already finished", f"{summary['found_finished']:,}"),
        ("can turn", f"{summary['turning']:,}"),
        ("points a second", f"{summary['points_per_second']:,.0f}"),
    ]
    print_table(f"{name}: {summary['folder']}", ("", "value"), cells)
    if summary["top"]:
        _print_top(summary["top"], study)
    if ends := summary["best_at_end_of"]:
        say(f"note: the best has the first or last value of {', '.join(ends)}; it may lie beyond")


def _print_top(rows: Sequence[dict[str, Any]], study: Study) -> None:
    """The best points, with what varies among all."""
    columns = {"point": "point"} | {axis: label(axis) for axis in study.varied}
    columns |= {"power_mean_W": "power, W", "power_sd_W": "+-, W", "power_mode_W": "most probable rider, W"}
    columns |= {"simulated_power_mean_W": "simulated, W", "extrapolated_share": "extrapolated, %"}
    shown = {name: heading for name, heading in columns.items() if any(row.get(name) is not None for row in rows)}
    cells = [[_cell(name, row[name]) for name in shown] for row in rows]
    print_table("Points with the most mean crank power", [*shown.values()], cells)


def _cell(name: str, value: Any) -> str:
    if not isinstance(value, float):
        return "" if value is None else str(value)
    if name == "extrapolated_share":
        return f"{100 * value:.1f}"
    return f"{value:.2f}" if name.endswith("_W") else f"{value:#.4g}"

"""`fes_mj sweep`: many designs, riders, cadences and moments; killed and started again, it goes on where it was."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from fes_mj.cli.output import print_json, print_table, progress_bar
from fes_mj.errors import import_extra
from fes_mj.files import require_folder

if TYPE_CHECKING:
    from fes_mj.optimization.sweep import Sweep


def sweep(
    study: Path,
    /,
    *,
    out: Annotated[Path, Parameter(name=["--out", "-o"])],
    jobs: int | None = None,
    cluster: str | None = None,
    json: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False,
) -> int:
    """Evaluate every point of a study; started again with the same folder, it does only what is missing.

    Parameters
    ----------
    study
        Study file (.toml): analysis, grid and sample.
    out
        Folder of the results, a Parquet file a chunk; made if it is not there.
    jobs
        Processes (default: one a core).
    cluster
        Dask scheduler, tcp://host:port, to send the chunks to.
    json
        Print one JSON object and nothing else.
    quiet
        Print nothing.
    """
    from fes_mj.optimization.parallel import Workers
    from fes_mj.optimization.study import load_study
    from fes_mj.optimization.sweep import Sweep

    require_folder(out if out.exists() else out.parent, "the results")
    sweep = Sweep(load_study(study), out)
    workers = Workers(jobs if jobs is not None else os.cpu_count() or 1, cluster)
    sweep.claim()
    total = sweep.study.points
    before = sum(min(sweep.study.chunk, total - chunk * sweep.study.chunk) for chunk in sweep.finished())
    start = time.perf_counter()
    with progress_bar(f"{study.stem}, points", total, quiet or json, before) as advance:
        sweep.run(workers, advance)
    seconds = time.perf_counter() - start
    summary = _summary(sweep, before, seconds)
    if json:
        print_json(summary)
    elif not quiet:
        _print(summary, study.stem)
    return 0


def _summary(sweep: Sweep, before: int, seconds: float) -> dict[str, Any]:
    pc = import_extra("pyarrow.compute", "optimize")
    table = sweep.read()
    turning = int(pc.sum(table["turns"]).as_py() or 0)
    best = None
    if turning:
        power = table["power_mean_W"]
        best = table.slice(pc.index(power, pc.max(power)).as_py(), 1).to_pylist()[0]
    return {
        "folder": str(sweep.folder),
        "points": table.num_rows,
        "turning": turning,
        "found_finished": before,
        "seconds": seconds,
        "points_per_second": (table.num_rows - before) / seconds,
        "best": best,
    }


def _print(summary: dict[str, Any], name: str) -> None:
    cells = [
        ("points", f"{summary['points']:,}"),
        ("already finished", f"{summary['found_finished']:,}"),
        ("can turn", f"{summary['turning']:,}"),
        ("points a second", f"{summary['points_per_second']:,.0f}"),
    ]
    print_table(f"{name}: {summary['folder']}", ("", "value"), cells)
    if summary["best"]:
        best = {
            key.replace("_", " "): f"{value:.6g}" if isinstance(value, float) else str(value)
            for key, value in summary["best"].items()
        }
        print_table("Point with the most mean crank power", ("", "value"), [*best.items()])

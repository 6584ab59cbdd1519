"""`fes_mj sweep`: many designs, riders, cadences and moments; killed and started again, it goes on where it was."""

import os
import sys
import time
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from fes_mj.cli.options import PrintOptions
from fes_mj.console import print_table, progress_bar
from fes_mj.files import json_text, require_folder

_DEFAULTS = PrintOptions()


def sweep(
    study: Path,
    /,
    *,
    out: Annotated[Path, Parameter(name=["--out", "-o"])],
    jobs: int | None = None,
    cluster: str | None = None,
    options: PrintOptions = _DEFAULTS,
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
    """
    from fes_mj.parallel import Workers
    from fes_mj.sweep.study import load_study
    from fes_mj.sweep.sweep import Sweep

    require_folder(out if out.exists() else out.parent, "the results")
    sweep = Sweep(load_study(study), out)
    workers = Workers(jobs if jobs is not None else os.cpu_count() or 1, cluster)
    sweep.claim()
    total = sweep.study.points
    before = sum(min(sweep.study.chunk, total - chunk * sweep.study.chunk) for chunk in sweep.finished())
    start = time.perf_counter()
    # each process compiles the loop of a dynamic study, which takes seconds
    first = ", its loop is compiled first" if sweep.study.analysis == "dynamic" else ""
    with progress_bar(f"{study.stem}, points{first}", total, options.silent, before) as advance:
        sweep.run(workers, advance)
    seconds = time.perf_counter() - start
    summary = sweep.summary() | {"found_finished": before, "seconds": seconds}
    summary["points_per_second"] = (summary["points"] - before) / seconds
    if options.json:
        sys.stdout.write(json_text(summary))
    elif not options.quiet:
        _print(summary, study.stem)
    return 0


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

"""`fes_mj optimize`: new designs within the limits of the paper, each winner simulated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.output import output, print_json, progress_bar
from fes_mj.cli.search_options import SearchOptions
from fes_mj.cli.winner_output import Found, limits_table, print_winner, rows, summary, write_design
from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.files import require_writable, write_text
from fes_mj.torque import GROUPS, load_moments

if TYPE_CHECKING:
    from fes_mj.optimization.problem import Problem

_DEFAULTS = SearchOptions()
_PARETO_BUDGET = 50_000


def optimize(
    kind: Literal["crt", "cdt"],
    /,
    *,
    options: SearchOptions = _DEFAULTS,
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    report: Path | None = None,
    json: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False,
) -> int:
    """Find the linkage with the most mean crank power; exit code 1 if its simulation disagrees with statics.

    Parameters
    ----------
    kind
        Which six-bar: crt (pedal on the rocker) or cdt (pedal on the coupler).
    out
        The design file to write (.toml); its model (.xml), and the front (.csv), appear beside it.
    report
        A page on the design (.html): numbers, motion, power, constraints.
    json
        Print one JSON object and nothing else.
    quiet
        Print nothing.
    """
    options.check()
    _check_files(out, report)
    from fes_mj.optimization.winner import assess

    moments, rival, start = options.load_moments(), load_design(options.speeds_of), options.load_start(kind)
    task = options.task(kind, moments, rival, start)
    found = _front(task, options) if options.method == "nsga-ii" else _search(task, options, start, quiet or json)
    design = task.design(found.x, out.stem if out else f"{kind}-{moments.name}")
    how = f"--method {options.method} --seed {options.seed}"
    told = f"Found by fes_mj optimize {kind} {how}, {found.evaluations} evaluations."
    # first: what was found stays, whatever its simulation does
    files = write_design(design, found.front, out, told) if out else {}
    winner = assess(design, rival, moments, options.seed)
    if report:
        from fes_mj.optimization.page import page_html

        write_text(report, page_html(winner, told, rows(winner), limits_table(found), task.limits.space))
        files["report"] = str(report)
    if json:
        print_json(summary(winner, found) | {"design_file": None, **files})
    elif not quiet:
        print_winner(winner, found)
        for what, file in files.items():
            output.print(f"{what.replace('_', ' ')}: {file}", markup=False, soft_wrap=True)
    return 0 if winner.check.agrees else 1


def _check_files(out: Path | None, report: Path | None) -> None:
    """Refuse files that could not be written, before anything runs."""
    if out:
        require_writable(out, "the design", ".toml")
    if report:
        from fes_mj.optimization.page import require_packages

        require_writable(report, "the page", ".html")
        require_packages()


def _search(task: Problem, options: SearchOptions, start: Design | None, silent: bool) -> Found:
    """The best of several independent searches."""
    from fes_mj.optimization.optimize import optimize as run
    from fes_mj.optimization.parallel import Workers

    with progress_bar(f"{options.method}, searches", options.searches, silent) as advance:
        results = run(
            task,
            options.method,
            searches=options.searches,
            budget=options.budget,
            seed=options.seed,
            start=task.variables(start) if start else None,
            workers=Workers(options.jobs, options.cluster),
            progress=lambda _: advance(1),
        )
    return Found(task, options.method, results[0].x, sum(result.evaluations for result in results))


def _front(task: Problem, options: SearchOptions) -> Found:
    """The front, and of it the design with the most power averaged over both groups (the paper's recommendation)."""
    from fes_mj.optimization.cycles import WorkTable
    from fes_mj.optimization.pareto import pareto_front

    sets = tuple(load_moments(each) for each in GROUPS)
    averaged = replace(task, table=WorkTable.of(*sets), baseline=0.0)
    front = pareto_front(averaged, sets, options.budget or _PARETO_BUDGET, options.seed, options.smooth)
    x = front.x[int(np.argmax(front.power.mean(axis=1)))]
    return Found(task, options.method, x, front.evaluations, front)

"""`fes_mj optimize`: new designs within the limits of the paper, each winner simulated."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.search_options import SearchOptions
from fes_mj.console import output, print_table, progress_bar, say
from fes_mj.design_file import load_design
from fes_mj.files import json_text, require_writable, write_text
from fes_mj.moments import GROUPS

if TYPE_CHECKING:
    from fes_mj.optimization.outcome import Outcome
    from fes_mj.optimization.problem import Problem
    from fes_mj.optimization.winner import Winner

_DEFAULTS = SearchOptions()


def optimize(
    kind: Literal["crt", "cdt"],
    /,
    *,
    options: SearchOptions = _DEFAULTS,
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    report: Path | None = None,
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
    """
    options.check()
    _check_files(out, report)
    moments = options.load_moments()
    problem = options.load_problem(kind, moments)
    outcome = _search(problem, options)
    design = problem.design(outcome.x, out.stem if out else f"{kind}-{moments.name}")
    how = f"--method {options.method} --seed {options.seed}"
    origin = f"Found by fes_mj optimize {kind} {how}, {outcome.evaluations} evaluations."
    # first: what was found stays, whatever its simulation does
    files = outcome.write(design, out, origin) if out else {}
    from fes_mj.optimization.winner import assess

    winner = assess(design, load_design(options.speeds_of), moments, options.seed)
    if report:
        from fes_mj.optimization.page import page_html

        write_text(report, page_html(winner, outcome, origin))
        files["report"] = str(report)
    if options.json:
        sys.stdout.write(json_text(outcome.summary(winner) | {"design_file": None, **files}))
    elif not options.quiet:
        _print(winner, outcome)
        for what, file in files.items():
            say(f"{what.replace('_', ' ')}: {file}")
    return 0 if winner.case.agrees else 1


def _check_files(out: Path | None, report: Path | None) -> None:
    """Refuse files that could not be written, before anything runs."""
    if out:
        require_writable(out, "the design", ".toml")
    if report:
        from fes_mj.viewing.pages import require_page_packages

        require_writable(report, "the page", ".html")
        require_page_packages()


def _search(problem: Problem, options: SearchOptions) -> Outcome:
    """The best of several independent searches, or the front."""
    from fes_mj.optimization.optimize import optimize as run
    from fes_mj.optimization.outcome import Outcome, front_outcome
    from fes_mj.parallel import Workers

    if options.method == "nsga-ii":
        return front_outcome(problem, options.budget, options.seed, options.smooth)
    with progress_bar(f"{options.method}, searches", options.searches, options.silent) as advance:
        results = run(
            problem,
            options.method,
            searches=options.searches,
            budget=options.budget,
            seed=options.seed,
            start=problem.variables(problem.template) if options.start else None,
            workers=Workers(options.jobs, options.cluster),
            progress=lambda _: advance(1),
        )
    return Outcome(problem, options.method, results[0].x, sum(result.evaluations for result in results))


def _print(winner: Winner, outcome: Outcome) -> None:
    """Tables of what was found, and notes on what to beware of."""
    front, design = outcome.front, winner.design
    title = f"{design.name}: {design.linkage.architecture.title}; {winner.case.moments.name}"
    print_table(f"{title}; {outcome.method}, {outcome.evaluations:,} evaluations", ("", "value"), winner.rows)
    print_table("Constraints", ("constraint", "value", "limit", ""), outcome.limit_rows)
    if front:
        keep = np.unique(np.linspace(0, len(front.x) - 1, 12).astype(int))
        cells = [(f"{number}", *(f"{power:.2f}" for power in front.power[number])) for number in keep]
        print_table(f"Front, {len(keep)} of {len(front.x)} designs", ("design", *(f"{g}, W" for g in GROUPS)), cells)
    if winner.gain and winner.gain.mean > 0 and not winner.gain.beyond_error:
        output.print(
            "note: the gain is within the error bar of the recovered moments; --caution 1 looks for a surer one"
        )
    if winner.reversals.knee > 2:
        say("note: the knee swings more than once per turn of the crank; can the muscles follow?")
    say("note: the design space is an assumption, see --problem")

"""`fes_mj optimize`: new designs within the limits of the paper, each winner simulated."""

from __future__ import annotations

from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import fes_mj
from fes_mj.cli.options import Out, refuse_beside
from fes_mj.cli.process import interruption_code
from fes_mj.cli.search_options import SearchOptions, shell_word
from fes_mj.common.console import conclude, errors, print_table, progress_bar, say
from fes_mj.common.parallel import Workers
from fes_mj.common.text import printable
from fes_mj.common.writing import require_replaceable, require_writable, write_files, write_text
from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.viewing.pages import require_page_packages

if TYPE_CHECKING:
    from fes_mj.optimization.findings import Findings
    from fes_mj.optimization.muscle_winner import MuscleWinner
    from fes_mj.optimization.optimize import Optimum
    from fes_mj.optimization.winner import Winner

_RIDER_COLUMNS = ("thigh, m", "shank, m", "seat towards the crank, m", "seat up, m", "seat angle, deg", "power, W")


def optimize(
    kind: Literal["crt", "cdt", "trt"],
    /,
    *,
    options: SearchOptions = SearchOptions(),
    out: Out | None = None,
    report: Path | None = None,
) -> int:
    """Find the linkage with the most mean crank power that can be built; exit code 1 if its simulation disagrees.

    With -o the best design so far is in its file from the first feasible one on. However the run is stopped, the same
    command goes on: what is known stands in the folder BEST.search beside the file, which is gone at the end. Finished
    searches are not done again.

    Args:
        kind: Which linkage: crt (pedal on the rocker), cdt (on the coupler), or trt (on the crank) as a yardstick.
        out: The design file to write (.toml), with the command that finds it again; its model (.xml), and the front
            (.csv), appear beside it. A file that was there is replaced at the end.
        report: A page on the design (.html): numbers, motion, power, constraints.
    """
    options.check()
    if options.print_problem:
        return _print_problem(kind, options, {"--out": out, "--report": report})
    _check_files(out, report, options)
    moments, compared_with = options.load_moments(), load_design(options.like or options.speeds_of)
    command = options.command(kind) + (f" -o {shell_word(out.name)}" if out else "")
    origin = f"Found by fes_mj {version('fes-mj')}:\n{command}"
    from fes_mj.optimization.findings import Findings

    findings = Findings(out, origin, options.recipe(kind)) if out else None
    try:
        optimum = _search(kind, moments, options, findings)
        # first: what was found stays, whatever becomes of the rest
        files = _write(optimum, origin, findings.out, options) if findings else {}
        winner = _assess(optimum, compared_with, moments, options.seed)
        if report:
            _write_report(report, winner, optimum, origin)
            files["report"] = str(report)
    except (KeyboardInterrupt, Exception) as error:
        return _interrupted(error, findings)
    if findings:
        findings.remove()
    options.show(
        lambda: winner.summary(optimum) | {"command": command, "design_file": None, **files},
        lambda: _print(winner, optimum),
        report=report,
    )
    return 0 if winner.case.agrees else 1


def _search(kind: str, moments: fes_mj.JointMoments, options: SearchOptions, findings: Findings | None) -> Optimum:
    """The best of all searches, with a bar that counts evaluations and says how long they take."""
    return fes_mj.optimize(
        kind,
        moments,
        method=options.method,
        budget=options.budget,
        searches=options.searches,
        seed=options.seed,
        smooth=options.smooth,
        workers=Workers(options.jobs, options.cluster),
        findings=findings,
        progress=partial(progress_bar, f"{options.method}, evaluations", silent=options.silent),
        **options.problem_options(),
    )


def _print_problem(kind: str, options: SearchOptions, files: dict[str, Path | None]) -> int:
    """The problem file of what is asked for, to standard output, where nothing else may go."""
    refuse_beside("--print-problem", files | {"--json": options.json, "--quiet": options.quiet})
    from fes_mj.optimization.problem import make_problem
    from fes_mj.optimization.problem_file import problem_text

    print(problem_text(make_problem(kind, options.load_moments(), **options.problem_options())), end="")
    return 0


def _write_report(report: Path, winner: Winner | MuscleWinner, optimum: Optimum, origin: str) -> None:
    from fes_mj.optimization.page import page_html
    from fes_mj.optimization.winner import Winner

    assert isinstance(winner, Winner)  # _check_files
    write_text(report, page_html(winner, optimum, origin))


def _interrupted(error: BaseException, findings: Findings | None) -> int:
    """Say where the best so far is, and give the exit code. Raises the error itself where nothing was found."""
    code = interruption_code(error)
    if code is None or not findings or (power := findings.power) is None:
        raise error
    errors.print(
        f"fes_mj: interrupted; the best so far, {power:.2f} W, is saved in "
        f"{printable(str(findings.so_far))}; the same command goes on from there",
        soft_wrap=True,
    )
    return code


def _assess(
    optimum: Optimum, compared_with: fes_mj.Design, moments: fes_mj.JointMoments, seed: int
) -> Winner | MuscleWinner:
    """What the design that was found is worth, beside the one that it had to beat."""
    from fes_mj.optimization.stimulated import MuscleDrive

    if isinstance(drive := optimum.problem.drive, MuscleDrive):
        from fes_mj.optimization.muscle_winner import MuscleWinner

        return MuscleWinner.of(optimum.design, compared_with, drive)
    from fes_mj.optimization.winner import assess

    return assess(optimum.design, compared_with, moments, seed)


def _files(out: Path, options: SearchOptions) -> dict[str, Path]:
    """The design file and what appears beside it: key of JSON -> path."""
    files = {"design_file": out, "model_file": out.with_suffix(".xml")}
    if options.method == "nsga-ii":
        files["front_file"] = out.with_name(f"{out.stem}-front.csv")
    return files


def _check_files(out: Path | None, report: Path | None, options: SearchOptions) -> None:
    """Refuse files that could not or must not be written, before anything runs."""
    inputs = options.drive.inputs(options)
    require_writable(out, "the design", ".toml", inputs)
    for key, path in _files(out, options).items() if out else ():
        if path != out:
            require_replaceable([path], f"the {key.partition('_')[0]}", inputs)
    require_writable(report, "the page", ".html", inputs)
    if report:
        if options.drive.drive == "muscles":  # the page shows a turn under joint moments
            refuse_beside("--drive muscles", {"--report": report})
        require_page_packages()


def _write(optimum: Optimum, origin: str, out: Path, options: SearchOptions) -> dict[str, str]:
    """Write the design file, then, all or nothing, what appears beside it; key of JSON -> file."""
    from fes_mj.simulation.export import mjcf_text

    files, design = _files(out, options), optimum.design
    write_text(out, design_toml(design, origin))
    texts = {files["model_file"]: mjcf_text(fes_mj.build_mjcf(design))}
    if optimum.front:
        texts[files["front_file"]] = optimum.front.as_csv()
    write_files(texts, unnamed=texts.keys())
    options.name_files(**files)
    return {key: str(path) for key, path in files.items()}


def _print(winner: Winner | MuscleWinner, optimum: Optimum) -> None:
    """Tables of what was found, and notes on what to beware of."""
    front, design, people = optimum.front, winner.design, optimum.problem.people
    if doubts := winner.doubts(optimum):
        conclude(False, "Beware", f": {'; '.join(doubts)}.")
    if optimum.repair:
        say(f"the start did not keep the limits and was repaired: {optimum.repair}")
    title = f"{design.name}: {design.linkage.title}; {winner.case.static.driver}"
    print_table(f"{title}; {optimum.method}, {optimum.evaluations:,} evaluations", ("", "value"), winner.rows)
    print_table("Constraints", ("constraint", "value", "limit", ""), optimum.limit_rows)
    if people.count > 1:
        rows = [tuple(f"{value:.3f}" for value in rider.values()) for rider in optimum.riders]
        print_table(f"{people.statistic}: {optimum.power:.2f} W; by these riders", _RIDER_COLUMNS, rows)
    if front:
        print_table(f"Front, {front.table.title}", [*front.table.columns], front.table.cells)
    for note in winner.notes:
        say(f"note: {note}")
    say(f"note: the design space is {optimum.problem.limits.space}; --print-problem writes all that was limited")

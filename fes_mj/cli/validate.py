"""`fes_mj validate`: every check of the harness, one verdict each; its reports."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from fes_mj.checks import Check, criteria
from fes_mj.cli.options import RunOptions
from fes_mj.cli.output import number, output, print_json, print_table, track, verdict
from fes_mj.design_file import CATALOGUE
from fes_mj.errors import InputError
from fes_mj.files import require_writable, write_text
from fes_mj.kinematics import require_assembly
from fes_mj.provenance import provenance

if TYPE_CHECKING:
    from fes_mj.verification.case import Case
    from fes_mj.verification.details import Details
    from fes_mj.verification.faults import Verdict

_DEFAULTS = RunOptions()
# The design the faults are injected into: all bodies, loops and parameters exist in it.
FAULTY_DESIGN = "d1"


def validate(
    *designs: str,
    options: RunOptions = _DEFAULTS,
    quick: Annotated[bool, Parameter(negative="")] = False,
    faults: Annotated[bool, Parameter(negative="")] = False,
    report: Path | None = None,
    junit: Path | None = None,
    video: Path | None = None,
) -> int:
    """Run every check of the harness on designs, one verdict each; exit code 1 if one fails.

    Parameters
    ----------
    designs
        trt, r1, r2, d1, d2, or paths to design files; all of the catalogue if none is named.
    quick
        Seconds instead of minutes: one rider group, one leg, no refinement.
    faults
        Also inject the catalogue of faults (into D1) and tell which check catches each.
    report
        Write a self-contained report (.html).
    junit
        Write the verdicts as JUnit XML (.xml), for continuous integration.
    video
        A video of `fes_mj simulate --render` to put into the report (.mp4).
    """
    cases = list(_cases(designs or CATALOGUE, options, quick))
    _check_files(report, junit, video)
    quiet = options.quiet or options.json
    from fes_mj.verification.details import details

    checks = _run_checks(cases, quick, quiet)
    verdicts = _inject(quiet) if faults else ()
    wanted = bool(report or options.json or not options.quiet)
    broken = {each.subject for each in checks if each.name == "stability" and not each.ok}
    measured = [case for case in cases if wanted and case.name not in broken]
    found = [details(case, not quick) for case in track(measured, "measuring", quiet)]
    ok = all(each.ok for each in checks) and all(each.caught for each in verdicts)
    if options.json:
        print_json(_summary(ok, checks, verdicts, found))
    elif not options.quiet:
        _print(ok, checks, verdicts, found, options.verbose)
    if junit:
        from fes_mj.verification.junit import junit_xml

        write_text(junit, junit_xml(checks, verdicts))
    if report:
        from fes_mj.verification.report import report_html

        write_text(report, report_html(checks, verdicts, found, video))
    return 0 if ok else 1


def _cases(designs: Sequence[str], options: RunOptions, quick: bool) -> Iterator[Case]:
    """Every design with the moments asked for; both groups in a full run that names none."""
    from fes_mj.paper.printed import table1
    from fes_mj.verification.case import Case

    both = [replace(options, group="p1p2"), replace(options, group="p1p3")]
    chosen = [options] if quick or options.group or options.moments else both
    for design in dict.fromkeys(designs):
        printed = table1()[design] if design in CATALOGUE and options.dims == "identified" else None
        for choice in chosen:
            case = Case(*choice.load(design), printed)
            require_assembly(case.design)
            yield case


def _check_files(report: Path | None, junit: Path | None, video: Path | None) -> None:
    """Refuse unusable files, and a missing package, before anything runs."""
    if report:
        require_writable(report, "the report", ".html")
        from fes_mj.verification.report import require_packages

        require_packages()
    if junit:
        require_writable(junit, "the JUnit file", ".xml")
    if video and not report:
        raise InputError("--video puts a video into the report; name it with --report OUT.html")
    if video and not (video.is_file() and video.suffix.lower() == ".mp4"):
        raise InputError(f"{video}: cannot read the video; it must be an .mp4 file, as `simulate --render` writes it")


def _run_checks(cases: list[Case], quick: bool, quiet: bool) -> list[Check]:
    from fes_mj.verification.suite import FULL, QUICK, benchmarks, verify

    stages = QUICK if quick else FULL
    runs = [(verify(case, (stage,))) for case in cases for stage in stages] + [benchmarks()]
    return [each for run in track(runs, "checking", quiet) for each in run]


def _inject(quiet: bool) -> tuple[Verdict, ...]:
    from fes_mj.verification.catalogue import FAULTS
    from fes_mj.verification.faults import inject, passing

    case = next(_cases((FAULTY_DESIGN,), _DEFAULTS, quick=True))
    baseline = passing(case)
    return tuple(inject(fault, case, baseline) for fault in track(FAULTS, "injecting faults", quiet))


def _summary(ok: bool, checks: list[Check], verdicts: Sequence[Verdict], found: list[Details]) -> dict[str, Any]:
    content: dict[str, Any] = {
        "ok": ok,
        "checks": [each._asdict() | {"ok": each.ok, "kind": criteria()[each.name].kind} for each in checks],
        "runs": [each.as_json() for each in found],
    }
    if verdicts:
        content["faults"] = [each.as_json() for each in verdicts]
    return content | {"provenance": provenance()}


def _print(ok: bool, checks: list[Check], verdicts: Sequence[Verdict], found: list[Details], verbose: bool) -> None:
    for subject in dict.fromkeys(each.subject for each in checks):
        rows = [
            (each.name, number(each.value, each.unit), number(each.limit, each.unit), verdict(each.ok))
            for each in checks
            if each.subject == subject
        ]
        print_table(subject, ("check", "value", "limit", "verdict"), rows)
    if verbose:
        for each in found:
            _print_details(each)
    _print_runs(found)
    if verdicts:
        _print_faults(verdicts)
    failed = [f"{each.name} ({each.subject})" for each in checks if not each.ok]
    missed = [each.fault.name for each in verdicts if not each.caught]
    if ok:
        also = f", all {len(verdicts)} faults are caught" if verdicts else ""
        output.print(f"[bold green]All {len(checks)} checks hold[/]{also}.")
    if failed:
        output.print(f"[bold red]{len(failed)} of {len(checks)} checks failed[/]: {', '.join(failed)}")
        output.print("`fes_mj explain CHECK` says what usually breaks one.")
    if missed:
        output.print(f"[bold red]{len(missed)} faults went unnoticed[/]: {', '.join(missed)}")


def _print_runs(found: list[Details]) -> None:
    """Mean powers, and what the discretisation makes uncertain about them."""
    rows = []
    for each in found:
        row = each.summary()
        rows.append(
            (
                each.case.name,
                f"{row['cadence_rpm']:.1f}",
                f"{row['static_power_mean_W']:.3f}",
                f"{row['power_mean_W']:.3f}",
                f"{row['numerical_uncertainty_W']:.4f}" if each.refinement else "not refined",
                each.result.difference_text,
            )
        )
    columns = ("run", "rpm", "static, W", "dynamic, W", "numerical uncertainty, W", "difference")
    print_table("Mean crank power of one leg", columns, rows)


def _print_details(each: Details) -> None:
    from fes_mj.verification.references import differences

    for family, curves in each.curves.items():
        rows = [(f"{one} - {other}", f"{value:.2g}") for (one, other), value in differences(curves).items()]
        print_table(f"{each.case.name}: crank moment, {family} methods", ("methods", "largest difference, N m"), rows)
    print_table(
        f"{each.case.name}: energy over the turn", ("term", "J"), [(k, f"{v:.6f}") for k, v in each.audit.terms.items()]
    )
    if each.refinement:
        levels = [*each.refinement.steps, *each.refinement.softness, each.refinement.stiffer]
        print_table(
            f"{each.case.name}: refinement",
            ("step, ms", "loop time constant, s", "loop gap, m", "energy lost", "error of work per turn"),
            [
                (
                    f"{1e3 * v.timestep:.4f}",
                    f"{v.loop_time:.0e}",
                    f"{v.gap:.2e}",
                    f"{v.lost:.2e}",
                    f"{v.work_error:.2e}",
                )
                for v in levels
            ],
        )


def _print_faults(verdicts: Sequence[Verdict]) -> None:
    rows = [
        (each.fault.name, each.first.name, f"{each.first.factor:.2g}", str(len(each.failed)))
        if each.first
        else (each.fault.name, "[bold red]nobody[/]", "", "0")
        for each in verdicts
    ]
    print_table("Injected faults", ("fault", "first caught by", "times its limit", "checks that caught it"), rows)

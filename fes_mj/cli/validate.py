"""`fes_mj validate`: every check of the harness, one verdict each; its reports."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from fes_mj.cli.options import RunOptions
from fes_mj.cli.simulate import check_rows
from fes_mj.cli.static import print_notes
from fes_mj.common.checks import Check, definitions
from fes_mj.common.console import conclude, print_table, say, track
from fes_mj.common.errors import InputError
from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, require_writable, write_text
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.statics.extrapolation import turning_in_range

if TYPE_CHECKING:
    from fes_mj.verification.case import VerificationCase
    from fes_mj.verification.faults import Detection

_DEFAULTS = RunOptions()
# Where no design is named, faults are injected into this one: all bodies, loops and parameters exist in it.
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
        trt, r1, r2, d1, d2, or paths to design files; the paper's five if none is named.
    quick
        Seconds instead of minutes: one rider group, one leg, no refinement.
    faults
        Also inject faults into the first design named (default d1) and tell which check catches each.
    report
        Write a self-contained report (.html).
    junit
        Write the verdicts as JUnit XML (.xml), for continuous integration.
    video
        A video of `fes_mj simulate --render` to put into the report (.mp4).
    """
    cases = list(_cases(designs or DESIGNS, options, quick))
    _check_files(report, junit, video, options.inputs(*designs))
    checks = _run_checks(cases, quick, options.silent)
    detections = _inject(designs[0] if designs else FAULTY_DESIGN, options) if faults else ()
    broken = {each.subject for each in checks if each.name == "stability" and not each.ok}
    measured = [case for case in cases if case.name not in broken]
    ok = all(each.ok for each in checks) and all(each.caught for each in detections)
    if junit:
        from fes_mj.verification.junit import junit_xml

        write_text(junit, junit_xml(checks, detections))
    if report:
        from fes_mj.verification.report import report_html

        write_text(report, report_html(checks, detections, measured, video))
    if options.json:
        sys.stdout.write(json_text(_summary(ok, checks, detections, measured)))
    elif not options.quiet:
        _print(ok, checks, detections, measured, options.verbose)
    return 0 if ok else 1


def _cases(designs: Sequence[str], options: RunOptions, quick: bool) -> Iterator[VerificationCase]:
    """Every design with the moments asked for; both groups in a full run that names none."""
    from fes_mj.paper.printed import table1
    from fes_mj.verification.case import VerificationCase

    both = [replace(options, group="p1p2"), replace(options, group="p1p3")]
    chosen = [options] if quick or options.group or options.moments else both
    for design in dict.fromkeys(designs):
        printed = table1()[design] if design in DESIGNS and options.dims == "identified" else None
        for choice in chosen:
            case = VerificationCase(*choice.load(design), expected=printed, refined=not quick)
            turning_in_range(case.design, case.moments.measured_on)
            yield case


def _check_files(report: Path | None, junit: Path | None, video: Path | None, inputs: list[Path]) -> None:
    """Refuse unusable files, and a missing package, before anything runs."""
    inputs = [*inputs, video] if video else inputs
    if report:
        require_writable(report, "the report", ".html", inputs)
        from fes_mj.viewing.pages import require_page_packages

        require_page_packages()
    if junit:
        require_writable(junit, "the JUnit file", ".xml", inputs)
    if video and not report:
        raise InputError("--video puts a video into the report; name it with --report OUT.html")
    if video and not (video.is_file() and video.suffix.lower() == ".mp4"):
        raise InputError(f"{video}: cannot read the video; it must be an .mp4 file, as `simulate --render` writes it")


def _run_checks(cases: list[VerificationCase], quick: bool, quiet: bool) -> list[Check]:
    from fes_mj.verification.suite import FULL, QUICK, benchmarks, verify

    stages = QUICK if quick else FULL
    runs = [verify(case, (stage,)) for case in cases for stage in stages] + [benchmarks()]
    return [each for run in track(runs, "checking", quiet) for each in run]


def _inject(design: str, options: RunOptions) -> tuple[Detection, ...]:
    from fes_mj.verification.faults import inject, passing
    from fes_mj.verification.mistakes import faults

    case = next(_cases((design,), options, quick=True))
    baseline = passing(case)
    possible = [fault for fault in faults() if fault.applies(case)]
    return tuple(inject(fault, case, baseline) for fault in track(possible, "injecting faults", options.silent))


def _summary(
    ok: bool, checks: list[Check], detections: Sequence[Detection], cases: list[VerificationCase]
) -> dict[str, Any]:
    content: dict[str, Any] = {
        "ok": ok,
        "checks": [each.as_json() | {"kind": definitions()[each.name].kind} for each in checks],
        "runs": [each.as_json() for each in cases],
    }
    if detections:
        content["faults"] = [each.as_json() for each in detections]
    return content | {"provenance": provenance()}


def _print(
    ok: bool, checks: list[Check], detections: Sequence[Detection], cases: list[VerificationCase], verbose: bool
) -> None:
    for subject in dict.fromkeys(each.subject for each in checks):
        own = [each for each in checks if each.subject == subject]
        print_table(subject, ("check", "value", "limit", "verdict"), check_rows(own))
    if verbose:
        for case in cases:
            _print_details(case)
    _print_runs(cases)
    for case in cases:
        print_notes(case.static, f"{case.name}: ")
    if detections:
        _print_faults(detections)
    failed = [f"{each.name} ({each.subject})" for each in checks if not each.ok]
    missed = [each.fault.name for each in detections if not each.caught]
    if ok:
        also = f", all {len(detections)} faults are caught" if detections else ""
        conclude(True, f"All {len(checks)} checks hold", f"{also}.")
    if failed:
        conclude(False, f"{len(failed)} of {len(checks)} checks failed", f": {', '.join(failed)}")
        say("`fes_mj explain CHECK` says what usually breaks one.")
    if missed:
        conclude(False, f"{len(missed)} faults went unnoticed", f": {', '.join(missed)}")


def _print_runs(cases: list[VerificationCase]) -> None:
    """Mean powers, and what the discretisation makes uncertain about them."""
    rows = [
        (
            case.name,
            f"{row['cadence_rpm']:.1f}",
            f"{1e3 * row['timestep_s']:.3f}",
            f"{row['static_power_mean_W']:.3f}",
            f"{row['power_mean_W']:.3f}",
            f"{row['numerical_uncertainty_W']:.4f}" if case.refined else "not refined",
            case.difference_text,
        )
        for case in cases
        for row in (case.row(),)
    ]
    columns = ("run", "rpm", "step, ms", "static, W", "dynamic, W", "numerical uncertainty, W", "difference")
    print_table("Mean crank power of one leg", columns, rows)


def _print_details(case: VerificationCase) -> None:
    from fes_mj.verification.references import differences

    for family, curves in case.curves.items():
        rows = [(f"{one} - {other}", f"{value:.2g}") for (one, other), value in differences(curves).items()]
        print_table(f"{case.name}: crank moment, {family} methods", ("methods", "largest difference, N m"), rows)
    terms = [(name, f"{value:.6f}") for name, value in case.audit.terms.items()]
    print_table(f"{case.name}: energy over the turn", ("term", "J"), terms)
    if case.refined:
        levels = [*case.refinement.steps, *case.refinement.softness, case.refinement.stiffer]
        numbers = [(1e3 * v.timestep, v.loop_time, v.gap, v.lost, v.work_error) for v in levels]
        print_table(
            f"{case.name}: refinement",
            ("step, ms", "loop time constant, s", "loop gap, m", "energy lost", "error of work per turn"),
            [(f"{step:.4f}", f"{time:.0e}", *(f"{value:.2e}" for value in rest)) for step, time, *rest in numbers],
        )


def _print_faults(detections: Sequence[Detection]) -> None:
    rows = [
        (each.fault.name, each.first.name, f"{each.first.factor:.2g}", str(len(each.failed)))
        if each.first
        else (each.fault.name, "nobody", "", "0")
        for each in detections
    ]
    print_table("Injected faults", ("fault", "first caught by", "times its limit", "checks that caught it"), rows)

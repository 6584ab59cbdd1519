"""`fes_mj validate`: every check of the harness, one verdict each; its reports."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Group, Parameter

from fes_mj.cli.against import against as report_against
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import DesignName, Flag, RunOptions, changed, needs, refuse_beside
from fes_mj.cli.tables import print_checks, print_notes
from fes_mj.common.checks import Check, definitions
from fes_mj.common.console import conclude, print_table, say, track
from fes_mj.common.errors import InputError
from fes_mj.common.provenance import provenance
from fes_mj.common.units import RPM
from fes_mj.common.writing import require_writable, write_text
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.viewing.pages import require_page_packages

if TYPE_CHECKING:
    from fes_mj.verification.case import VerificationCase
    from fes_mj.verification.faults import Detection

_REPORT = Group("Report", validator=needs("--report"))
# Where no design is named, faults are injected into this one: all bodies, loops and parameters exist in it.
FAULTY_DESIGN = "d1"


def validate(
    *designs: Annotated[DesignName, Parameter(name="DESIGN")],
    options: RunOptions = RunOptions(),
    drive: DriveOptions = DriveOptions(),
    quick: Flag = False,
    faults: Flag = False,
    report: Annotated[Path | None, Parameter(group=_REPORT)] = None,
    video: Annotated[Path | None, Parameter(group=_REPORT)] = None,
    junit: Path | None = None,
    explain: str | None = None,
    against: str | None = None,
) -> int:
    """Run every check of the harness on designs, the paper's five if none is named; exit code 1 if one fails.

    Args:
        quick: Seconds instead of minutes: one rider group, no refinement, two legs on one crank only with --legs 2.
        faults: Also inject faults into the first design named (default d1) and tell which check catches each.
        report: Write a self-contained report (.html).
        video: A video of `fes_mj simulate --render` to put into the report (.mp4).
        junit: Write the verdicts as JUnit XML (.xml), for continuous integration.
        explain: Instead: what this check guards against and what usually breaks it, for example mean_power; `all` lists
            them.
        against: Instead: `published`, predictions beside what others measured, or the file of an experiment (.toml),
            what it does to the probabilities of the gains. Both report: the exit code is 0 whatever agrees.
    """
    if instead := [flag for flag, value in {"--explain": explain, "--against": against}.items() if value is not None]:
        files = {"--report": report, "--video": video, "--junit": junit}
        others = {"DESIGN": designs, "--quick": quick, "--faults": faults, **files, **dict.fromkeys(instead[1:], True)}
        refuse_beside(instead[0], {**others, **changed(options, "json", "quiet"), **changed(drive)})
    if explain is not None:
        from fes_mj.cli.explanation import explain as print_explanation

        return print_explanation(explain, options)
    if against is not None:
        return report_against(against, options)
    cases = list(_cases(designs or DESIGNS, options, drive, quick))
    _check_files(report, junit, video, drive.inputs(options, *designs))
    checks = _run_checks(cases, quick, options)
    detections = _inject(designs[0] if designs else FAULTY_DESIGN, options, drive) if faults else ()
    broken = {check.subject for check in checks if check.name == "stability" and not check.ok}
    measured = [case for case in cases if case.name not in broken]
    ok = all(check.ok for check in checks) and all(detection.caught for detection in detections)
    if junit:
        from fes_mj.verification.junit import junit_xml

        write_text(junit, junit_xml(checks, detections))
    if report:
        from fes_mj.verification.report import report_html

        write_text(report, report_html(checks, detections, measured, video))
    options.show(
        lambda: _summary(ok, checks, detections, measured),
        lambda: _print(ok, checks, detections, measured, options.verbose),
    )
    return 0 if ok else 1


def _cases(designs: Sequence[str], options: RunOptions, drive: DriveOptions, quick: bool) -> Iterator[VerificationCase]:
    """Every design with the moments or muscles asked for; of both groups in a full run that names none."""
    both = [replace(options, group="p1p2"), replace(options, group="p1p3")]
    chosen = [options] if quick or options.group or options.moments or drive.muscles else both
    for design in dict.fromkeys(designs):
        for choice in chosen:
            yield drive.case(choice, design, refined=not (quick or drive.timing == "stimulation-by-angle"))


def _check_files(report: Path | None, junit: Path | None, video: Path | None, inputs: list[Path]) -> None:
    """Refuse unusable files, and a missing package, before anything runs."""
    inputs = [*inputs, video] if video else inputs
    require_writable(report, "the report", ".html", inputs)
    require_writable(junit, "the JUnit file", ".xml", inputs)
    if report:
        require_page_packages()
    if video and not (video.is_file() and video.suffix.lower() == ".mp4"):
        raise InputError(f"{video}: cannot read the video; it must be an .mp4 file, as `simulate --render` writes it")


def _run_checks(cases: list[VerificationCase], quick: bool, options: RunOptions) -> list[Check]:
    from fes_mj.verification.suite import FULL_CHECKS, benchmarks, quick_groups, verify

    groups = quick_groups(options.legs) if quick else FULL_CHECKS
    runs = [verify(case, (group,)) for case in cases for group in groups] + [benchmarks()]
    return [check for run in track(runs, "checking", options.silent) for check in run]


def _inject(design: str, options: RunOptions, drive: DriveOptions) -> tuple[Detection, ...]:
    from fes_mj.verification.faults import inject, passing
    from fes_mj.verification.mistakes import faults

    case = next(_cases((design,), options, drive, quick=True))
    baseline = passing(case)
    possible = [fault for fault in faults() if fault.applies(case)]
    return tuple(inject(fault, case, baseline) for fault in track(possible, "injecting faults", options.silent))


def _summary(
    ok: bool, checks: list[Check], detections: Sequence[Detection], cases: list[VerificationCase]
) -> dict[str, Any]:
    content: dict[str, Any] = {
        "ok": ok,
        "checks": [check.as_json() | {"kind": definitions()[check.name].kind} for check in checks],
        "runs": [case.as_json() for case in cases],
    }
    if detections:
        content["faults"] = [detection.as_json() for detection in detections]
    return content | {"provenance": provenance()}


def _print(
    ok: bool, checks: list[Check], detections: Sequence[Detection], cases: list[VerificationCase], verbose: bool
) -> None:
    for subject in dict.fromkeys(check.subject for check in checks):
        print_checks(subject, [check for check in checks if check.subject == subject])
    if verbose:
        for case in cases:
            _print_details(case)
    _print_runs(cases)
    for case in cases:
        print_notes(case.static, f"{case.name}: ")
    if detections:
        _print_faults(detections)
    failed = [f"{check.name} ({check.subject})" for check in checks if not check.ok]
    missed = [detection.fault.name for detection in detections if not detection.caught]
    if ok:
        also = f", all {len(detections)} faults are caught" if detections else ""
        conclude(True, f"All {len(checks)} checks hold", f"{also}.")
    if failed:
        conclude(False, f"{len(failed)} of {len(checks)} checks failed", f": {', '.join(failed)}")
        say("`fes_mj validate --explain CHECK` says what usually breaks one.")
    if missed:
        conclude(False, f"{len(missed)} faults went unnoticed", f": {', '.join(missed)}")


def _print_runs(cases: list[VerificationCase]) -> None:
    """Mean powers, and what the discretisation makes uncertain about them."""
    rows = []
    for case in cases:
        run, uncertainty = case.simulation, f"{case.uncertainty:.4f}" if case.refined else "not refined"
        numbers = (f"{case.cadence / RPM:.1f}", f"{1e3 * run.timestep:.3f}")
        powers = (f"{power:.3f}" for power in (case.static_power_mean, run.power_mean))
        rows.append((case.name, *numbers, *powers, uncertainty, case.difference_text))
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
        (detection.fault.name, detection.first.name, f"{detection.first.factor:.2g}", str(len(detection.failed)))
        if detection.first
        else (detection.fault.name, "nobody", "", "0")
        for detection in detections
    ]
    print_table("Injected faults", ("fault", "first caught by", "times its limit", "checks that caught it"), rows)

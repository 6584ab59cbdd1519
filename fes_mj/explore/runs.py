"""Runs that take seconds or minutes, each in a process of its own: asked for by name, stopped by ending the process.

What they are asked was checked before (answers.Answers.run); what they answer is JSON. `state` is a folder that a run
has for itself, and in which `progress` looks.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from fes_mj.common.checks import Check
from fes_mj.common.console import number
from fes_mj.common.text import typeset
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.explore.dimensions import content_of
from fes_mj.fit.seat import fit_seat, seat_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import design_toml
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.drive import Muscles
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.optimize import optimize
from fes_mj.optimization.stimulated import MuscleDrive
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.stimulated import stimulated_rider
from fes_mj.statics.drive import Drive
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import quick_groups, verify

SEARCHES = 4


def simulate(design: Design, drive: Drive, state: Path, *, legs: int) -> dict[str, Any]:
    """As `fes_mj simulate`: the verdict in a sentence, and every check. Raises what Case raises."""
    one_leg = VerificationCase(design, drive)
    case = one_leg if legs == 1 else one_leg.two_legs
    power = (
        f"mean power {case.simulation.power_mean:.2f} W against {case.statics.power_mean:.2f} W, {case.difference_text}"
    )
    if isinstance(drive, Muscles):
        power += f", by the muscles of the most probable rider of {drive.riders.name}"
    return _checked("Dynamic and static", power, [*verify(one_leg, quick_groups(legs))])


def ride(design: Design, drive: Drive, state: Path, *, transmission: str, slope: float) -> dict[str, Any]:
    """As `fes_mj ride`, slope in percent, in the same form. Raises what RideCase raises."""
    moving = stimulated_rider(drive, design) if isinstance(drive, Muscles) else drive
    case = RideCase(Ride(design, moving, Road(slope=slope / 100), transmission=transmission))
    result = case.sentence.removesuffix(".")
    return _checked("The two solvers", result[:1].lower() + result[1:], case.checks)


def fit(design: Design, moments: JointMoments, state: Path) -> dict[str, Any]:
    """As `fes_mj fit` for the design's own rider: the design with its seat moved, or why no seat suits."""
    result = fit_seat(design, design.rider, moments)
    if result.static is None:
        return {"ok": False, "verdict": typeset(f"No seat fits: {result.why}.")}
    verdict = f"Best seat: {seat_text(result.seat)}; {result.static.power_mean:.2f} W."
    return {"ok": True, "verdict": typeset(verdict), "design": content_of(result.design)}


def optimise(design: Design, drive: Drive, state: Path) -> dict[str, Any]:
    """As `fes_mj optimize --start DESIGN --speeds-of DESIGN`: the best of its kind that moves the joints no faster."""
    muscles = MuscleDrive(drive.riders, drive.duty) if isinstance(drive, Muscles) else None
    moments = load_moments(drive.riders.name) if isinstance(drive, Muscles) else drive
    start = str(state / "start.toml")
    write_text(Path(start), design_toml(design))
    kind, findings = design.linkage.kind, _findings(state)
    optimum = optimize(
        kind, moments, searches=SEARCHES, start=start, compared_with=start, findings=findings, muscles=muscles
    )
    verdict = f"Best design: {optimum.power:.2f} W, after {optimum.evaluations:,} evaluations."
    if optimum.repair:
        verdict += f" The design in hand did not keep the limits and was repaired first: {optimum.repair}."
    return {"ok": True, "verdict": verdict, "design": content_of(optimum.design) | {"name": f"{design.name}-optimised"}}


BY_MUSCLES = {"simulate", "ride", "optimise"}  # the other knows joint moments alone
RUNS: dict[str, Callable[..., dict[str, Any]]] = {run.__name__: run for run in (simulate, ride, fit, optimise)}


def progress(state: Path) -> str | None:
    """How far a search has come, None before there is anything to say."""
    findings = _findings(state)
    if not (best := findings.best):
        return None
    return f"{best[0]:.2f} W so far; {len(findings.finished())} of {SEARCHES} searches are through"


def _findings(state: Path) -> Findings:
    return Findings(state / "best.toml", "", {})


def _checked(who: str, result: str, checks: Sequence[Check]) -> dict[str, Any]:
    """Of checks that hold together or not; the page shows `verdict` and a table."""
    failed = ", ".join(check.name for check in checks if not check.ok)
    verdict = f"{who} do not agree ({failed}): {result}." if failed else f"{who} agree: {result}."
    rows = [
        {
            "name": check.name.replace("_", " "),
            "value": number(check.value, check.unit),
            "limit": number(check.limit, check.unit),
            "ok": bool(check.ok),
        }
        for check in checks
    ]
    return {"ok": not failed, "verdict": typeset(verdict), "checks": rows}

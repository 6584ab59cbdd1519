"""The real thing behind a button of the page: MuJoCo beside the project's own solvers, and what came out."""

from collections.abc import Sequence
from typing import Any

from fes_mj.common.checks import Check
from fes_mj.common.console import number
from fes_mj.common.text import typeset
from fes_mj.common.units import KMH
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.riding.ride import Ride


def simulated(design: Design, moments: JointMoments, legs: int) -> dict[str, Any]:
    """As `fes_mj simulate`: the verdict in a sentence, and every check. Raises what Case raises."""
    case = Case(design, moments, legs=legs)
    power = (
        f"mean power {case.simulation.power_mean:.2f} W against {case.statics.power_mean:.2f} W, {case.difference_text}"
    )
    return _outcome("Dynamic and static", power, case.checks)


def ridden(design: Design, moments: JointMoments) -> dict[str, Any]:
    """As `fes_mj ride` on the flat, in the same form. Raises what RideCase raises."""
    case = RideCase(Ride(design, moments.at_speed(load_torque_velocity("hill"))))
    trace = case.simulation.trace
    result = f"it stops after {trace.stopped_at:.1f} s" if trace.stopped_at is not None else "it rides"
    if trace.mean_speed is not None:
        result += f", {trace.mean_speed / KMH:.2f} km/h at the end"
    return _outcome("The two solvers", result, case.checks)


def _outcome(who: str, result: str, checks: Sequence[Check]) -> dict[str, Any]:
    """Of checks that hold together or not; the page shows `verdict` and a table."""
    failed = ", ".join(each.name for each in checks if not each.ok)
    verdict = f"{who} do not agree ({failed}): {result}." if failed else f"{who} agree: {result}."
    rows = [
        {
            "name": each.name.replace("_", " "),
            "value": number(each.value, each.unit),
            "limit": number(each.limit, each.unit),
            "ok": bool(each.ok),
        }
        for each in checks
    ]
    return {"agrees": not failed, "verdict": typeset(verdict), "checks": rows}

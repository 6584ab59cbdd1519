"""The real thing behind a button of the page: MuJoCo beside the project's own solvers, and what came out."""

from typing import Any

from fes_mj.console import number
from fes_mj.crosscheck import Case
from fes_mj.design import Design
from fes_mj.moments import JointMoments


def simulated(design: Design, moments: JointMoments, legs: int = 1) -> dict[str, Any]:
    """As `fes_mj simulate`: the verdict in a sentence, and every check. Raises what Case raises."""
    case = Case(design, moments, legs=legs)
    power = f"mean power {case.simulation.power_mean:.2f} W against {case.static_power_mean:.2f} W"
    verdict = f"Dynamic and static agree: {power}, {case.difference_text}."
    if not case.agrees:
        failed = ", ".join(each.name for each in case.checks if not each.ok)
        verdict = f"Dynamic and static do not agree: {failed}; {power}."
    return {"agrees": case.agrees, "verdict": verdict, "checks": _rows(case.checks)}


def _rows(checks: Any) -> list[dict[str, Any]]:
    return [
        {
            "name": each.name.replace("_", " "),
            "value": number(each.value, each.unit),
            "limit": number(each.limit, each.unit),
            "ok": bool(each.ok),
        }
        for each in checks
    ]

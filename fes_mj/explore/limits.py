"""Where a design leaves the limits of the paper's Eq. 15, as the optimiser counts them."""

from typing import Any, NamedTuple

from fes_mj.common.text import typeset
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import lengths
from fes_mj.optimization.limits import (
    Constraint,
    Limits,
    length_constraints,
    length_values,
    load_limits,
    range_constraints,
)
from fes_mj.statics.turn import QuasiStatic


class Mark(NamedTuple):
    """How the page speaks of a constraint, and which of its numbers and sliders it colours."""

    words: str
    colours: tuple[str, ...]


# By constraint. A joint's speed and the gear ratio are bounded by the optimiser alone.
MARKS = {
    "crank_length": Mark("the crank", ("R2",)),
    "rocker_length": Mark("the rocker", ("R10",)),
    "ankle_to_pedal": Mark("the foot from ankle to pedal", ("R6",)),
    "crank_shortest": Mark("the shortest other link less the crank", ("R2",)),
    "grashof": Mark("the Grashof margin", ("grashof",)),
    "rocker_pivot_inside": Mark("the rocker pivot's distance inside the design space", ("R1x", "R1y")),
    "crank_centre_inside": Mark("the crank centre's distance inside the design space", ("R7x", "R7y")),
    "knee_min": Mark("the smallest knee angle", ("knee_range",)),
    "knee_max": Mark("the largest knee angle", ("knee_range",)),
    "hip_min": Mark("the smallest hip angle", ("hip_range",)),
    "hip_max": Mark("the largest hip angle", ("hip_range",)),
}


def broken(design: Design, static: QuasiStatic | None) -> list[dict[str, Any]]:
    """The limits that a design leaves: what they colour, and a sentence. static: any turn of it, if it turns."""
    limits = load_limits()
    values = _lengths(design, limits)
    if static:
        for joint, (low, high) in static.joint_range_deg.items():
            values |= {f"{joint}_min": low, f"{joint}_max": high}
    return [
        {"marks": MARKS[name].colours, "text": _sentence(constraint, values[name])}
        for constraint in (*length_constraints(limits), *range_constraints(limits))
        if (name := constraint.name) in MARKS and name in values and not constraint.margin(values[name]) >= 0
    ]


def _lengths(design: Design, limits: Limits) -> dict[str, float]:
    """Values of the limits on lengths by name, m; a TRT has no rocker, and the design space is six-bars'."""
    if design.linkage.kind == "trt":
        return {"crank_length": design.linkage.crank, "ankle_to_pedal": design.linkage.foot}
    values = length_values(design, lengths(design)[None], limits.polygon)[0]
    return {
        constraint.name: value for constraint, value in zip(length_constraints(limits), values.tolist(), strict=True)
    }


def _sentence(constraint: Constraint, value: float) -> str:
    unit, factor = ("cm", 100.0) if constraint.unit == "m" else (constraint.unit, 1.0)
    bound = "at least" if constraint.at_least else "at most"
    words, shown = MARKS[constraint.name].words, typeset(f"{factor * value:.2f}")
    return f"{words} is {shown} {unit}; it must be {bound} {factor * constraint.limit:g} {unit}"

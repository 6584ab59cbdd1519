"""Where every body is over the turn, how it is drawn, and a linkage that cannot close: it is left open there."""

from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.style import hex_colour
from fes_mj.linkage.assembly import DYADS, LEAST_CLEARANCE, clearances
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.kinematics import close_dyad, positions
from fes_mj.linkage.shapes import PARTS, Bar, back_to_front

Ends = dict[str, tuple[ComplexArray, ComplexArray]]  # body -> its origin and tip over crank angle, m


def ends(design: Design, crank_angle: FloatArray) -> Ends:
    """Origin and tip of every body at crank angles, rad, shape (angles,).

    Where two links cannot close, their ends point at each other along the line on which they lack least, and what they
    carry goes on from there.
    """
    linkage, points = design.linkage, positions(design, crank_angle)
    hip, pin = points["hip"], points["crank_pin"]
    bodies = {"crank": (np.broadcast_to(points["crank_centre"], pin.shape), pin)}
    if "coupler" in linkage.architecture.bodies:
        pivot = points["rocker_pivot"]
        tip, origin = _apart(pivot, pin, linkage.rocker, linkage.coupler, points["rocker_joint"])
        bodies |= {"rocker": (np.broadcast_to(pivot, pin.shape), tip), "coupler": (origin, pin)}
    origin, tip = bodies[linkage.architecture.pedal_body]
    pedal = origin + (tip - origin) * linkage.pedal_offset
    with np.errstate(invalid="ignore", divide="ignore"):
        knee = close_dyad(pedal, hip, design.knee_to_pedal, design.rider.thigh)
    above, below = _apart(hip, pedal, design.rider.thigh, design.knee_to_pedal, knee)
    return bodies | {"thigh": (np.broadcast_to(hip, pin.shape), above), "shank": (below, pedal)}


def _apart(
    start: ComplexArray, end: ComplexArray, first: float, second: float, joint: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Tips of the links at `start` and at `end`: their joint or, where that is NaN, as near as they come."""
    span = end - start
    distance = np.abs(span)
    along = np.where(distance > 0, span / np.where(distance > 0, distance, 1), 1)
    far = distance > first + second  # stretched; otherwise the longer link folds back over the shorter
    tips = (
        start + np.where(far | (first > second), first, -first) * along,
        end - np.where(far | (second > first), second, -second) * along,
    )
    open_there = np.isnan(joint)
    return np.where(open_there, tips[0], joint), np.where(open_there, tips[1], joint)


def failing(design: Design) -> dict[str, Any] | None:
    """At which crank angle, deg, a linkage first lacks most to turn, and a sentence; None if it closes all round."""
    for links, (margin,), _, (angle,) in clearances(design):
        if not margin >= LEAST_CLEARANCE:
            degrees, pair = float(np.degrees(angle)), " and ".join(links)
            text = f"{pair} cannot close at crank angle {degrees:.1f} deg: {-100 * margin:.2f} cm are missing"
            if margin >= 0:
                text = (
                    f"{pair} come within {100 * margin:.3f} cm of their dead centre at crank angle {degrees:.1f} deg; "
                    f"{100 * LEAST_CLEARANCE:g} cm are needed"
                )
            return {"deg": degrees, "text": text}
    return None


def as_json(design: Design, crank_angle: FloatArray) -> dict[str, Any]:
    """Bodies over the turn and what is drawn of them, m."""
    bodies = ends(design, crank_angle)
    return {
        "bodies": {body: [plane(end) for end in pair] for body, pair in bodies.items()},
        "pedal": plane(bodies["shank"][1]),
        "pedal_on": design.linkage.architecture.pedal_body,
        "bars": [bar_json(bar) for bar in back_to_front(design)],
        "pins": [pin(joint, bodies) for joint in design.linkage.architecture.joints],
        "dyads": [pair for pair in DYADS if pair[0] in bodies],
    }


def bar_json(bar: Bar) -> dict[str, Any]:
    """Of a bar its body, ends in the body's frame and width, m, and colour."""
    line = [bar.start.real, bar.start.imag, bar.end.real, bar.end.imag]
    return {"body": bar.body, "line": line, "width": bar.width, "colour": bar.colour}


def pin(joint: str, bodies: Ends) -> dict[str, Any]:
    """The pin of a joint, at the origin (0) or tip (1) of a body."""
    body, end = next((body, BODIES[body].index(joint)) for body in bodies if joint in BODIES[body])
    part = PARTS.get(joint, PARTS["pin"])
    return {"body": body, "end": end, "radius": part.size, "colour": hex_colour(part.colour)}


def plane(points: ComplexArray) -> list[FloatArray]:
    """X and y to a tenth of a millimetre."""
    return [np.round(part, 4) for part in (points.real, points.imag)]

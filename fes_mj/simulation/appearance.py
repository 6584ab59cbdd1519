"""What a model looks like: geoms of leg, linkage and tricycle, materials and camera.

Geoms have no mass and touch nothing. The links, the pedal and the leg are drawn in layers beside each other, so that
none hides another; the joints themselves all lie in one plane.
"""

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import mujoco
import numpy as np

from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import bounding_box
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.shapes import BACKREST, PARTS, Bar, bars

Spec: TypeAlias = Any  # mujoco.MjSpec and its elements, which have no types
# Geoms of parts; the others are capsules.
_CYLINDERS = dict.fromkeys(("hip", "knee", "pin", "chainring"), mujoco.mjtGeom.mjGEOM_CYLINDER)
_GEOMS = _CYLINDERS | {"seat": mujoco.mjtGeom.mjGEOM_BOX}

# Layers of one leg, m outwards from the plane of its joints. The linkage is drawn outside the leg, not between foot and
# frame where a tricycle has it: there the leg would hide it from the side.
LAYERS = {"frame": -0.13, "leg": -0.065, "coupler": 0.0, "crank": 0.025, "rocker": 0.05}
PIN_END = 0.012  # m that a pin stands out on either side of what it joins
LIMB_PIN_END = 0.07  # m, the same for the joints inside a leg

SEAT_WIDTH = 0.32  # m
FIELD_OF_VIEW = 30.0  # deg, vertical
ASPECT = 4 / 3  # the narrowest picture that still shows everything
MARGIN = 0.14  # m around the joints, for the flesh, the boot and the seat


def define_parts(spec: Spec, parent: Spec) -> None:
    """A material and a default class of geoms, below `parent`, for every kind of part."""
    for name, part in PARTS.items():
        spec.add_material(name=name, rgba=(*part.colour, 1))
        geom = spec.add_default(name, parent).geom
        geom.type = _GEOMS.get(name, mujoco.mjtGeom.mjGEOM_CAPSULE)
        geom.size, geom.material = (part.size, 0, 0), name


def on_body(leg: Leg, body: str) -> tuple[str, complex, float]:
    """A leg's body in the model: its name, the leg's x axis and plane's y (m) in it; the legs share a crank."""
    if body == "crank":
        return "crank", complex(np.exp(-1j * leg.lag)), leg.lateral
    return leg.prefix + body, 1 + 0j, 0.0


def draw_bodies(spec: Spec, design: Design, legs: Sequence[Leg]) -> None:
    """Give every body of the assembled model its geoms, and the model the camera `side`, which sees the whole turn."""
    middle = float(np.mean([leg.lateral + leg.outwards * LAYERS["frame"] for leg in legs]))
    for leg in legs:
        for bar in bars(design):
            if bar.body:
                _draw_bar(spec, bar, leg)
        _draw_pins(spec, design, leg, middle)
    _draw_frame(spec, design, middle)
    _add_camera(spec, design)


def _bar(spec: Spec, body: str, part: str, name: str, start: tuple[complex, float], end: tuple[complex, float]) -> None:
    """A geom of the class `part` between two points of a body, each (in the plane, across it), m; none if they meet."""
    (first, first_y), (second, second_y) = start, end
    ends = (np.real(first), first_y, np.imag(first), np.real(second), second_y, np.imag(second))
    rounded = [round(float(value), 4) + 0.0 for value in ends]
    if rounded[:3] != rounded[3:]:  # MuJoCo takes no capsule without length
        spec.body(body).add_geom(spec.find_default(part), name=name, fromto=rounded)


def _draw_bar(spec: Spec, bar: Bar, leg: Leg) -> None:
    """A bar of the leg or of its linkage, in its layer."""
    owner, arm, plane = on_body(leg, bar.body)
    across = plane + leg.outwards * LAYERS.get(bar.body, LAYERS["leg"])
    _bar(spec, owner, bar.part, leg.prefix + bar.name, (bar.start * arm, across), (bar.end * arm, across))


def _draw_pins(spec: Spec, design: Design, leg: Leg, middle: float) -> None:
    """A pin at every joint, through the layers of the bodies it connects."""
    layer = {body: leg.outwards * across for body, across in LAYERS.items()}
    layer |= {"thigh": layer["leg"], "shank": layer["leg"], "frame": middle - leg.lateral}
    for joint, pair in design.linkage.architecture.joints.items():
        inside = joint in ("hip", "knee")
        # drawn on the body that has the joint at its origin, or else at its tip
        at_origin = next((body for body in pair if BODIES.get(body, ("",))[0] == joint), None)
        body = at_origin or pair[0]
        owner, arm, plane = on_body(leg, body)
        point = 0j if at_origin else complex(design.link_lengths[body]) * arm
        ends = sorted(layer[side] for side in pair if not (inside and side == "frame"))
        beyond, part = (LIMB_PIN_END, joint) if inside else (PIN_END, "pin")
        near, far = plane + ends[0] - beyond, plane + ends[-1] + beyond
        _bar(spec, owner, part, f"{leg.prefix}{joint}_pin", (point, near), (point, far))


def _draw_frame(spec: Spec, design: Design, middle: float) -> None:
    """Seat, tube from it over the fixed pivots to the crank, and the chainring."""
    frame, pad = spec.body("tricycle"), spec.find_default("seat")
    for bar in bars(design):
        if bar.part == "seat":
            along = bar.end - bar.start
            centre, turn = bar.start + along / 2, -float(np.angle(along)) / 2  # half the turn about +y
            frame.add_geom(
                pad,
                name=bar.name,
                pos=[round(value, 4) for value in (centre.real, middle, centre.imag)],
                quat=[round(value, 6) + 0.0 for value in (math.cos(turn), 0.0, math.sin(turn), 0.0)],
                size=(abs(along) / 2, SEAT_WIDTH / 2, PARTS["seat"].size),
            )
        elif not bar.body:
            _bar(spec, "tricycle", bar.part, bar.name, (bar.start, middle), (bar.end, middle))
    _bar(spec, "crank", "chainring", "chainring", (0j, middle - 0.003), (0j, middle + 0.003))


def _add_camera(spec: Spec, design: Design) -> None:
    """From the rider's right; the rider looks to the right of the picture."""
    centre, distance = framing(design)
    camera = spec.body("tricycle").add_camera(name="side", fovy=FIELD_OF_VIEW)
    camera.pos = [round(value, 3) for value in (centre.real, distance, centre.imag)]
    camera.alt.type, camera.alt.xyaxes = mujoco.mjtOrientation.mjORIENTATION_XYAXES, (-1, 0, 0, 0, 0, 1)


def framing(design: Design) -> tuple[complex, float]:
    """The middle of all that moves or sits (in the plane, m) and the distance from which FIELD_OF_VIEW shows it (m)."""
    points = kinematics.positions(design, kinematics.FULL_TURN)
    backrest = np.asarray(BACKREST * np.exp(1j * design.linkage.seat_angle))
    low, high = bounding_box(points | {"backrest": backrest})
    low, high = low - MARGIN * (1 + 1j), high + MARGIN * (1 + 1j)
    size = high - low
    return (low + high) / 2, max(size.imag, size.real / ASPECT) / 2 / math.tan(math.radians(FIELD_OF_VIEW) / 2)

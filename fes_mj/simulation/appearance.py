"""What a design looks like: leg, linkage and tricycle as bars, and the model's geoms, materials and camera.

Geoms have no mass and touch nothing. The links, the pedal and the leg are drawn in layers beside each other, so that
none hides another; the joints themselves all lie in one plane.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, TypeAlias

import mujoco
import numpy as np

from fes_mj.common.arrays import ComplexArray
from fes_mj.common.style import COLOURS, LINKS, hex_colour, rgb
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import bounding_box
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.inertia import foot_points
from fes_mj.linkage.legs import Leg

Spec: TypeAlias = Any  # mujoco.MjSpec and its elements, which have no types
_CAPSULE, _BOX = mujoco.mjtGeom.mjGEOM_CAPSULE, mujoco.mjtGeom.mjGEOM_BOX
_CYLINDER = mujoco.mjtGeom.mjGEOM_CYLINDER


class Part(NamedTuple):
    """A default class of geoms and the material it wears."""

    shape: mujoco.mjtGeom
    size: float  # m: radius of a capsule or cylinder, half the thickness of a pad
    colour: tuple[float, float, float]  # RGB, each 0 to 1


PARTS = {
    "thigh": Part(_CAPSULE, 0.065, rgb(LINKS["thigh"])),
    "shank": Part(_CAPSULE, 0.048, rgb(LINKS["shank"])),
    "boot": Part(_CAPSULE, 0.052, (0.27, 0.30, 0.35)),
    "hip": Part(_CYLINDER, 0.028, rgb(COLOURS["hip"])),
    "knee": Part(_CYLINDER, 0.028, rgb(COLOURS["knee"])),
    "crank": Part(_CAPSULE, 0.011, rgb(LINKS["crank"])),
    "rocker": Part(_CAPSULE, 0.011, rgb(LINKS["rocker"])),
    "coupler": Part(_CAPSULE, 0.011, rgb(LINKS["coupler"])),
    "pin": Part(_CYLINDER, 0.011, (0.22, 0.23, 0.26)),
    "chainring": Part(_CYLINDER, 0.075, (0.36, 0.38, 0.42)),
    "frame": Part(_CAPSULE, 0.018, (0.64, 0.67, 0.70)),
    "seat": Part(_BOX, 0.02, (0.45, 0.48, 0.53)),
}
BACKREST = 0.45  # m
SEAT_LENGTH = 0.25  # m
SEAT_DEPTH = 0.12  # m from the hip down to the seat

_CAP = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 17))  # half of a circle
_BACK_TO_FRONT = ("frame", "seat", "thigh", "shank", "boot", "coupler", "crank", "rocker")


class Bar(NamedTuple):
    """A part of PARTS between two points of a body ("" is the tricycle), m."""

    name: str
    body: str
    part: str
    start: complex
    end: complex

    @property
    def width(self) -> float:
        """Thickness, m."""
        return 2 * PARTS[self.part].size

    @property
    def colour(self) -> str:
        """As CSS writes it."""
        return hex_colour(PARTS[self.part].colour)

    def outline(self, origin: complex, direction: complex) -> ComplexArray:
        """With its round ends, m, for a body whose frame has this origin and x axis."""
        along, radius = (self.end - self.start) / abs(self.end - self.start), self.width / 2
        shape = np.concatenate([self.end + radius * along * _CAP, self.start - radius * along * _CAP])
        return np.asarray(origin + direction * shape)


def back_to_front(design: Design) -> list[Bar]:
    """The bars of a flat picture in the order in which they hide each other, as in the video."""
    return sorted(bars(design), key=lambda bar: _BACK_TO_FRONT.index(bar.part))


def bars(design: Design) -> Iterator[Bar]:
    """The leg, the linkage beside it, the tricycle."""
    yield from _limb(design)
    yield from _links(design)
    linkage, corner = design.linkage, SEAT_DEPTH * (0.5 - 1j)
    yield Bar("seat", "", "seat", corner, corner - SEAT_LENGTH)
    yield Bar("backrest", "", "seat", corner, corner + BACKREST * complex(np.exp(1j * linkage.seat_angle)))
    yield Bar("seat_tube", "", "frame", corner, complex(linkage.ground))
    if linkage.pivot_to_crank:  # a TRT's ground link ends at the crank
        yield Bar("boom", "", "frame", complex(linkage.ground), complex(linkage.crank_centre))


def _limb(design: Design) -> Iterator[Bar]:
    ankle, heel, toe = foot_points(design)
    sole, radius = (toe - heel) / abs(toe - heel), PARTS["boot"].size
    yield Bar("thigh", "thigh", "thigh", 0j, complex(design.rider.thigh))
    yield Bar("shank", "shank", "shank", 0j, ankle)
    yield Bar("boot", "shank", "boot", heel + radius * sole, toe - radius * sole)
    yield Bar("boot_shaft", "shank", "boot", 0.6 * ankle, ankle)


def _links(design: Design) -> Iterator[Bar]:
    linkage = design.linkage
    for body in linkage.architecture.bodies[2:]:
        tip = complex(design.link_lengths[body])
        pedal = tip * complex(linkage.pedal_offset)
        carries = body == linkage.architecture.pedal_body != "crank"
        # the rocker's pedal arm lies in line with it
        yield Bar(f"{body}_bar", body, body, 0j, pedal if carries and body == "rocker" else tip)
        if carries and body == "coupler":  # its pedal arm stands off it, so a third bar makes it a triangle
            yield Bar(f"{body}_pedal_arm_bar", body, body, 0j, pedal)
            yield Bar(f"{body}_brace_bar", body, body, pedal, tip)


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
        geom.type, geom.size, geom.material = part.shape, (part.size, 0, 0), name


def draw(spec: Spec, design: Design, legs: Sequence[Leg]) -> None:
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
    """A bar of the leg or of its linkage, in its layer; the legs share the crank, an arm each."""
    name, across = leg.prefix + bar.name, leg.outwards * LAYERS.get(bar.body, LAYERS["leg"])
    if bar.body == "crank":
        arm = np.exp(-1j * leg.lag)
        across += leg.lateral
        _bar(spec, "crank", bar.part, name, (bar.start * arm, across), (bar.end * arm, across))
    else:
        _bar(spec, leg.prefix + bar.body, bar.part, name, (bar.start, across), (bar.end, across))


def _draw_pins(spec: Spec, design: Design, leg: Leg, middle: float) -> None:
    """A pin at every joint, through the layers of the bodies it connects."""
    layer = {body: leg.outwards * across for body, across in LAYERS.items()}
    layer |= {"thigh": layer["leg"], "shank": layer["leg"], "frame": middle - leg.lateral}
    for joint, pair in design.linkage.architecture.joints.items():
        inside = joint in ("hip", "knee")
        # drawn on the body that has the joint at its origin, or else at its tip
        at_origin = next((body for body in pair if BODIES.get(body, ("",))[0] == joint), None)
        body = at_origin or pair[0]
        owner, point, plane = leg.prefix + body, 0j if at_origin else complex(design.link_lengths[body]), 0.0
        if body == "crank":
            owner, point, plane = "crank", point * np.exp(-1j * leg.lag), leg.lateral
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


def lowest_point(design: Design) -> float:
    """How far above (below, if negative) the hip the lowest point of boot, linkage and seat comes in a turn, m."""
    motion = kinematics.solve(design, kinematics.FULL_TURN)
    foot = [motion.body_point("shank", point).value for point in foot_points(design)[1:]]
    lowest = min(float(np.min(np.imag(point))) for point in (*foot, *(jet.value for jet in motion.points.values())))
    return min(lowest - PARTS["boot"].size, -SEAT_DEPTH - PARTS["seat"].size)

"""Wheels of a tricycle that is filmed: they roll with the road, and have no part in any physics."""

import math
from itertools import pairwise

import mujoco

from fes_mj.linkage.design import WHEEL_DIAMETER, Design
from fes_mj.linkage.shapes import BACKREST, lowest_point
from fes_mj.simulation.appearance import Spec

ROAD_CLEARANCE = 0.1  # m between the lowest point of all that moves and the road, unless the frame says where that is
FRONT_DIAMETER, BEHIND, TRACK = 0.41, 0.7 * BACKREST, 0.75  # m: of the front wheel; of the rear axle behind the hip
_RIM, _SPOKE, _PIECES, _SPOKES = 0.012, 0.004, 32, 5
_COLOUR = (0.22, 0.23, 0.26, 1.0)


def ground(design: Design) -> float:
    """Height of the road above the hip, m."""
    height = design.frame.ground_height
    return lowest_point(design) - ROAD_CLEARANCE if height is None else height


def add_wheels(spec: Spec, design: Design) -> dict[str, float]:
    """Two wheels behind the seat, one in front, that of the frame where it is known; radius (m) by the joint's name."""
    road, frame = ground(design), design.frame
    radius, small = WHEEL_DIAMETER / 2, FRONT_DIAMETER / 2
    front = complex(design.linkage.crank_centre.real, road + small)
    if frame.wheel_centre is not None and frame.wheel_diameter:
        front, small = frame.wheel_centre, frame.wheel_diameter / 2
    rear = complex(BEHIND, road + radius)
    _add_wheel(spec, "front_wheel", front, 0.0, small)
    for name, lateral in (("right_wheel", -TRACK / 2), ("left_wheel", TRACK / 2)):
        _add_wheel(spec, name, rear, lateral, radius)
    return {"front_wheel": small, "right_wheel": radius, "left_wheel": radius}


def _add_wheel(spec: Spec, name: str, centre: complex, lateral: float, radius: float) -> None:
    body = spec.body("tricycle").add_body(name=name, pos=(centre.real, lateral, centre.imag))
    body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, -1, 0))
    rim = [_on_circle(radius - _RIM, piece / _PIECES) for piece in range(_PIECES + 1)]
    pieces = [(*start, *end, _RIM) for start, end in pairwise(rim)]
    pieces += [(0.0, 0.0, 0.0, *_on_circle(radius, spoke / _SPOKES), _SPOKE) for spoke in range(_SPOKES)]
    for *ends, thickness in pieces:
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=ends,
            size=(thickness, 0, 0),
            rgba=_COLOUR,
            mass=1e-3,
            contype=0,
            conaffinity=0,
        )


def _on_circle(radius: float, share: float) -> tuple[float, float, float]:
    angle = 2 * math.pi * share
    return radius * math.cos(angle), 0.0, radius * math.sin(angle)

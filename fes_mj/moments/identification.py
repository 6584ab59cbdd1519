"""The tricycle of a trial by its own joint angles: where the pedal went round, seen from hip and trunk."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.moments.averaging import few_factor
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.turn import Turn

_LEAST_TURNS = 2


class Identified(NamedTuple):
    """A number of the tricycle: by the recorded angles, with its standard deviation, and as declared."""

    symbol: str
    unit: str
    identified: float
    sd: float
    declared: float


def identify_tricycle(turns: Sequence[Turn], measured_on: ReferenceTricycle) -> list[Identified]:
    """Length of R1, R2 and the seat's angle by least squares from the angles of hip and knee in every turn.

    With thigh, shank and R6 as declared the two angles say where the pedal is: on a circle about the end of R1 with
    radius R2. Joint angles know the seat's angle from the direction of R1 only, which is taken as declared; a tilt of
    the pelvis is in it. The deviation is that of the mean of the turns: what the declared lengths are wrong by scales
    R1 and R2. Raises InputError unless two turns have both angles.
    """
    both = [turn for turn in turns if {"knee", "hip"} <= turn.joint_angle.keys()]
    if len(both) < _LEAST_TURNS:
        raise InputError(
            f"the tricycle is identified from the angles of knee and hip in {_LEAST_TURNS} whole turns or more, "
            f"{len(both)} such turns are there; knee_angle and hip_angle of a measurement file name their columns"
        )
    linkage = measured_on.design.linkage
    circles = np.array([_circle(_pedal(turn, measured_on)) for turn in both])
    centre, crank = circles[:, 0] + 1j * circles[:, 1], circles[:, 2]
    turned = np.degrees(np.angle(linkage.crank_centre / centre) + linkage.seat_angle)
    few = few_factor(len(both)) / np.sqrt(len(both))
    return [
        Identified(symbol, unit, float(values.mean()), float(few * values.std(ddof=1)), float(declared))
        for symbol, unit, values, declared in (
            ("R1", "m", np.abs(centre), abs(linkage.crank_centre)),
            ("R2", "m", crank, linkage.crank),
            ("seat_angle", "deg", turned, np.degrees(linkage.seat_angle)),
        )
    ]


def _pedal(turn: Turn, measured_on: ReferenceTricycle) -> ComplexArray:
    """Where the pedal is, m from the hip, shape (m,); kinematics.joint_angles the other way round."""
    design = measured_on.design
    thigh = np.exp(1j * (turn.joint_angle["hip"] + design.linkage.seat_angle))
    leg = -thigh * np.exp(-1j * (turn.joint_angle["knee"] + design.boot_angle))
    return np.asarray(design.rider.thigh * thigh + design.knee_to_pedal * leg)


def _circle(points: ComplexArray) -> FloatArray:
    """Centre (x, y) and radius of the circle nearest to points: least squares of their distances from it."""
    from scipy.optimize import least_squares

    middle = points.mean()
    guess = [middle.real, middle.imag, np.abs(points - middle).mean()]
    return np.asarray(least_squares(lambda c: np.abs(points - (c[0] + 1j * c[1])) - c[2], guess).x)

"""Joint moments over the TRT's crank angle, and the torque map: the same moments over joint angle and direction.

The map (paper, Section 4) answers: at which crank angle did the traditional tricycle have this joint
at this angle, moving in this direction? The moment measured there is the moment delivered here. The
question has a closed-form answer, so the map is exact and needs no table over joint angle.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.design import Design, Linkage, Rider
from fes_mj.errors import InputError
from fes_mj.torque_velocity import TorqueVelocity

# The tricycle and rider of the moments, whatever linkage the map is applied to (paper, Section 3).
REFERENCE = Design(
    "reference TRT",
    Linkage("trt", ground=-0.736 - 0.304j, crank=0.15, foot=0.069, seat_angle=math.radians(60)),
    Rider(thigh=0.52, shank=0.52),
)
# Crank angle of the most bent leg: crank pointing from its centre to the hip, rad (22.4 deg).
TOP_DEAD_CENTRE = float(np.angle(-REFERENCE.linkage.crank_centre))

GROUPS = ("p1p2", "p1p3")
JOINTS = ("knee", "hip")
COLUMNS = ("crank_angle_deg", "knee_Nm", "hip_Nm")
LARGEST_MOMENT = 1e4  # N m, ten times what a strong leg can do; beyond it the unit is another one
TABLE_SIZE = 3600  # moments are interpolated linearly on a uniform grid of 0.1 deg
_GRID = np.arange(TABLE_SIZE + 2) * (2 * np.pi / TABLE_SIZE)  # from top dead centre; two more for rounding at the end


@dataclass(frozen=True)
class JointMoments:
    """Net knee and hip moment of one leg over the reference TRT's crank angle, periodic, extension positive.

    crank_angle: shape (n,), rad from top dead centre, increasing within [0, 2 pi).
    knee, hip: shape (n,), N m.
    covariance: of the curves' Fourier coefficients, knee's then hip's (fes_mj.fourier), (N m)^2, shape (98, 98);
    None where their error is not known.
    torque_velocity: how the moments change with joint speed; None is the paper's assumption, not at all.
    """

    name: str
    crank_angle: NDArray[np.float64]
    knee: NDArray[np.float64]
    hip: NDArray[np.float64]
    covariance: NDArray[np.float64] | None = None
    torque_velocity: TorqueVelocity | None = None


class TorqueMap:
    """Moment of the knee or the hip at a joint angle, in extension or flexion."""

    def __init__(self, moments: JointMoments) -> None:
        self.moments = moments
        self._tables = {
            joint: np.interp(_GRID, moments.crank_angle, getattr(moments, joint), period=2 * np.pi) for joint in JOINTS
        }

    def moment(self, joint: str, angle: Any, rate: Any) -> Any:
        """Moment in N m, any shape. angle: rad. rate: rad/s, zero is extension.

        Without a torque-velocity relation only the sign of the rate, the direction, counts.
        """
        source = source_angle(joint, angle, rate)
        moment = self.at_source(joint, source)
        if self.moments.torque_velocity is None:
            return moment
        return moment * self._speed_factor(joint, source, moment, rate)

    def at_source(self, joint: str, source: Any) -> Any:
        """Moment in N m at crank angles of the reference TRT, rad from top dead centre, any shape; speed-free."""
        return _interpolated(self._tables[joint], source)

    def speed_factor(self, joint: str, angle: Any, rate: Any) -> Any:
        """Moment at this rate (rad/s) per moment at the rate the reference TRT had there; needs the relation."""
        source = source_angle(joint, angle, rate)
        return self._speed_factor(joint, source, self.at_source(joint, source), rate)

    def _speed_factor(self, joint: str, source: Any, moment: Any, rate: Any) -> Any:
        relation, sign = self.moments.torque_velocity, np.sign(moment)
        assert relation is not None
        then = _interpolated(reference_rates()[joint], source)
        return relation.factor(joint, sign * rate) / relation.factor(joint, sign * then)

    def feedback(self, joint: str) -> Callable[[float, float], float]:
        """The same map for plain floats, (angle, rate) -> moment; twenty times faster for one value at a time."""
        lookup, relation = scalar_map(joint, _acos_float), self.moments.torque_velocity
        mapped = partial(lookup, self._tables[joint].tolist())
        if relation is None:
            return mapped
        then, factor = partial(lookup, reference_rates()[joint].tolist()), relation.float_factor

        def moment(angle: float, rate: float) -> float:
            measured = mapped(angle, rate)
            sign = math.copysign(1.0, measured)
            return measured * factor(joint, sign * rate) / factor(joint, sign * then(angle, rate))

        return moment

    def table(self, joint: str) -> NDArray[np.float64]:
        """Moment at every step of the uniform grid of crank angles, N m, as scalar_map takes it."""
        return self._tables[joint]


def scalar_map(
    joint: str, acos: Callable[[float], float], compiled: Callable[[Any], Any] = lambda function: function
) -> Callable[[Any, float, float], float]:
    """The map of any moments for plain floats: (table, angle, rate) -> moment.

    acos: takes a rounding error beyond -1 or 1. compiled: what turns Python functions into machine code.
    """
    source, scale = compiled(_INVERSES[joint](math, acos)), TABLE_SIZE / (2 * math.pi)
    low, high = reference_ranges()[joint]

    def moment(table: Any, angle: float, rate: float) -> float:
        angle = low if angle < low else high if angle > high else angle
        position = source(angle, 1.0 if rate >= 0 else -1.0) * scale
        if position < 0:
            position += TABLE_SIZE
        index = int(position)
        return table[index] + (position - index) * (table[index + 1] - table[index])

    return compiled(moment)


def _interpolated(table: NDArray[np.float64], source: Any) -> Any:
    """Value of a table over the uniform grid at crank angles of the reference TRT, rad from top dead centre."""
    position = np.mod(source, 2 * np.pi) * (TABLE_SIZE / (2 * np.pi))
    index = np.nan_to_num(position).astype(np.int64)
    return table[index] + (position - index) * (table[index + 1] - table[index])


@cache
def reference_rates() -> dict[str, NDArray[np.float64]]:
    """Joint rates of the reference TRT at its own cadence (60.1 rpm), rad/s, over the grid of the moments."""
    motion = kinematics.solve(REFERENCE, _GRID + TOP_DEAD_CENTRE)
    return {joint: REFERENCE.linkage.cadence * rate for joint, (_, rate) in joint_angles(motion).items()}


def source_angle(joint: str, angle: Any, rate: Any) -> Any:
    """Crank angle at which the reference TRT had `joint` at `angle` moving the same way.

    angle: rad; beyond the reference's range its nearest end is used. rate: its sign is the direction, zero
    is extension. Returns rad from top dead centre in (-pi, 2 pi].
    """
    angle = np.clip(angle, *reference_ranges()[joint])
    return _INVERSES[joint](np, _acos_array)(angle, np.where(np.asarray(rate) >= 0, 1.0, -1.0))


def joint_angles(motion: kinematics.Motion) -> dict[str, tuple[Any, Any]]:
    """Angle (rad) and rate (per unit crank speed) by joint name."""
    return {"knee": (motion.knee_angle, motion.knee_rate), "hip": (motion.hip_angle, motion.hip_rate)}


def reference_ranges() -> dict[str, tuple[float, float]]:
    """Smallest and largest joint angle of the reference TRT, rad: beyond them the map has no data.

    The knee turns round where the crank lies in line with hip and crank centre, the hip where it does with the shank.
    """
    crank, thigh, shank = REFERENCE.linkage.crank, REFERENCE.rider.thigh, float(REFERENCE.knee_to_pedal)
    frame, frame_angle = abs(REFERENCE.linkage.crank_centre), float(np.angle(REFERENCE.linkage.crank_centre))
    at_hip = frame_angle % (2 * math.pi) - REFERENCE.linkage.seat_angle
    knee = [_opposite(frame + sign * crank, thigh, shank) - float(REFERENCE.boot_angle) for sign in (-1, 1)]
    hip = [at_hip - _opposite(shank + sign * crank, thigh, frame) for sign in (1, -1)]
    return {"knee": (knee[0], knee[1]), "hip": (hip[0], hip[1])}


def _opposite(side: float, first: float, second: float) -> float:
    """Angle opposite to `side` in a triangle with the other sides `first` and `second` (law of cosines), rad."""
    return math.acos((first**2 + second**2 - side**2) / (2 * first * second))


def _acos_array(value: Any) -> Any:
    return np.acos(np.clip(value, -1.0, 1.0))


def _acos_float(value: float) -> float:
    try:
        return math.acos(value)
    except ValueError:  # a rounding error beyond an end of the range
        return 0.0 if value > 0 else math.pi


def _knee_inverse(xp: Any, acos: Any) -> Callable[[Any, Any], Any]:
    """(knee angle, direction) -> crank angle; xp is numpy for arrays or math for floats."""
    crank, thigh, shank = REFERENCE.linkage.crank, REFERENCE.rider.thigh, float(REFERENCE.knee_to_pedal)
    frame, boot_angle, cos, pi = abs(REFERENCE.linkage.crank_centre), float(REFERENCE.boot_angle), xp.cos, math.pi
    # cos(crank angle from the hip line) = level - gain cos(angle at the knee): the law of cosines, twice
    level = (thigh**2 + shank**2 - frame**2 - crank**2) / (2 * frame * crank)
    gain = thigh * shank / (frame * crank)

    def source(angle: Any, direction: Any) -> Any:
        return pi - direction * acos(level - gain * cos(angle + boot_angle))

    return source


def _hip_inverse(xp: Any, acos: Any) -> Callable[[Any, Any], Any]:
    """(hip angle, direction) -> crank angle; xp is numpy for arrays or math for floats."""
    crank, thigh, shank = REFERENCE.linkage.crank, REFERENCE.rider.thigh, float(REFERENCE.knee_to_pedal)
    frame, atan2, cos, sin, sqrt = abs(REFERENCE.linkage.crank_centre), xp.atan2, xp.cos, xp.sin, xp.sqrt
    offset = REFERENCE.linkage.seat_angle - float(np.angle(REFERENCE.linkage.crank_centre))
    excess = crank**2 - shank**2

    def source(angle: Any, direction: Any) -> Any:
        # the knee seen from the crank centre, x towards the hip; crank and shank close the triangle to it
        thigh_angle = angle + offset
        x, y = frame - thigh * cos(thigh_angle), thigh * sin(thigh_angle)
        distance2 = x * x + y * y
        return direction * acos((excess + distance2) / (2 * crank * sqrt(distance2))) - atan2(y, x)

    return source


_INVERSES = {"knee": _knee_inverse, "hip": _hip_inverse}


def load_moments(source: str | Path = "p1p2") -> JointMoments:
    """Joint moments of a rider group ("p1p2", "p1p3"; with covariance) or of a CSV file with the header COLUMNS.

    Raises InputError, naming file, line and value, for anything but at least two rows of finite numbers
    with distinct crank angles in [0, 360) deg.
    """
    if source in GROUPS:
        path = Path(__file__).parent / "data" / "moments" / f"{source}.csv"
        with np.load(path.with_suffix(".npz")) as stored:
            return replace(_read_moments(path, str(source)), covariance=stored["covariance"])
    return _read_moments(Path(source), Path(source).stem)


def _read_moments(path: Path, name: str) -> JointMoments:
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise InputError(f"{path}: cannot read the joint moments: {reason}") from None
    header = tuple(cell.strip() for cell in lines[0].split(",")) if lines else ()
    if header != COLUMNS:
        raise InputError(f"{path}: line 1 is {','.join(header)!r}, the header must be {','.join(COLUMNS)!r}")
    rows = [_read_row(path, number, row) for number, row in enumerate(csv.reader(lines[1:]), 2) if row]
    if len(rows) < 2:
        raise InputError(f"{path}: {len(rows)} row of moments; at least 2 crank angles are needed")
    rows.sort()
    data = np.array(rows).T
    repeated = np.flatnonzero(np.diff(data[0]) == 0)
    if repeated.size:
        raise InputError(f"{path}: crank_angle_deg {data[0][repeated[0]]:g} is given twice; give each angle once")
    return JointMoments(name, np.radians(data[0]), data[1], data[2])


def _read_row(path: Path, number: int, row: list[str]) -> tuple[float, ...]:
    if len(row) != len(COLUMNS):
        raise InputError(f"{path}: line {number} has {len(row)} values; {len(COLUMNS)} are needed: {','.join(COLUMNS)}")
    values = []
    for column, cell in zip(COLUMNS, row, strict=True):
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f"{path}: line {number}: {column} is {cell.strip()!r}; it must be a finite number")
        values.append(value)
        if column != COLUMNS[0] and abs(value) > LARGEST_MOMENT:
            raise InputError(
                f"{path}: line {number}: {column} is {cell.strip()}; "
                f"it must be between -{LARGEST_MOMENT:g} and {LARGEST_MOMENT:g} N m"
            )
    if not 0 <= values[0] < 360:
        raise InputError(
            f"{path}: line {number}: crank_angle_deg is {values[0]:g}; it must be at least 0 and below 360"
        )
    return tuple(values)

"""Recorded angles of knee and hip beside what is declared: how they are counted, and on which tricycle they were."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.comparison import Comparison
from fes_mj.moments.conventions import LARGEST_TILT, Convention
from fes_mj.moments.fourier import fit_fourier, fourier
from fes_mj.moments.measured_turns import CountedAngle
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.turn import Turn

ANGLE_ERROR = 5.0  # deg: of joint angles by markers (McGinley et al. 2009, doi:10.1016/j.gaitpost.2008.09.003)
_ZERO_ERROR = 10.0  # deg of crank angle: moments that far off lose 2 % of their power
_TURN = np.radians(np.arange(360.0))
_ADVICE = (
    "was it on this tricycle, with this rider? Measure R1, R2, seat and legs again, or `fes_mj moments FILE --identify`"
)


def counting(joint: str, counted: CountedAngle, convention: Convention) -> Iterator[Comparison]:
    """How a joint's angle is counted, and in which unit."""
    sign = convention.angle[joint]
    declared = {1.0: "declared extension positive", -1.0: "declared flexion positive"}.get(sign, "not declared")
    sense, (low, high) = counted.sense, counted.ends
    recorded = f"{low:.0f} to {high:.0f} deg, {sense.words}"
    usual = joint == "hip" or sense.sign > 0 or convention.moment[joint] != 0
    yield Comparison(
        f"{joint}_sense", f"{joint} angle counts", recorded, declared, sign == sense.sign or (not sign and usual),
        f"a {joint} has such angles in this sense only; say so by moments.convention (rajagopal and winter count knee "
        "flexion positive, gait2392 extension; they differ in the signs of the moments, too)",
    )  # fmt: skip
    if counted.header_unit:
        yield Comparison(
            f"{joint}_unit", f"{joint} angle, unit", counted.unit, f"header {counted.header_unit}",
            counted.unit == counted.header_unit, "the header is wrong (inDegrees), the values count",
        )  # fmt: skip


def recorded_curve(turns: Sequence[Turn], joint: str) -> FloatArray | None:
    """The smooth curve of a joint's recorded angle, deg, at every degree from top dead centre; None if it has none."""
    parts = [
        (turn.pose, turn.joint_angle[joint]) for turn in turns if turn.pose is not None and joint in turn.joint_angle
    ]
    if not parts:
        return None
    angle, value = (np.concatenate(column) for column in zip(*parts, strict=True))
    return np.asarray(np.degrees(fourier(_TURN) @ fit_fourier(angle, value[:, None])[:, 0]))


def curves(turns: Sequence[Turn], tricycle: ReferenceTricycle, crank_recorded: bool) -> Iterator[Comparison]:
    """The recorded joint angles over the crank angle beside those of the tricycle."""
    pose = solve(tricycle.design, _TURN + tricycle.top_dead_centre).joint_angle
    for joint in JOINTS:
        recorded, modelled = recorded_curve(turns, joint), np.degrees(pose[joint])
        if recorded is not None:
            yield from _curve(joint, recorded, modelled, crank_recorded)


def _curve(joint: str, recorded: FloatArray, modelled: FloatArray, crank_recorded: bool) -> Iterator[Comparison]:
    """Range, offset, shape and place of a joint's recorded curve; both in deg, at _TURN."""
    # of pelvis and trunk; nobody's knee is tilted
    tilt = float(np.mean(recorded - modelled)) if joint == "hip" else 0.0
    ends = [(float(curve.min()), float(curve.max())) for curve in (recorded, modelled)]
    words = [f"{low:.0f} to {high:.0f} deg" for low, high in ends]
    away = max(abs(one - tilt - other) for one, other in zip(*ends, strict=True))
    yield Comparison(
        f"{joint}_range", f"{joint} angle", words[0], f"{words[1]} on the tricycle", away <= ANGLE_ERROR, _ADVICE
    )
    if joint == "hip":
        most = math.degrees(LARGEST_TILT)
        yield Comparison(
            "hip_offset", "hip angle's offset", f"{tilt:+.0f} deg", f"a pelvis tilts up to {most:.0f}",
            abs(tilt) <= most, "are seat_angle and the direction of R1 right?",
        )  # fmt: skip
    if joint == "hip" or crank_recorded:
        shape = float(np.sqrt(np.mean((recorded - tilt - modelled) ** 2)))
        yield Comparison(
            f"{joint}_curve", f"{joint} angle over the turn", f"{shape:.1f} deg from that of the tricycle (rms)",
            f"up to {ANGLE_ERROR:g} expected", shape <= ANGLE_ERROR, _ADVICE,
        )  # fmt: skip
    if joint == "knee" and crank_recorded:
        bent = math.degrees(np.angle(np.exp(1j * (_phase(recorded) - _phase(modelled)))))
        yield Comparison(
            "zero", "knee bent most", f"{bent:+.0f} deg after top dead centre", "declared at 0",
            abs(bent) <= _ZERO_ERROR, "are zero, leg and turning of the crank angle as declared?",
        )  # fmt: skip


def _phase(curve: FloatArray) -> float:
    """Phase of the first harmonic of a curve at _TURN, rad: later curves have larger ones."""
    return float(np.angle(curve @ np.exp(1j * _TURN)))

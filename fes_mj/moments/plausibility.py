"""What a trial says of itself beside what is declared or assumed, a row each; those that contradict are warnings."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.comparison import Comparison
from fes_mj.moments.conventions import Convention
from fes_mj.moments.fourier import WIDEST_GAP, gaps
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.measured_turns import CountedAngle, Recording
from fes_mj.moments.recorded_angles import counting, curves
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.turn import Turn

LEAST_MOMENT = 2.0  # N m: a smaller largest one looks like N m/kg
STRONG_LEG = 500.0  # N m: a larger one looks like N mm
_CADENCE_ERROR = 0.05
_UNEVEN = 0.3  # a turn so much longer or shorter than the middle one is a start, a pause or a stop
_SETBACK = 10.0  # deg that a pedalling crank may go back
_CONTRADICTION = 0.4  # of the curves' size: scatter that no rider shows from turn to turn
_OPEN = 0.25  # of a moment's range, between the last sample of a turn and its first


def comparisons(recording: Recording, moments: JointMoments, spikes: int) -> list[Comparison]:
    """All that can be compared, in the order of reading.

    moments: those that were made of the recording. spikes: samples that were left out.
    """
    turns, convention, declared = recording.turns, recording.convention, recording.measured_on
    return [
        *_crank_unit(recording),
        *(row for joint, counted in recording.angles.items() for row in counting(joint, counted, convention)),
        *curves(turns, declared, recording.crank_angle is not None),
        *_time(turns, declared, recording.cadence_known),
        Comparison(
            "spikes", "samples left out", f"{spikes}", "none expected", not spikes, "spikes, alone among others"
        ),
        *_moments(turns, moments),
        *_powers(moments, convention, recording.angles),
    ]


def _crank_unit(recording: Recording) -> Iterator[Comparison]:
    angle, unit = recording.crank_angle, recording.angle_unit
    if angle is None or not len(angle):
        return
    largest = float(np.abs(angle).max())
    step = float(np.abs(np.diff(angle)).max(initial=0.0))
    quantity, recorded, declared = "crank angle", f"up to {largest:.4g}", f"unit {unit}"
    if unit == "deg":
        yield Comparison("radians", quantity, recorded, declared, largest >= 2 * math.pi, "is it in radians, or turns?")
    elif unit == "rad":
        degrees = largest > 60 * math.pi and step > math.pi
        yield Comparison("degrees", quantity, recorded, declared, not degrees, "is it in degrees?")


def recorded_cadence(turns: Sequence[Turn]) -> float | None:
    """Mean crank speed by the times of the turns, rad/s."""
    durations = [turn.duration for turn in turns if turn.duration]
    return 2 * math.pi / float(np.mean(durations)) if durations else None


def cadence_agrees(turns: Sequence[Turn], declared: float) -> bool:
    """Whether a cadence, rad/s, is among the crank speeds of the turns, but for what a rider varies."""
    mean = recorded_cadence(turns) or declared
    slow, fast = crank_speeds(turns)
    return slow * (1 - _CADENCE_ERROR) <= declared / mean <= fast * (1 + _CADENCE_ERROR)


def crank_speeds(turns: Sequence[Turn]) -> tuple[float, float]:
    """Smallest and largest crank speed within the turns, per the mean, where the knee tells it; otherwise 1."""
    speeds = [turn.crank_speed for turn in turns if turn.crank_speed] or [(1.0, 1.0)]
    return min(slow for slow, _ in speeds), max(fast for _, fast in speeds)


def _time(turns: Sequence[Turn], declared: ReferenceTricycle, cadence_said: bool) -> Iterator[Comparison]:
    """Cadence, and how evenly the crank turned."""
    cadence = recorded_cadence(turns)
    if cadence is None:
        return
    words = f"declared {declared.cadence / RPM:.1f}" if cadence_said else "not declared"
    agrees = not cadence_said or cadence_agrees(turns, declared.cadence)
    advice = "the recorded one is used; is the time in s?"
    yield Comparison("cadence", "cadence", f"{cadence / RPM:.1f} rpm", words, agrees, advice)
    durations = np.array([turn.duration for turn in turns if turn.duration])
    middle = float(np.median(durations))
    yield Comparison(
        "uneven_turns", "turns last", f"{durations.min():.2f} to {durations.max():.2f} s", f"half of them {middle:.2f}",
        bool(np.all(np.abs(durations / middle - 1) <= _UNEVEN)),
        "a start from rest, a pause or a stop: cut it out, moments at standstill are not those of pedalling; where "
        "samples are missing make two trials of one (moments.file may be a list)",
    )  # fmt: skip
    if any(turn.crank_speed for turn in turns):
        slow, fast = crank_speeds(turns)
        speeds = f"{slow * cadence / RPM:.0f} to {fast * cadence / RPM:.0f} rpm"
        yield Comparison("crank_speed", "crank speed within the turn", speeds, "followed by the knee", True)
    back = max(_setback(turn.crank_angle if turn.pose is None else turn.pose) for turn in turns)
    yield Comparison(
        "goes_back", "crank goes back by", f"{back:.0f} deg", f"up to {_SETBACK:g} expected", back <= _SETBACK,
        "a turn that goes back is none, nor is one with a stretch of time missing: cut it out",
    )  # fmt: skip


def _setback(angle: FloatArray) -> float:
    """How far a crank angle, rad, falls behind what it had reached, deg."""
    turned = np.unwrap(angle)
    return float(np.degrees(np.max(np.maximum.accumulate(turned) - turned)))


def _moments(turns: Sequence[Turn], moments: JointMoments) -> Iterator[Comparison]:
    """Size, gaps, scatter and ends of the moments themselves."""
    largest = max(float(np.abs([turn.knee, turn.hip]).max()) for turn in turns)
    quantity, words = "largest moment", f"{largest:.3g} N m"
    small, large = f"at least {LEAST_MOMENT:g} expected", f"at most {STRONG_LEG:g} expected"
    yield Comparison("per_kg", quantity, words, small, largest >= LEAST_MOMENT, "is the unit N m/kg?")
    yield Comparison("per_mm", quantity, words, large, largest <= STRONG_LEG, "is the unit N mm?")
    gap = math.degrees(largest_gap(turns))
    yield Comparison(
        "gap", "largest gap", f"{gap:.0f} deg", f"at most {math.degrees(WIDEST_GAP):.0f} expected",
        gap <= math.degrees(WIDEST_GAP), "no sample is in this part of the turn; a straight line is drawn across",
    )  # fmt: skip
    away, size = [], []
    for turn in turns:
        curves = moments.at(turn.crank_angle)
        away += [turn.knee - curves.knee, turn.hip - curves.hip]
        size += [*curves]
    scatter = float(np.sqrt(np.mean(np.concatenate(away) ** 2) / max(np.mean(np.concatenate(size) ** 2), 1e-300)))
    yield Comparison(
        "contradiction", "scatter about the curves", f"{100 * scatter:.0f} % of their size",
        f"at most {100 * _CONTRADICTION:.0f} expected", scatter <= _CONTRADICTION,
        "samples at one crank angle contradict each other: two riders, legs or trials in one file? Columns `rider` and "
        "`trial` tell them apart",
    )  # fmt: skip
    opening = max(_opening(turns, joint) for joint in JOINTS)
    yield Comparison(
        "open_turn", "moment from the turn's end to its start", f"jumps by {100 * opening:.0f} % of its range",
        f"at most {100 * _OPEN:.0f} expected", opening <= _OPEN, "is it a whole turn of steady pedalling?",
    )  # fmt: skip


def _opening(turns: Sequence[Turn], joint: str) -> float:
    """Jump of a moment across a turn's end, mean of the turns, per its range; 0 if one elsewhere is as large."""
    jumps, others, ranges = [], [], []
    for turn in turns:
        order = np.argsort(np.mod(turn.crank_angle, 2 * np.pi), kind="stable")
        value = getattr(turn, joint)[order]
        jumps.append(value[0] - value[-1])
        others.append(np.abs(np.diff(value)).max(initial=0.0))
        ranges.append(np.ptp(value))
    jump = abs(float(np.mean(jumps)))
    return jump / max(float(np.mean(ranges)), 1e-300) if jump > 2 * np.mean(others) else 0.0


def _powers(moments: JointMoments, convention: Convention, angles: dict[str, CountedAngle]) -> Iterator[Comparison]:
    """Who drives: the sum, and each joint."""
    power = moments.power_mean
    signs = "are signs, zero and sense of the crank angle as declared?"
    if "knee" in angles and angles["knee"].sense.sign < 0 and convention.moment.knee >= 0:
        signs = "the knee's angle counts flexion positive: does its moment, too (convention rajagopal)?"
    yield Comparison(
        "negative_power", "mean power", f"{sum(power):.2f} W", "a rider drives", sum(power) >= 0,
        f"these moments brake; {signs}",
    )  # fmt: skip
    yield Comparison(
        "exchanged", "power of the knee", f"{power.knee:.2f} W", "a rider's knee drives",
        power.knee >= 0, f"are extension and flexion exchanged? {signs}",
    )  # fmt: skip
    yield Comparison(
        "hip_sign", "power of the hip", f"{power.hip:.2f} W",
        "sign declared" if convention.moment.hip else "sign not declared",
        bool(convention.moment.hip) or power.hip >= 0,
        "the hip brakes if its moment counts extension positive; say by moments.convention or moments.extension how it "
        "is counted (OpenSim's hip_flexion: flexion)",
    )  # fmt: skip


def largest_gap(turns: Sequence[Turn]) -> float:
    """Widest part of a turn without a sample, rad."""
    return max(float(gaps(turn.crank_angle)[1].max()) for turn in turns)

"""The turns that the files of a measurement hold, read as its measurement file says, and what looks misread in them."""

import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import TextTable
from fes_mj.linkage.inertia import leg_moments
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.fourier import WIDEST_GAP, gaps
from fes_mj.moments.joint_moments import JointMoments, Misreading
from fes_mj.moments.measurement_file import Description
from fes_mj.moments.trial import WHAT, Turn, bounded, by_crank, by_knee, is_trial, load_table, says_radians, times

LEAST_MOMENT = 2.0  # N m: a smaller largest one looks like N m/kg


def measured_turns(description: Description) -> tuple[list[Turn], list[Misreading]]:
    """Every turn that the files of a measurement hold, and what looks wrong in their crank angles.

    Raises InputError naming file, line or key, value and what is allowed.
    """
    turns: list[Turn] = []
    misreadings: dict[str, Misreading] = {}
    for number, path in enumerate(description.data):
        if description.kinematics:
            turns += _by_knee(description, path, description.kinematics[number])
        else:
            of_file, odd = _by_crank(description, path)
            turns += of_file
            misreadings |= {misreading.name: misreading for misreading in odd}
    return turns, [*misreadings.values()]


def _by_crank(description: Description, path: Path) -> tuple[list[Turn], list[Misreading]]:
    """Turns of a file with a crank angle: of a trial over time each, of other rows one."""
    table, crank = load_table(path, WHAT), description.columns["crank"]
    trial = is_trial(table)
    given, unit = bounded(table, crank, angle=True), _angle_unit(description, table)
    angle = description.sense * (np.radians(given) if unit == "deg" else given)
    if trial:
        times(table)
    values = _values(description, table)
    rows = by_crank(path, crank, angle) if trial else [np.arange(len(angle))]
    return [_turn(description, angle[row] + description.zero, values[:, row]) for row in rows], odd_angles(given, unit)


def _by_knee(description: Description, path: Path, kinematics: Path) -> list[Turn]:
    """Turns of a trial, from one dead centre of the knee to the next, between which the crank turns evenly."""
    column = description.knee_angle
    motion, table = load_table(kinematics, "kinematics"), load_table(path, WHAT)
    tops = by_knee(kinematics, column, times(motion), description.sign.knee * motion.column(column))
    time, values = times(table), _values(description, table)
    if time[0] > tops[-1] or time[-1] < tops[0]:
        raise InputError(
            f"{path}: column time goes from {time[0]:g} to {time[-1]:g} s, whole turns of {kinematics} from "
            f"{tops[0]:.4g} to {tops[-1]:.4g} s; moments.file and moments.kinematics must be of one trial"
        )
    turns = []
    for start, end in pairwise(tops):
        row = (start <= time) & (time < end)
        if time[0] <= start and end <= time[-1]:
            turns.append(_turn(description, 2 * np.pi * (time[row] - start) / (end - start), values[:, row]))
    if not turns:
        raise InputError(f"{path}: no whole turn of {kinematics} lies within {time[0]:g} to {time[-1]:g} s")
    return turns


def _values(description: Description, table: TextTable) -> FloatArray:
    """Knee and hip moment, N m, extension positive, or the two components of the pedal force, N; shape (2, n)."""
    columns = description.pedal_force or [description.columns[joint] for joint in JOINTS]
    values = np.stack([bounded(table, column) for column in columns])
    return values if description.pedal_force else description.scale * np.array([*description.sign])[:, None] * values


def _turn(description: Description, angle: FloatArray, values: FloatArray) -> Turn:
    """A turn at crank angles from top dead centre, rad; of pedal forces by inverse dynamics."""
    if not description.pedal_force:
        return Turn(angle, *values)
    motion = solve(description.measured_on.design, angle + description.measured_on.top_dead_centre)
    return Turn(angle, *leg_moments(motion, description.measured_on.cadence, values[0] + 1j * values[1]))


def _angle_unit(description: Description, table: TextTable) -> str:
    """Unit of the crank angle: as declared, otherwise as the header of an OpenSim file says, otherwise deg."""
    header = says_radians(table)
    said = {None: "deg", True: "rad", False: "deg"}[header]
    unit = description.section.choice("angle_unit", ("deg", "rad"), said)
    if header is not None and unit != said:
        raise InputError(
            f"{table.path}: the header says that angles are in {said}, moments.angle_unit of "
            f"{description.section.path} says {unit}; correct one of them"
        )
    return unit


def odd_angles(angle: FloatArray, unit: str) -> list[Misreading]:
    """Whether the unit of crank angles looks wrong."""
    largest = float(np.abs(angle).max(initial=0.0))
    if unit == "deg" and largest < 2 * math.pi:
        return [Misreading("radians", f"all crank angles are below {largest:.3g} deg; are they in radians?")]
    if unit == "rad" and largest > 60 * math.pi and np.abs(np.diff(angle)).max() > math.pi:
        return [Misreading("degrees", f"crank angles go up to {largest:.4g} rad; are they in degrees?")]
    return []


def odd_moments(turns: Sequence[Turn], moments: JointMoments) -> list[Misreading]:
    """What looks wrong in the moments themselves."""
    largest = max(float(np.abs([turn.knee, turn.hip]).max()) for turn in turns)
    gap, power = largest_gap(turns), moments.power_mean
    oddities = {
        "per_kg": (largest < LEAST_MOMENT, f"the largest moment is {largest:.3g} N m; is the unit N m/kg?"),
        "gap": (
            gap > WIDEST_GAP,
            f"there is no sample in {np.degrees(gap):.0f} deg of the turn; a straight line is drawn across",
        ),
        "negative_power": (
            sum(power) < 0,
            f"the mean power in the tricycle of the measurement is {sum(power):.2f} W: these moments brake; "
            "are signs, zero or sense of the crank angle as declared?",
        ),
        "exchanged": (
            power.knee < 0 < power.hip - power.knee,
            f"the knee takes {-power.knee:.2f} W from the crank; "
            "are extension and flexion exchanged? Extension is positive",
        ),
    }
    return [Misreading(name, text) for name, (odd, text) in oddities.items() if odd]


def largest_gap(turns: Sequence[Turn]) -> float:
    """Widest part of a turn without a sample, rad."""
    return max(float(gaps(turn.crank_angle)[1].max()) for turn in turns)

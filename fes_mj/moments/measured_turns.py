"""The turns that the files of a measurement hold, read as its measurement file says."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.linkage.inertia import leg_moments
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.conventions import AngleSense, Convention, angle_sense
from fes_mj.moments.crank_angle import TimedTurn, timed_turns
from fes_mj.moments.measurement_file import ANGLE_UNITS, Description
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.tables import OPENSIM, TextTable, load_table
from fes_mj.moments.trial import by_crank, in_order, timed_rows
from fes_mj.moments.turn import Turn

WHAT = "joint moments"
LARGEST_MOMENT = 1e4  # N m, ten times what a strong leg can do; beyond it the unit is another one
LARGEST_ANGLE = 1e7  # in its unit, more than a day of pedalling
_LARGEST_RADIANS = 1.1 * math.pi  # joint angles that all lie below are no degrees: a pedalling knee bends further
_LEAST_ROWS = 4  # of a turn over time


@dataclass(frozen=True, eq=False)
class CountedAngle:
    """How a joint's angle is counted in a file: sense, ends (deg), unit, and the unit that the header says, if any."""

    sense: AngleSense
    ends: tuple[float, float]
    unit: str
    header_unit: str | None


@dataclass(eq=False)
class Recording:
    """All that the files of a measurement hold, and what is declared of them.

    convention: signs of extension. measured_on: the tricycle, its cadence declared (cadence_known) or assumed.
    crank_angle: as it stands in the first file, in `angle_unit`; None where the knee tells it. angles: how they are
    counted, of the joints whose angle is recorded.
    """

    convention: Convention
    measured_on: ReferenceTricycle
    cadence_known: bool
    turns: list[Turn] = field(default_factory=list)
    crank_angle: FloatArray | None = None
    angle_unit: str = "deg"
    angles: dict[str, CountedAngle] = field(default_factory=dict)


def measured_turns(description: Description) -> Recording:
    """Every turn that the files of a measurement hold.

    Raises InputError naming file, line or key, value and what is allowed.
    """
    recording = Recording(description.convention, description.measured_on, description.cadence_known)
    for number, path in enumerate(description.data):
        for source, table in _trials(description, number, path):
            if description.kinematics:
                recording.turns += _by_knee(description, recording, table, description.kinematics[number], source)
            else:
                recording.turns += _by_crank(description, recording, table, source)
    return recording


def _trials(description: Description, number: int, path: Path) -> Iterator[tuple[tuple[str, str], TextTable]]:
    """The trials of a file, each with the name of its rider and its own."""
    columns = description.columns
    table = load_table(path, WHAT, (*columns.values(), *description.pedal_force))
    rider, trial = (columns[key] and table.cells(columns[key]) for key in ("rider", "trial"))
    sources = [
        (description.riders[number] if description.riders else rider[row] if rider else "", trial[row] if trial else "")
        for row in range(len(table.rows))
    ]
    for source in dict.fromkeys(sources):
        rows = [row for row, other in enumerate(sources) if other == source]
        yield (source[0], f"{number} {source[1]}"), table.taken(rows)
    if not sources:
        yield ("", str(number)), table


def _by_crank(description: Description, recording: Recording, table: TextTable, source: tuple[str, str]) -> list[Turn]:
    """Turns of a table with a crank angle: of a trial over time each, of other rows one or as many as they show."""
    crank, unit = description.columns["crank"], _angle_unit(description, table)
    used = _value_columns(description)
    timed = table.path.suffix.lower() in OPENSIM or description.columns["time"] or table.time_column
    if timed:  # a series over time
        table, time = timed_rows(table, description.columns["time"], description.time_unit, (crank, *used))
    readings = bounded(table, crank, LARGEST_ANGLE)
    angle = description.sense * ANGLE_UNITS[unit] * readings
    if recording.crank_angle is None:
        recording.crank_angle, recording.angle_unit = readings, unit
    values = _values(description, table)
    joint_angle = _joint_angles(description, recording, table)
    after = angle + description.zero
    turns = []
    for row in by_crank(table, crank, angle) if timed else in_order(angle):
        # the last sample lacks a step to a whole turn, in time as in angle
        ends = row[[0, -1]]
        duration = 2 * math.pi * float(np.ptp(time[ends]) / np.ptp(np.unwrap(after[row])[[0, -1]])) if timed else None
        angles = {joint: values[row] for joint, values in joint_angle.items()}
        moments = _moments(description, after[row], values[:, row], duration)
        moved = after[row] if angles else None
        turns.append(Turn(after[row], moments.knee, moments.hip, moved, angles, duration, None, source))
    return turns


def _by_knee(
    description: Description, recording: Recording, table: TextTable, kinematics: Path, source: tuple[str, str]
) -> list[Turn]:
    """Turns of a trial, from one dead centre of the knee to the next, at the crank angles that the knee tells."""
    column = description.columns["knee_angle"]
    motion = load_table(kinematics, "kinematics", (column,))
    motion, moved = timed_rows(motion, description.columns["time"], description.time_unit, (column,))
    joint_angle = _joint_angles(description, recording, motion)
    timed = timed_turns(moved, joint_angle["knee"], description.measured_on)
    if not timed:
        raise InputError(
            f"{kinematics}: {column} is at its most bent fewer than 2 times; a whole turn lies between two such dead "
            "centres"
        )
    table, time = timed_rows(table, description.columns["time"], description.time_unit, _value_columns(description))
    values = _values(description, table)
    if time[0] > timed[-1].end or time[-1] < timed[0].start:
        raise InputError(
            f"{table.path}: column time goes from {time[0]:g} to {time[-1]:g} s, whole turns of {kinematics} from "
            f"{timed[0].start:.4g} to {timed[-1].end:.4g} s; moments.file and moments.kinematics must be of one trial, "
            "in the same unit of time"
        )
    turns = []
    for turn in timed:
        if time[0] <= turn.start and turn.end <= time[-1]:
            row, pose = np.flatnonzero(turn.holds(time)), turn.holds(moved)
            _require_rows(table, len(row), turn, time, moved, kinematics)
            angle, angles = turn.crank_angle(time[row]), {joint: phi[pose] for joint, phi in joint_angle.items()}
            moments = _moments(description, angle, values[:, row], turn.end - turn.start)
            at, duration = turn.crank_angle(moved[pose]), turn.end - turn.start
            turns.append(Turn(angle, moments.knee, moments.hip, at, angles, duration, turn.speed, source))
    if not turns:
        raise InputError(f"{table.path}: no whole turn of {kinematics} lies within {time[0]:g} to {time[-1]:g} s")
    return turns


def _require_rows(
    table: TextTable, count: int, turn: TimedTurn, time: FloatArray, moved: FloatArray, kinematics: Path
) -> None:
    """Refuse moments that are too far apart for the turns of their kinematics."""
    if count < _LEAST_ROWS:
        raise InputError(
            f"{table.path}: {count} rows lie within the turn from {turn.start:.4g} to {turn.end:.4g} s of "
            f"{kinematics}; the times here are {np.median(np.diff(time)):g} s apart, those there "
            f"{np.median(np.diff(moved)):g} s: is one of them in ms? Both must be in the same unit of time"
        )


def bounded(table: TextTable, column: str, limit: float, scale: float = 1.0) -> FloatArray:
    """A column of moments or crank angles times `scale`; refused unless a leg or a crank can have every value."""
    values = scale * table.column(column)
    wrong = np.flatnonzero(np.abs(values) > limit)
    if wrong.size:
        row = int(wrong[0])
        raise InputError(
            f"{table.path}: line {table.lines[row]}: {column} is {values[row] / scale:g}"
            + (f", {values[row]:g} N m in the unit that is declared" if scale != 1 else "")
            + f"; it must be from -{limit:g} to {limit:g}"
            + (" N m: is moments.unit N mm or N mm/kg?" if limit == LARGEST_MOMENT else "")
        )
    return values


def _value_columns(description: Description) -> list[str]:
    return description.pedal_force or [description.columns[joint] for joint in JOINTS]


def _values(description: Description, table: TextTable) -> FloatArray:
    """Knee and hip moment, N m, extension positive, or the two components of the pedal force, N; shape (2, n)."""
    scale = 1.0 if description.pedal_force else description.scale
    values = np.stack([bounded(table, column, LARGEST_MOMENT, scale) for column in _value_columns(description)])
    sign = description.convention.moment.map(lambda declared: declared or 1.0)
    return values if description.pedal_force else np.array([*sign])[:, None] * values


def _moments(
    description: Description, angle: FloatArray, values: FloatArray, duration: float | None
) -> PerJoint[FloatArray]:
    """Moments at crank angles from top dead centre, rad; of pedal forces by inverse dynamics at the turn's cadence."""
    if not description.pedal_force:
        return PerJoint(*values)
    measured_on = description.measured_on
    motion = solve(measured_on.design, angle + measured_on.top_dead_centre)
    cadence = 2 * math.pi / duration if duration else measured_on.cadence
    return leg_moments(motion, cadence, values[0] + 1j * values[1])


def _joint_angles(description: Description, recording: Recording, table: TextTable) -> dict[str, FloatArray]:
    """The joint angles that a table has, rad, growing in extension, by joint; how they are counted goes on record."""
    angles = {}
    for joint in JOINTS:
        key = f"{joint}_angle"
        column = description.columns[key]
        asked = key in description.section.content or (joint == "knee" and bool(description.kinematics))
        if asked or column in table.header:
            readings = table.column(column)
            unit = "rad" if np.abs(readings).max(initial=0.0) < _LARGEST_RADIANS else "deg"
            radians = ANGLE_UNITS[unit] * readings
            if joint not in recording.angles:
                sense = angle_sense(joint, radians, description.convention.angle[joint], description.measured_on)
                low, high = np.degrees([radians.min(), radians.max()])
                recording.angles[joint] = CountedAngle(sense, (low, high), unit, table.angle_unit)
            angles[joint] = recording.angles[joint].sense.extending(radians)
    return angles


def _angle_unit(description: Description, table: TextTable) -> str:
    """Unit of the crank angle: as declared, otherwise as the header of an OpenSim file says, otherwise deg."""
    header_unit = table.angle_unit or "deg"
    unit = description.section.choice("angle_unit", ANGLE_UNITS, header_unit)
    if table.angle_unit and unit != header_unit:
        raise InputError(
            f"{table.path}: the header says that angles are in {header_unit}, moments.angle_unit of "
            f"{description.section.path} says {unit}; correct one of them"
        )
    return unit

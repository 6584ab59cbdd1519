"""Trials cut into turns of the crank: over time, or row by row."""

import math
from collections.abc import Collection

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.moments.tables import TextTable

TIME_UNITS = {"s": 1.0, "ms": 1e-3}  # s
_SAME = 0.01  # of a column's range: values at one time that differ by less are one sample printed twice


def timed_rows(table: TextTable, column: str, unit: str, columns: Collection[str]) -> tuple[TextTable, FloatArray]:
    """The rows of a trial and their times, s; a row printed twice, as OpenSim does, counts once.

    column, unit: of the times, "" for what the header says. columns: those that are used, by which rows are the same.
    Raises InputError unless time grows.
    """
    path, name = table.path, column or table.time_column or "time"
    time = table.column(name)
    if len(time) < 2:
        raise InputError(f"{path}: {len(time)} row; a trial is a series over time")
    stuck = np.diff(time, prepend=-np.inf) <= 0
    again = np.diff(time, prepend=np.nan) == 0
    for values in (table.column(used) for used in columns):
        again &= np.abs(np.diff(values, prepend=np.nan)) <= _SAME * np.ptp(values)
    wrong = np.flatnonzero(stuck & ~again)
    if wrong.size:
        row = int(wrong[0])
        raise InputError(
            f"{path}: line {table.lines[row]}: {name} is {time[row]:g} after {time[row - 1]:g} s; it must grow"
        )
    kept = np.flatnonzero(~again)
    return (table.taken(kept.tolist()) if again.any() else table), TIME_UNITS[unit or table.time_unit] * time[kept]


def by_crank(table: TextTable, column: str, angle: FloatArray) -> list[IntArray]:
    """Rows of each whole turn, by a crank angle in rad that counts in the sense of pedalling, wrapped or not.

    Turns are counted from the first row. Raises InputError for fewer than one, with the likely cause.
    """
    turned = np.unwrap(angle)
    turned = turned - turned[0]
    turns = _whole(turned)
    cause = likely_cause(table.column(column)) if turns < 1 and _whole(-turned) < 1 else ""
    if cause:
        raise InputError(f"{table.path}: {column} does not go through a whole turn; {cause}")
    if turned[-1] < 0:
        raise InputError(
            f"{table.path}: {column} counts against the sense of pedalling while time grows; "
            'moments.turning must be the other of "forward" and "backward"'
        )
    if turns < 1:
        raise InputError(
            f"{table.path}: {column} goes through {np.degrees(turned[-1]):.0f} deg; a whole turn is needed"
        )
    number = np.floor(turned / (2 * np.pi))
    return [np.flatnonzero(number == turn) for turn in range(turns)]


def in_order(angle: FloatArray) -> list[IntArray]:
    """Rows of each turn where no time is recorded: several turns if every angle stands as often, or if they go round.

    Otherwise all rows are one turn, in any order.
    """
    inside = np.round(np.mod(angle, 2 * np.pi), 6)
    _, place, count = np.unique(inside, return_inverse=True, return_counts=True)
    if len(count) > 1 and count[0] > 1 and (count == count[0]).all():
        ordered = np.argsort(place, kind="stable").reshape(-1, count[0])  # angles, their rows as they come
        return [np.sort(rows) for rows in ordered.T]
    turned = np.unwrap(angle)
    turned = (turned - turned[:1]) * np.sign(turned[-1:] - turned[:1])
    turns = _whole(turned)
    if turns < 2 or np.diff(turned).min() < 0:
        return [np.arange(len(angle))]
    number = np.floor(turned / (2 * np.pi))
    return [np.flatnonzero(number == turn) for turn in range(turns)]


def _whole(turned: FloatArray) -> int:
    """Whole turns of an angle from zero, rad; the step from the last sample closes one."""
    if len(turned) < 2:
        return 0
    steps = np.sort(np.diff(turned))
    middle = steps[len(steps) // 2]  # np.median imports masked arrays, for a fifteenth of a start
    return int((turned[-1] + middle) / (2 * np.pi) + 1e-6)


def likely_cause(values: FloatArray) -> str:
    """Why numbers that are declared as a crank angle in degrees go through no whole turn; "" if nothing is known."""
    low, high, steps = float(values.min()), float(values.max()), np.diff(values)
    back = np.sort(-steps[steps < 0])
    fall = float(back[len(back) // 2]) if len(back) else 0.0
    causes = (
        ({*values.tolist()} <= {0.0, 1.0}, "it is 0 and 1 only: an index pulse? Name the column of the angle"),
        (max(-low, high) <= 1, 'all are within 1: whole turns? angle_unit = "turn"'),
        (max(-low, high) < 2 * math.pi + 0.01, f'all are below {high:.3g}: radians? angle_unit = "rad"'),
        (80 < fall <= 100, f'it falls back from {high:.3g}: per cent of the turn? angle_unit = "percent"'),
        (
            160 < fall < 200,
            f"it falls back by {fall:.0f} deg: two turns of the signal a turn of the crank? Double and unwrap it first",
        ),
        (
            fall > 0 and high - low > 300,
            f"it goes back from {high:.0f} to {low:.0f} through values between: was it filtered after it was wrapped? "
            "Unwrap it before filtering",
        ),
    )
    return next((advice for looks, advice in causes if looks), "")

"""Trials over time: OpenSim's .sto and .mot files and CSV files with a time column, cut into turns of the crank."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import TextTable, read_table

WHAT = "joint moments"
OPENSIM = (".sto", ".mot")
LARGEST_MOMENT = 1e4  # N m, ten times what a strong leg can do; beyond it the unit is another one
LARGEST_ANGLE = 1e7  # deg or rad, more than a day of pedalling
_NEAR_TOP = 2 * np.pi / 9  # on either side of a dead centre the knee's angle is taken for a cubic
_REAL = 1e-12  # s
_LEAST_SWING = 0.5  # of the knee's whole range: smaller dips are noise


class Turn(NamedTuple):
    """One turn: crank angle in rad from top dead centre, knee and hip moment in N m, shape (n,) each."""

    crank_angle: FloatArray
    knee: FloatArray
    hip: FloatArray


def load_table(path: Path, what: str) -> TextTable:
    """A CSV or an OpenSim file. Raises InputError as inputs.read_table."""
    opensim = path.suffix.lower() in OPENSIM
    return read_table(path, what, after="endheader" if opensim else "", commas=not opensim)


def is_trial(table: TextTable) -> bool:
    """Whether a table is a series over time."""
    return table.path.suffix.lower() in OPENSIM or "time" in table.header


def bounded(table: TextTable, column: str, angle: bool = False) -> FloatArray:
    """A column of moments (N m or N m/kg) or crank angles, every value of which a leg or a crank can have."""
    limit, values = LARGEST_ANGLE if angle else LARGEST_MOMENT, table.column(column)
    for line, value in zip(table.lines, values.tolist(), strict=True):
        if abs(value) > limit:
            raise InputError(
                f"{table.path}: line {line}: {column} is {value:g}; it must be from -{limit:g} to {limit:g}"
            )
    return values


def says_radians(table: TextTable) -> bool | None:
    """Whether an OpenSim header says that angles are in radians; None if it does not say."""
    declared = re.search(r"^\s*inDegrees\s*=\s*(yes|no)\s*$", table.preamble, re.IGNORECASE | re.MULTILINE)
    return declared.group(1).lower() == "no" if declared else None


def times(table: TextTable) -> FloatArray:
    """The column "time", s, shape (n,). Raises InputError unless it grows."""
    path, time = table.path, table.column("time")
    if len(time) < 2:
        raise InputError(f"{path}: {len(time)} row; a trial is a series over time")
    stuck = np.flatnonzero(np.diff(time) <= 0)
    if stuck.size:
        row = int(stuck[0]) + 1
        raise InputError(
            f"{path}: line {table.lines[row]}: time is {time[row]:g} after {time[row - 1]:g} s; it must grow"
        )
    return time


def by_crank(path: Path, column: str, angle: FloatArray) -> list[IntArray]:
    """Samples of each whole turn, by a crank angle in rad that counts in the sense of pedalling, wrapped or not.

    Turns are counted from the first sample. Raises InputError for fewer than one.
    """
    turned = np.unwrap(angle)
    turned = turned - turned[0]
    if turned[-1] < 0:
        raise InputError(
            f"{path}: {column} counts against the sense of pedalling while time grows; "
            'moments.turning must be the other of "forward" and "backward"'
        )
    turns = int((turned[-1] + np.median(np.diff(turned))) / (2 * np.pi) + 1e-6)  # the last sample closes the turn
    if not turns:
        raise InputError(f"{path}: {column} goes through {np.degrees(turned[-1]):.0f} deg; a whole turn is needed")
    number = np.floor(turned / (2 * np.pi))
    return [np.flatnonzero(number == turn) for turn in range(turns)]


def by_knee(path: Path, column: str, time: FloatArray, knee: FloatArray) -> FloatArray:
    """Times (s) at which the knee is bent most, top dead centre; knee: any unit, growing in extension.

    Raises InputError for fewer than two.
    """
    from scipy.signal import find_peaks

    bent = np.pad(-knee, 1, constant_values=-knee.max())  # a swing that the recording cuts off is a whole one
    tops = find_peaks(bent, prominence=max(_LEAST_SWING * np.ptp(knee), np.finfo(float).tiny))[0] - 1
    tops = tops[(tops > 0) & (tops < len(knee) - 1)]
    if len(tops) < 2:
        raise InputError(
            f"{path}: {column} is smallest {len(tops)} times; a whole turn lies between two such dead centres"
        )
    rough = time[tops]
    reach = np.median(np.diff(rough)) * _NEAR_TOP / (2 * np.pi)
    return np.array([_lowest(time, knee, top, reach) for top in rough])


def _lowest(time: FloatArray, value: FloatArray, near: float, reach: float) -> float:
    """Time of the minimum of the cubic through the values within `reach` of `near`."""
    part = np.abs(time - near) <= reach
    if part.sum() < 6:
        return near
    cubic = np.polynomial.Polynomial.fit(time[part] - near, value[part], 3)
    slope, bend = cubic.deriv(), cubic.deriv(2)
    minima = [float(root.real) for root in slope.roots() if abs(root.imag) < _REAL and bend(root.real) > 0]
    return near + float(np.clip(min(minima, key=abs, default=0.0), -reach, reach))

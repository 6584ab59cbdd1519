"""Joint moments of riders over the crank angle of the tricycle they were measured on, and their CSV files."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.errors import InputError
from fes_mj.files import read_csv
from fes_mj.joints import PerJoint
from fes_mj.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.text import printable
from fes_mj.torque_velocity import TorqueVelocity

GROUPS = ("p1p2", "p1p3")
COLUMNS = ("crank_angle_deg", "knee_Nm", "hip_Nm")
LARGEST_MOMENT = 1e4  # N m, ten times what a strong leg can do; beyond it the unit is another one
_FOLDER = Path(__file__).parent / "data" / "moments"


@dataclass(frozen=True, eq=False)
class JointMoments:
    """Net knee and hip moment of one leg over a tricycle's crank angle, periodic, extension positive.

    crank_angle: shape (n,), rad from top dead centre, increasing within [0, 2 pi).
    knee, hip: shape (n,), N m.
    covariance: of the curves' Fourier coefficients, knee's then hip's (fes_mj.fourier), (N m)^2, shape (98, 98);
    None where their error is not known.
    torque_velocity: how the moments change with joint speed; None is the paper's assumption, not at all.
    measured_on: the tricycle, rider and cadence.
    """

    name: str
    crank_angle: FloatArray
    knee: FloatArray
    hip: FloatArray
    covariance: FloatArray | None = None
    torque_velocity: TorqueVelocity | None = None
    measured_on: ReferenceTricycle = PAPER_TRICYCLE

    def at(self, crank_angle: FloatArray) -> PerJoint[FloatArray]:
        """Moments at crank angles from top dead centre, rad, any shape: linear between the samples, N m."""
        known = self.crank_angle
        return PerJoint(self.knee, self.hip).map(lambda m: np.interp(crank_angle, known, m, period=2 * np.pi))


def load_moments(source: str | Path = "p1p2") -> JointMoments:
    """Joint moments of a rider group ("p1p2", "p1p3"; with covariance) or of a CSV file with the header COLUMNS.

    Raises InputError, naming file, line and value, for anything but at least two rows of finite numbers
    with distinct crank angles in [0, 360) deg.
    """
    if source in GROUPS:
        path = _FOLDER / f"{source}.csv"
        with np.load(path.with_suffix(".npz")) as stored:
            return replace(_read(path), covariance=stored["covariance"])
    return _read(Path(source))


def _read(path: Path) -> JointMoments:
    rows = []
    for line, row in read_csv(path, "joint moments", COLUMNS):
        angle, *values = row
        _refuse_unless(path, line, COLUMNS[0], angle, lambda v: 0 <= v < 360, "at least 0 and below 360")
        for column, value in zip(COLUMNS[1:], values, strict=True):
            allowed = f"between -{LARGEST_MOMENT:g} and {LARGEST_MOMENT:g} N m"
            _refuse_unless(path, line, column, value, lambda v: abs(v) <= LARGEST_MOMENT, allowed)
        rows.append(row)
    if len(rows) < 2:
        raise InputError(f"{path}: {len(rows)} row of moments; at least 2 crank angles are needed")
    data = np.array(sorted(rows)).T
    repeated = np.flatnonzero(np.diff(data[0]) == 0)
    if repeated.size:
        raise InputError(f"{path}: crank_angle_deg {data[0][repeated[0]]:g} is given twice; give each angle once")
    return JointMoments(printable(path.stem), np.radians(data[0]), data[1], data[2])


def _refuse_unless(
    path: Path, line: int, column: str, value: float, accepts: Callable[[float], bool], allowed: str
) -> None:
    if not accepts(value):
        raise InputError(f"{path}: line {line}: {column} is {value:g}; it must be {allowed}")

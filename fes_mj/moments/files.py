"""Files of joint moments: plain CSV, measurement files and the trials they describe, curves drawn for a group."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA
from fes_mj.common.text import printable
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.common.writing import csv_text
from fes_mj.linkage import kinematics
from fes_mj.moments.fourier import fit, fourier
from fes_mj.moments.joint_moments import COLUMNS, GROUPS, MEASURED_POINTS, JointMoments, Misreading
from fes_mj.moments.measured_turns import largest_gap, measured_turns, odd_angles, odd_moments
from fes_mj.moments.measurement_file import Description
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.moments.trial import WHAT, Turn, bounded, load_table
from fes_mj.moments.uncertainty import power_weights, standard_deviation

_FOLDER = DATA / "moments"
DEGREES = np.arange(360.0)  # crank angles of a rider group's curves, from top dead centre


@dataclass(frozen=True, eq=False)
class Measurement:
    """What a file of moments holds: each turn as it was measured, and the moments that are made of them."""

    turns: tuple[Turn, ...]
    moments: JointMoments

    @classmethod
    def of(cls, moments: JointMoments) -> "Measurement":
        """Moments that are not a user's own."""
        return cls((Turn(moments.crank_angle, moments.knee, moments.hip),), moments)

    @property
    def power_sd(self) -> float | None:
        """Standard deviation of the mean power in the tricycle of the measurement, W; None for a single turn."""
        reference, covariance = self.moments.measured_on, self.moments.covariance
        if covariance is None:
            return None
        motion = kinematics.solve(reference.design, np.linspace(0, 2 * np.pi, MEASURED_POINTS, endpoint=False))
        return standard_deviation(power_weights(motion, reference.cadence, reference), covariance)

    def summary(self) -> dict[str, Any]:
        """What is understood of the file, as JSON names and units it."""
        moments = self.moments
        curves, cadence = moments.at(np.radians(DEGREES)), moments.measured_on.cadence
        return {
            "knee_Nm": [curves.knee.min(), curves.knee.max()],
            "hip_Nm": [curves.hip.min(), curves.hip.max()],
            "turns": len(self.turns),
            "samples": sum(len(turn.knee) for turn in self.turns),
            "largest_gap_deg": math.degrees(largest_gap(self.turns)),
            "power_mean_W": sum(moments.power_mean),
            "power_sd_W": self.power_sd,
            "work_per_turn_J": sum(moments.power_mean) / turns_per_second(cadence),
            "cadence_rpm": cadence / RPM,
            "warnings": [misreading._asdict() for misreading in moments.misreadings],
        }


def load_moments(source: str | Path = "p1p2", left: str | Path | None = None) -> JointMoments:
    """Joint moments of a rider group ("p1p2", "p1p3"; with covariance), a CSV file or a measurement file (.toml).

    left: another source for the left leg. Raises InputError naming file, line or key, value and what is allowed.

    >>> fes_mj.load_moments("p1p2")
    <JointMoments p1p2: 360 samples of a turn>
    """
    if left is not None:
        return replace(load_moments(source), left=load_moments(left))
    if source in GROUPS:
        path = _FOLDER / f"{source}.csv"
        with np.load(path.with_suffix(".npz")) as stored:
            return JointMoments(path.stem, *_plain_turn(path), covariance=stored["covariance"])
    return load_measurement(Path(source)).moments


def load_measurement(path: Path) -> Measurement:
    """Read a CSV with the header COLUMNS, crank angle from top dead centre, or a measurement file (.toml)."""
    if path.suffix.lower() == ".toml":
        description = Description.read(path)
        return _measurement(path, *measured_turns(description), description.measured_on, description.cadence_known)
    turn = _plain_turn(path)
    return _measurement(path, [turn], odd_angles(np.degrees(turn.crank_angle), "deg"), PAPER_TRICYCLE, False)


def _plain_turn(path: Path) -> Turn:
    """The turn of a plain file."""
    table = load_table(path, WHAT)
    if table.header != [*COLUMNS]:
        raise InputError(
            f"{path}: the header is {','.join(table.header)!r}; of a plain file it must be {','.join(COLUMNS)!r}; "
            "other columns, units and zeros are described in a measurement file (.toml)"
        )
    angle, *moments = (bounded(table, column, column == COLUMNS[0]) for column in COLUMNS)
    return Turn(np.radians(angle), *moments)


def measured_files(path: Path) -> list[Path]:
    """The file itself and, of a measurement file, those that it names."""
    return [path, *Description.read(path).files] if path.suffix.lower() == ".toml" else [path]


def moments_csv(moments: JointMoments) -> str:
    """The plain CSV of moments, a row a degree."""
    return csv_text(dict(zip(COLUMNS, (DEGREES, *moments.at(np.radians(DEGREES))), strict=True)))


def _measurement(
    path: Path, turns: list[Turn], odd: list[Misreading], measured_on: ReferenceTricycle, cadence_known: bool
) -> Measurement:
    """Moments of one turn as they are; of several their mean, with the covariance of that mean by their scatter."""
    for turn in turns:
        if len(np.unique(np.mod(turn.crank_angle, 2 * np.pi))) < 2:
            count = f"{len(turn.knee)} row{'s' * (len(turn.knee) > 1)} of moments"
            raise InputError(f"{path}: {count} at one crank angle; at least 2 crank angles are needed")
    mean, covariance = turns[0], None
    if len(turns) > 1:
        from scipy.special import ndtr, stdtrit

        rows = np.stack([np.ravel(fit(t.crank_angle, np.column_stack([t.knee, t.hip])).T) for t in turns])
        few = float(stdtrit(len(turns) - 1, ndtr(1.0)))  # Student: one deviation holds 68 %, however few turns
        covariance = few**2 * np.cov(rows.T) / len(turns)
        angle = np.linspace(0, 2 * np.pi, 360, endpoint=False)
        mean = Turn(angle, *(fourier(angle) @ part for part in np.split(rows.mean(axis=0), 2)))
    moments = JointMoments(printable(path.stem), *mean, covariance, None, measured_on, cadence_known)
    return Measurement(tuple(turns), replace(moments, misreadings=(*odd, *odd_moments(turns, moments))))


def sampled_coefficients(group: str) -> FloatArray:
    """Fourier coefficients (fes_mj.moments.fourier) of the curves drawn for "p1p2" or "p1p3", knee's then hip's, N m.

    Shape (curves, 98). The curves are independent of each other: any part of them is a sample as well.
    """
    with np.load(_FOLDER / f"{group}-samples.npz") as stored:
        return np.asarray(stored["coefficients"], float)


def sampled_moments(group: str, count: int | None = None) -> list[JointMoments]:
    """The curves drawn for "p1p2" or "p1p3", or so many of them, each as moments of its own, without a covariance."""
    curves = sampled_coefficients(group)
    rows = np.linspace(0, len(curves) - 1, count or len(curves)).astype(int)
    return [moments_of(curves[row], f"{group} {row + 1}") for row in rows]


def moments_of(coefficients: FloatArray, name: str) -> JointMoments:
    """The curves of Fourier coefficients, knee's then hip's, N m, shape (98,), at every degree."""
    angle = np.radians(DEGREES)
    knee, hip = (fourier(angle) @ part for part in np.split(coefficients, 2))
    return JointMoments(name, angle, knee, hip)

"""Joint moments by their source: a rider group, of which curves are drawn as well, or a file; and files for others."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA
from fes_mj.common.text import printable
from fes_mj.common.units import RPM
from fes_mj.common.writing import csv_text
from fes_mj.linkage.design_file import design_toml
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import COLUMNS, RIDER_GROUPS, JointMoments

_FOLDER = DATA / "moments"
CURVE_DEGREES = np.arange(360.0)  # crank angles of a rider group's curves, from top dead centre


def load_moments(source: str | Path = "p1p2", left: str | Path | None = None) -> JointMoments:
    """Joint moments of a rider group ("p1p2", "p1p3"; with covariance), a CSV file or a measurement file (.toml).

    left: another source for the left leg. Raises InputError naming file, line or key, value and what is allowed.

    >>> fes_mj.load_moments("p1p2")
    <JointMoments p1p2: 360 samples of a turn>
    """
    if left is not None:
        return replace(load_moments(source), left=load_moments(left))
    if source in RIDER_GROUPS:
        return _of_group(str(source))
    from fes_mj.moments.measurement import load_measurement  # much to read of which a rider group needs nothing

    return load_measurement(Path(source)).moments


@cache  # with the curves and tables that are made of them
def _of_group(name: str) -> JointMoments:
    path = _FOLDER / f"{name}.csv"
    angle, knee, hip = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    return JointMoments(name, np.radians(angle), knee, hip, covariance=np.load(path.with_suffix(".npy")))


def is_of_group(moments: JointMoments) -> bool:
    """Whether moments are those of a rider group that ship, and not others of its name."""
    covariance = moments.covariance
    shipped = load_moments(moments.name).covariance if moments.name in RIDER_GROUPS else None
    return covariance is not None and shipped is not None and np.array_equal(covariance, shipped)


def measurement_toml(moments: JointMoments, data: Path) -> str:
    """The measurement file beside the plain CSV of moments: the tricycle, rider and cadence that it does not know.

    Raises InputError for a name that no such file can hold.
    """
    if not data.name.isprintable():
        raise InputError(f"{printable(str(data))}: a measurement file cannot name this file; give it another name")
    measured_on = moments.measured_on
    head = f"[measured_on]\ncadence_rpm = {measured_on.cadence / RPM!r}" if moments.cadence_known else "[measured_on]"
    tricycle = design_toml(measured_on.design).replace("[linkage]", head).replace("[rider]", "[measured_on.rider]")
    return f"[moments]\nfile = {json.dumps(data.name, ensure_ascii=False)}\n{tricycle}"


def moments_csv(moments: JointMoments) -> str:
    """The plain CSV of moments, a row a degree."""
    return csv_text(dict(zip(COLUMNS, (CURVE_DEGREES, *moments.at(np.radians(CURVE_DEGREES))), strict=True)))


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
    angle = np.radians(CURVE_DEGREES)
    knee, hip = (fourier(angle) @ part for part in np.split(coefficients, 2))
    return JointMoments(name, angle, knee, hip)

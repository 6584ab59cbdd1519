"""The evidence on the joint moments: data rows, each a linear functional of the two moment curves."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.design import Design
from fes_mj.design_file import CATALOGUE, load_design
from fes_mj.errors import InputError
from fes_mj.paper.printed import DATA
from fes_mj.torque import GROUPS, JOINTS, REFERENCE, TOP_DEAD_CENTRE, joint_angles, source_angle

Basis = Callable[[Any], NDArray[np.float64]]  # crank angle from top dead centre -> features, last axis

UNITS = {"power": "W", "crank_power": "W", "moment": "N m", "work_share": "1"}
DIRECTIONS = {"extension": 1.0, "flexion": -1.0, "both": 0.0}
_ANGLES = np.linspace(0, 2 * np.pi, 1440, endpoint=False)


@dataclass(frozen=True)
class Evidence:
    """One number about one group's moments; see data/evidence.toml for the quantities."""

    group: str
    name: str
    quantity: str
    value: float
    error: float
    unit: str
    source: str
    design: str = ""
    joint: str = ""
    direction: str = ""
    angle_deg: float = 0.0
    leg_m: float = 0.0


def load_evidence(path: Path = DATA / "evidence.toml") -> list[Evidence]:
    """All rows. Raises InputError naming the row and the key for anything that is not evidence."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: cannot read the evidence: {error}") from None
    rows = []
    for number, row in enumerate(content.get("evidence", []), 1):
        try:
            rows.append(Evidence(**row))
        except TypeError as error:
            raise InputError(f"{path}: evidence row {number} ({row.get('name')}): {error}") from None
        _check(path, rows[-1], content.get("source", {}))
    return rows


def _check(path: Path, row: Evidence, sources: dict[str, str]) -> None:
    allowed: dict[str, tuple[Any, Any]] = {
        "group": (row.group, GROUPS),
        "quantity": (row.quantity, tuple(UNITS)),
        "unit": (row.unit, (UNITS.get(row.quantity),)),
        "source": (row.source, tuple(sources)),
    }
    if row.quantity == "power":
        allowed["design"] = (row.design, CATALOGUE)
    if row.quantity in ("moment", "work_share"):
        allowed["joint"] = (row.joint, JOINTS)
        allowed["direction"] = (row.direction, tuple(DIRECTIONS)[: 2 if row.quantity == "moment" else 3])
    for key, (value, choices) in allowed.items():
        if value not in choices:
            raise InputError(f"{path}: evidence {row.name!r}: {key} is {value!r}; it must be one of {choices}")
    if not (np.isfinite(row.value) and np.isfinite(row.error) and row.error > 0):
        raise InputError(
            f"{path}: evidence {row.name!r}: value {row.value}, error {row.error}; the error must be above 0"
        )


def functional(row: Evidence, basis: Basis) -> tuple[NDArray[np.float64], float, float]:
    """The row as a linear measurement: weights on the knee's then the hip's coefficients, value, error."""
    if row.quantity == "power":
        return power_weights(load_design(row.design), basis), row.value, row.error
    if row.quantity == "moment":
        sign = DIRECTIONS[row.direction]
        features = basis(source_angle(row.joint, np.radians(row.angle_deg), sign))
        weights = [features if joint == row.joint else 0 * features for joint in JOINTS]
        return np.concatenate(weights), row.value, row.error
    shares = _crank_powers(row.leg_m, basis)
    total = np.concatenate([shares["knee", "both"], shares["hip", "both"]])
    if row.quantity == "crank_power":
        return total, row.value, row.error
    part = [shares[joint, row.direction] * (joint == row.joint) for joint in JOINTS]
    # a share is a ratio; multiplied out with the 15 W of Section 3 it is linear
    return np.concatenate(part) - row.value * total, 0.0, row.error * 15.0


def power_weights(design: Design, basis: Basis) -> NDArray[np.float64]:
    """Mean crank power of one leg through the torque map, W per coefficient, knee's then hip's."""
    motion = kinematics.solve(design, _ANGLES)
    return design.linkage.cadence * np.concatenate(
        [
            (basis(source_angle(joint, angle, rate)) * rate[:, None]).mean(axis=0)
            for joint, (angle, rate) in joint_angles(motion).items()
        ]
    )


def _crank_powers(leg: float, basis: Basis) -> dict[tuple[str, str], NDArray[np.float64]]:
    """Power of each joint in each direction in the TRT, legs of `leg` m, moments read at the crank angle itself."""
    design = replace(REFERENCE, rider=replace(REFERENCE.rider, thigh=leg, shank=leg))
    features = basis(_ANGLES - TOP_DEAD_CENTRE)
    powers = {}
    for joint, (_, rate) in joint_angles(kinematics.solve(design, _ANGLES)).items():
        for name, sign in DIRECTIONS.items():
            part = np.where(sign * rate >= 0, rate, 0.0)
            powers[joint, name] = design.linkage.cadence * (features * part[:, None]).mean(axis=0)
    return powers

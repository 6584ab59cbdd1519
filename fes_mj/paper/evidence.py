"""The evidence on the joint moments: data rows, each a linear functional of the two moment curves."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.design_file import CATALOGUE, load_design
from fes_mj.errors import InputError
from fes_mj.fourier import fourier
from fes_mj.paper.printed import DATA
from fes_mj.torque import GROUPS, JOINTS, REFERENCE, TOP_DEAD_CENTRE, joint_angles, source_angle
from fes_mj.uncertainty import power_weights

UNITS = {"power": "W", "crank_power": "W", "moment": "N m", "work_share": "1"}
DIRECTIONS = {"extension": 1.0, "flexion": -1.0, "both": 0.0}
LARGEST_NUMBER = 1e6  # in any unit here; beyond it something else was meant
SHORTEST_LEG, LONGEST_LEG = 0.475, 1.0  # m, thigh and shank alike
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
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{path}: cannot read the evidence: {error}") from None
    tables = content.get("evidence", [])
    sources = content.get("source", {})
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in [sources, *tables]):
        raise InputError(f"{path}: the evidence must be tables [[evidence]], its sources a table [source]")
    rows: list[Evidence] = []
    for number, table in enumerate(tables, 1):
        try:
            rows.append(Evidence(**table))
        except TypeError as error:
            raise InputError(f"{path}: evidence row {number} ({table.get('name')}): {error}") from None
        _check(path, rows[-1], sources)
        if rows[-1].name in {row.name for row in rows[:-1]}:
            raise InputError(f"{path}: evidence {rows[-1].name!r} is given twice; give each row a name of its own")
    if missing := [group for group in GROUPS if group not in {row.group for row in rows}]:
        raise InputError(f"{path}: there is no evidence for group {missing[0]!r}; both groups need some")
    return rows


def _check(path: Path, row: Evidence, sources: dict[str, str]) -> None:
    for field in fields(row):
        if field.type == "str" and not isinstance(getattr(row, field.name), str):
            shown = str(getattr(row, field.name))[:40]
            raise InputError(f"{path}: evidence {str(row.name)[:40]!r}: {field.name} is {shown!r}; it must be a text")
    allowed: dict[str, tuple[Any, Any]] = {
        "group": (row.group, GROUPS),
        "quantity": (row.quantity, tuple(UNITS)),
        "unit": (row.unit, (UNITS.get(row.quantity),)),
        "source": (row.source, tuple(sources)),
    }
    positive = {"error": row.error}
    if row.quantity == "power":
        allowed["design"] = (row.design, CATALOGUE)
    if row.quantity in ("moment", "work_share"):
        allowed["joint"] = (row.joint, JOINTS)
        allowed["direction"] = (row.direction, tuple(DIRECTIONS)[: 2 if row.quantity == "moment" else 3])
    if row.quantity == "moment":
        positive["angle_deg"] = row.angle_deg
    if row.quantity in ("crank_power", "work_share"):
        positive["leg_m"] = row.leg_m
    for key, (value, choices) in allowed.items():
        if value not in choices:
            raise InputError(
                f"{path}: evidence {row.name!r}: {key} is {str(value)[:40]!r}; it must be one of {choices}"
            )
    for key, number in {"value": row.value, **positive}.items():
        if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) <= LARGEST_NUMBER:
            raise InputError(
                f"{path}: evidence {row.name!r}: {key} is {str(number)[:40]!r}; "
                f"it must be a finite number, at most {LARGEST_NUMBER:g}"
            )
        if key in positive and number <= 0:
            raise InputError(f"{path}: evidence {row.name!r}: {key} is {number}; it must be above 0")
    if "leg_m" in positive and not SHORTEST_LEG <= row.leg_m <= LONGEST_LEG:
        raise InputError(
            f"{path}: evidence {row.name!r}: leg_m is {row.leg_m}; "
            f"it must be from {SHORTEST_LEG} to {LONGEST_LEG} m, or the TRT does not close"
        )


def functional(row: Evidence) -> tuple[NDArray[np.float64], float, float]:
    """The row as a linear measurement: weights on the Fourier coefficients, shape (98,), value, error."""
    if row.quantity == "power":
        design = load_design(row.design)
        return power_weights(kinematics.solve(design, _ANGLES), design.linkage.cadence), row.value, row.error
    if row.quantity == "moment":
        sign = DIRECTIONS[row.direction]
        features = fourier(source_angle(row.joint, np.radians(row.angle_deg), sign))
        weights = [features if joint == row.joint else 0 * features for joint in JOINTS]
        return np.concatenate(weights), row.value, row.error
    shares = _crank_powers(row.leg_m)
    total = np.concatenate([shares["knee", "both"], shares["hip", "both"]])
    if row.quantity == "crank_power":
        return total, row.value, row.error
    part = [shares[joint, row.direction] * (joint == row.joint) for joint in JOINTS]
    # a share is a ratio; multiplied out with the 15 W of Section 3 it is linear
    return np.concatenate(part) - row.value * total, 0.0, row.error * 15.0


def _crank_powers(leg: float) -> dict[tuple[str, str], NDArray[np.float64]]:
    """Power of each joint in each direction in the TRT, legs of `leg` m, moments read at the crank angle itself."""
    design = replace(REFERENCE, rider=replace(REFERENCE.rider, thigh=leg, shank=leg))
    features = fourier(_ANGLES - TOP_DEAD_CENTRE)
    powers = {}
    for joint, (_, rate) in joint_angles(kinematics.solve(design, _ANGLES)).items():
        for name, sign in DIRECTIONS.items():
            part = np.where(sign * rate >= 0, rate, 0.0)
            powers[joint, name] = design.linkage.cadence * (features * part[:, None]).mean(axis=0)
    return powers

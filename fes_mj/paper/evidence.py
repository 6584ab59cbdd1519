"""The evidence on the joint moments: data rows, each a linear functional of the two moment curves."""

import math
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, Section, read_toml
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights

UNITS = {"power": "W", "crank_power": "W", "moment": "N m"}
DIRECTIONS = {"extension": 1.0, "flexion": -1.0}
LARGEST_NUMBER = 1e6  # in any unit here; beyond it something else was meant
SMALLEST_ERROR = 1e-9
SHORTEST_LEG, LONGEST_LEG = 0.475, 1.0  # m, thigh and shank alike; the TRT closes with these
_ANGLES = kinematics.uniform_turn(1440)


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
    content = read_toml(path, "evidence")
    sources, tables = content.section("source").content, content.content.get("evidence", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        content.refuse("evidence", tables, "tables [[evidence]]")
    rows: list[Evidence] = []
    for number, table in enumerate(tables, 1):
        rows.append(_row(Section(path, f"evidence {str(table.get('name', number))[:40]!r}", table), sources))
        if rows[-1].name in {row.name for row in rows[:-1]}:
            raise InputError(f"{path}: evidence {rows[-1].name!r} is given twice; give each row a name of its own")
    if missing := [group for group in RIDER_GROUPS if group not in {row.group for row in rows}]:
        raise InputError(f"{path}: there is no evidence for group {missing[0]!r}; both groups need some")
    return rows


def of_group(evidence: list[Evidence], group: str) -> list[Evidence]:
    """The rows of one group."""
    return [row for row in evidence if row.group == group]


def _row(table: Section, sources: dict[str, str]) -> Evidence:
    """One row, every key checked."""
    names = [field.name for field in fields(Evidence)]
    table.only(names)
    table.require(names[:7], "every row needs it")
    if not isinstance(table.content["name"], str):
        table.refuse("name", str(table.content["name"])[:40], "a text")
    quantity = table.choice("quantity", UNITS)
    for key, choices in {"group": RIDER_GROUPS, "unit": (UNITS[quantity],), "source": tuple(sources)}.items():
        table.choice(key, choices)
    table.number("value", -LARGEST_NUMBER, LARGEST_NUMBER, f"a finite number, at most {LARGEST_NUMBER:g}")
    positive = f"a number above 0, at most {LARGEST_NUMBER:g}"
    table.number("error", SMALLEST_ERROR, LARGEST_NUMBER, positive)
    if quantity == "power":
        table.choice("design", DESIGNS)
    if quantity == "moment":
        table.choice("joint", JOINTS)
        table.choice("direction", tuple(DIRECTIONS))
        table.require(["angle_deg"], "a moment needs it")
        table.number("angle_deg", SMALLEST_ERROR, LARGEST_NUMBER, positive)
    if quantity == "crank_power":
        table.require(["leg_m"], "a crank_power needs it")
        table.number("leg_m", SHORTEST_LEG, LONGEST_LEG, f"from {SHORTEST_LEG} to {LONGEST_LEG} m: the TRT must close")
    return Evidence(**table.content)


def functional(row: Evidence) -> FloatArray:
    """The row as a linear measurement: its weights on the Fourier coefficients, shape (98,)."""
    if row.quantity == "power":
        design = load_design(row.design)
        return power_weights(kinematics.solve(design, _ANGLES), design.linkage.cadence, PAPER_TRICYCLE)
    if row.quantity == "moment":
        angle = math.radians(row.angle_deg)
        return of_joint(row.joint, fourier(PAPER_TRICYCLE.source_angle(row.joint, angle, DIRECTIONS[row.direction])))
    motion = own_leg_motion(row.leg_m)
    features = fourier(_ANGLES - PAPER_TRICYCLE.top_dead_centre)
    parts = [rate @ features / rate.size for rate in motion.joint_rate]
    return PAPER_TRICYCLE.cadence * np.concatenate(parts)


def of_joint(joint: str, features: FloatArray) -> FloatArray:
    """Weights, shape (..., 98), of functionals that see one joint's curve alone, by these of its terms, (..., 49)."""
    return np.concatenate([features * (joint == name) for name in JOINTS], axis=-1)


def own_leg_motion(leg: float) -> kinematics.Motion:
    """A turn of the TRT with a thigh and a shank of `leg` m; its moments are read at the crank angle itself."""
    reference = PAPER_TRICYCLE.design
    return kinematics.solve(reference.with_rider(thigh=leg, shank=leg), _ANGLES)

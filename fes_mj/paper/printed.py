"""What the paper prints, as data."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import NamedTuple

DATA = Path(__file__).parents[1] / "data"
SIX_BARS = ("r1", "r2", "d1", "d2")


class Table1Row(NamedTuple):
    """Printed crank power in W by rider group, and joint ranges in deg."""

    power: dict[str, float]
    knee_range: tuple[float, float]
    hip_range: tuple[float, float]


def table1() -> dict[str, Table1Row]:
    """Table 1 of the paper by design name."""
    rows = tomllib.loads((DATA / "paper.toml").read_text())["table1"]
    return {
        name: Table1Row(row["power_W"], tuple(row["knee_range_deg"]), tuple(row["hip_range_deg"]))
        for name, row in rows.items()
    }

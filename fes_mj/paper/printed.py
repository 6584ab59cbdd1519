"""What the paper prints, as data."""

from pathlib import Path

from fes_mj.inputs import read_toml
from fes_mj.verification.case import Expected

DATA = Path(__file__).parents[1] / "data"
SIX_BARS = ("r1", "r2", "d1", "d2")


def table1() -> dict[str, Expected]:
    """Table 1 of the paper by design name."""
    rows = read_toml(DATA / "paper.toml", "printed values").section("table1").content
    return {
        name: Expected(row["power_W"], tuple(row["knee_range_deg"]), tuple(row["hip_range_deg"]))
        for name, row in rows.items()
    }

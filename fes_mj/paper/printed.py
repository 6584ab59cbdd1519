"""What the paper prints, as data."""

from fes_mj.common.reading import DATA, read_toml
from fes_mj.verification.case import Expected


def table1() -> dict[str, Expected]:
    """Table 1 of the paper by design name."""
    rows = read_toml(DATA / "paper.toml", "printed values").section("table1").content
    return {
        name: Expected(row["power_W"], tuple(row["knee_range_deg"]), tuple(row["hip_range_deg"]))
        for name, row in rows.items()
    }

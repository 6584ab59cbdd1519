"""What links and pins are made of, and the sizes that are in stock: data/materials.toml."""

from functools import cache
from typing import NamedTuple

from fes_mj.common.errors import require_one_of
from fes_mj.common.reading import DATA, Section, read_toml


class Material(NamedTuple):
    """What links are made of, SI."""

    name: str
    density: float
    yield_strength: float
    modulus: float


class PinStock(NamedTuple):
    """What pins are made of, and the bushes that they turn in; SI.

    pressure: allowed on the projected area of a bush. diameter, bush_wall: sizes that there are, side by side.
    """

    name: str
    yield_strength: float
    pressure: float
    diameter: tuple[float, ...]
    bush_wall: tuple[float, ...]


class PlateStock(NamedTuple):
    """Plates that there are, m; edge: least distance from the middle of a hole to the edge, in its diameters."""

    width: tuple[float, ...]
    thickness: tuple[float, ...]
    edge: float


@cache
def _tables() -> Section:
    return read_toml(DATA / "materials.toml", "materials")


def materials() -> tuple[str, ...]:
    """Names of what links can be made of."""
    return tuple(_tables().section("link").content)


def material(name: str) -> Material:
    """What links are made of, by its name. Raises InputError for one that is not known."""
    require_one_of("material", name, materials())
    return Material(**_tables().section("link").content[name])


@cache
def pin_stock() -> PinStock:
    """Pins to choose from."""
    return PinStock(**_tables().content["pin"])


@cache
def plate_stock() -> PlateStock:
    """Plates to choose from."""
    return PlateStock(**_tables().content["plate"])

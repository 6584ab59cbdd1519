"""A DXF drawing: its layers, units and dimension style, and lines, circles, texts and dimensions in it.

Points are complex numbers in mm on paper. Everything is seen from the rider's right, the rider facing right.
"""

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from ezdxf import units
from ezdxf._options import options
from ezdxf.document import Drawing
from ezdxf.enums import TextEntityAlignment
from ezdxf.filemanagement import new

from fes_mj.common.arrays import ComplexArray

TEXT_HEIGHT = 2.5  # mm, of letters
FONT = "DejaVuSans.ttf"
# Name -> AutoCAD colour, line width in 1/100 mm, kind of line
PEN_LAYERS = {
    "OUTLINE": (7, 50, "CONTINUOUS"),
    "HOLES": (7, 35, "CONTINUOUS"),
    "CENTRE": (8, 18, "CENTER2"),
    "DIMENSIONS": (7, 18, "CONTINUOUS"),
    "TEXT": (7, 18, "CONTINUOUS"),
    "PHANTOM": (9, 18, "CONTINUOUS"),
    "PATH": (8, 18, "DASHEDX2"),
    "FRAME": (7, 50, "CONTINUOUS"),
}
_DIMENSION = {
    "dimtxt": TEXT_HEIGHT, "dimasz": TEXT_HEIGHT, "dimexo": 1.0, "dimexe": 1.5, "dimgap": 0.8,
    "dimtad": 1, "dimtih": 0, "dimtoh": 0,
    "dimlunit": 2, "dimdec": 2, "dimzin": 8, "dimdsep": ord("."), "dimtxsty": "PLAIN", "dimscale": 1.0, "dimtmove": 0,
    "dimlwd": 18, "dimlwe": 18,
}  # fmt: skip


def seen(points: Any) -> Any:
    """Points of the plane of the paper by Lanese et al., m, as they are drawn, mm: x to the left."""
    return -1000 * np.conj(points)


@dataclass(frozen=True)
class Pen:
    """Draws into one file; a copy of it `at` another place and in another scale draws there."""

    document: Drawing
    at: complex = 0j
    scale: float = 1.0

    @classmethod
    def new(cls) -> "Pen":
        """An empty drawing in mm."""
        with _without_date():
            document = new("R2010", setup=["linetypes"], units=units.MM)
        document.styles.new("PLAIN", dxfattribs={"font": FONT})
        for name, (colour, width, line) in PEN_LAYERS.items():
            document.layers.add(name, color=colour, lineweight=width, linetype=line)
        style = document.dimstyles.new("PLAIN")
        for name, value in _DIMENSION.items():
            style.set_dxf_attrib(name, value)
        return cls(document)

    def moved(self, at: complex, scale: float) -> "Pen":
        """The pen in another frame of the same drawing."""
        return Pen(self.document, at, scale)

    @property
    def _space(self) -> Any:
        return self.document.modelspace()

    def _place(self, point: complex) -> tuple[float, float]:
        placed = self.at + self.scale * point
        return placed.real, placed.imag

    def line(self, points: Sequence[complex] | ComplexArray, layer: str, close: bool = False) -> None:
        """Straight from point to point."""
        self._space.add_lwpolyline(list(map(self._place, points)), close=close, dxfattribs={"layer": layer})

    def outline(self, points: Sequence[complex], bulges: Sequence[float], layer: str) -> None:
        """A closed line of straights and arcs; bulge: tangent of a quarter of the arc's angle, 0 for a straight."""
        rows = [(*self._place(point), bulge) for point, bulge in zip(points, bulges, strict=True)]
        self._space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs={"layer": layer})

    def circle(self, centre: complex, diameter: float, layer: str) -> None:
        self._space.add_circle(self._place(centre), self.scale * diameter / 2, dxfattribs={"layer": layer})

    def cross(self, centre: complex, half: float) -> None:
        """Centre lines, `half` mm long on paper to each side."""
        for arm in (half, 1j * half):
            ends = [centre - arm / self.scale, centre + arm / self.scale]
            self._space.add_line(*map(self._place, ends), dxfattribs={"layer": "CENTRE"})

    def text(
        self, text: str, place: complex, height: float = TEXT_HEIGHT, align: str = "LEFT", layer: str = "TEXT"
    ) -> None:
        entity = self._space.add_text(text, height=height, dxfattribs={"layer": layer, "style": "PLAIN"})
        entity.set_placement(self._place(place), align=TextEntityAlignment[align])

    def dimension(self, start: complex, end: complex, through: complex, angle: float = 0.0) -> None:
        """Distance of two points in a direction, deg; its line runs through a third one."""
        base, first, last = map(self._place, (through, start, end))
        self._space.add_linear_dim(base, first, last, angle=angle, **self._look).render()

    def radius(self, centre: complex, radius: float, angle: float) -> None:
        """Of an arc, outside of it in a direction, deg."""
        self._space.add_radius_dim(self._place(centre), radius=self.scale * radius, angle=angle, **self._look).render()

    @property
    def _look(self) -> dict[str, Any]:
        """Of dimensions."""
        return {"dimstyle": "PLAIN", "override": {"dimlfac": 1 / self.scale}, "dxfattribs": {"layer": "DIMENSIONS"}}

    def dxf(self) -> str:
        """The drawing as a file; without a date, so that the same drawing gives the same bytes."""
        stream = io.StringIO()
        for kind in sorted(self.document.entitydb.dxf_types_in_use()):  # ezdxf declares them in the order of a set
            self.document.classes.add_class(kind)
        with _without_date():
            self.document.write(stream)
        return stream.getvalue()


@contextmanager
def _without_date() -> Iterator[None]:
    kept, options.write_fixed_meta_data_for_testing = options.write_fixed_meta_data_for_testing, True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = kept

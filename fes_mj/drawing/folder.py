"""Everything that is handed to a workshop, as the files of a folder."""

from collections.abc import Iterable
from pathlib import Path

from fes_mj.drawing.mechanism import LINE
from fes_mj.drawing.part import FIRST, draw_part, extent, notes
from fes_mj.drawing.pen import Pen
from fes_mj.drawing.sheet import pictures, sheet
from fes_mj.drawing.solid import step_text
from fes_mj.drawing.tables import link_moments_csv, links_csv, pin_forces_csv
from fes_mj.linkage.plates import Plate
from fes_mj.statics.sizes import Build

SHEET = ("sheet.dxf", "sheet.svg", "sheet.pdf")
TABLES = {"links.csv": links_csv, "pin_forces.csv": pin_forces_csv, "link_moments.csv": link_moments_csv}


def names(links: Iterable[str], solids: bool = False) -> list[Path]:
    """Files in the folder, of a design with these links; solids: also STEP."""
    kinds = ("dxf", "step") if solids else ("dxf",)
    parts = [Path("links") / f"{link}.{kind}" for kind in kinds for link in links]
    return [*parts, *map(Path, (*SHEET, *TABLES))]


def contents(build: Build, solids: bool = False) -> dict[Path, str | bytes]:
    """Every file of the folder: its name -> what is in it."""
    drawn = sheet(build)
    parts: list[str | bytes] = [link_drawing(build, plate).dxf() for plate in build.plates.values()]
    if solids:
        parts += [step_text(plate) for plate in build.plates.values()]
    pages: list[str | bytes] = [drawn.dxf(), *pictures(drawn), *(table(build) for table in TABLES.values())]
    return dict(zip(names(build.plates, solids), [*parts, *pages], strict=True))


def link_drawing(build: Build, plate: Plate) -> Pen:
    """A link in full size, the notes below it."""
    pen, low = Pen.new(), extent(plate).low
    draw_part(pen, plate)
    for number, line in enumerate(notes(build, plate, "1:1"), 1):
        pen.text(line, low - 1j * (2 * FIRST + LINE * number))
    return pen

"""Everything that is handed to a workshop, as the files of a folder: drawings, solids, tables."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from fes_mj.common.writing import csv_text
from fes_mj.drawing.mechanism import LINE
from fes_mj.drawing.part import FIRST, draw_part, notes, on_paper, plate_extent
from fes_mj.drawing.pen import Pen
from fes_mj.drawing.sheet import pictures, sheet
from fes_mj.drawing.solid import step_text
from fes_mj.linkage.plates import Plate
from fes_mj.statics.sizes import Build

SHEET = ("sheet.dxf", "sheet.svg", "sheet.pdf")


def links_csv(build: Build) -> str:
    """A row a hole: where it is in the drawing of its link (m), hole and pin diameter (m), layer, thickness (m)."""
    rows = ["link,hole,x_m,y_m,hole_diameter_m,pin_diameter_m,layer,thickness_m"]
    for body, plate in build.plates.items():
        for joint, place, diameter in plate.holes:
            at = on_paper(place) / 1000
            numbers = (at.real, at.imag, diameter, build.pins[joint], build.stack.layers[body], plate.thickness)
            rows.append(",".join([body, joint, *(f"{round(number, 12) + 0.0:.9g}" for number in numbers)]))
    return "\n".join(rows) + "\n"


def pin_forces_csv(build: Build) -> str:
    """A row a crank angle: of each joint the force vector (N, x backwards, y up) of its first body on its second one.

    Riding with masses, and pushed: the pedal load with the crank blocked there.
    """
    loads = build.loads
    columns = {"crank_angle_deg": np.degrees(loads.motion.crank_angle)}
    for case, forces in (("riding", loads.riding), ("pushed", loads.pushed)):
        for joint in build.pins:
            columns[f"{joint}_{case}_x_N"] = forces[joint].real
            columns[f"{joint}_{case}_y_N"] = forces[joint].imag
    return csv_text(columns)


def link_moments_csv(build: Build) -> str:
    """A row a crank angle: of each link the bending moment in its plane beside a hole, N m, on the way to another one.

    Counter-clockwise, on the part up to there, by the part beyond. Between two holes it changes linearly; beside the
    last one it is 0. Cases as in pin_forces_csv.
    """
    columns = {"crank_angle_deg": np.degrees(build.loads.motion.crank_angle)}
    for body, plate in build.plates.items():
        for part in build.loads.sections(plate, dict.fromkeys(build.pins, 0.0)):
            columns[f"{body}_{part.start}_to_{part.end}_{part.case}_Nm"] = part.bending
    return csv_text(columns)


TABLES = {"links.csv": links_csv, "pin_forces.csv": pin_forces_csv, "link_moments.csv": link_moments_csv}


def names(links: Iterable[str], solids: bool = False) -> list[Path]:
    """Files in the folder, of a design with these links; solids: also STEP."""
    kinds = ("dxf", "step") if solids else ("dxf",)
    parts = [Path("links") / f"{link}.{kind}" for kind in kinds for link in links]
    return [*parts, *map(Path, (*SHEET, *TABLES))]


def contents(build: Build, solids: bool = False) -> dict[Path, str | bytes]:
    """Every file of the folder: its name -> what is in it."""
    page = sheet(build)
    parts: list[str | bytes] = [link_drawing(build, plate).dxf() for plate in build.plates.values()]
    if solids:
        parts += [step_text(plate) for plate in build.plates.values()]
    pages: list[str | bytes] = [page.dxf(), *pictures(page), *(table(build) for table in TABLES.values())]
    return dict(zip(names(build.plates, solids), [*parts, *pages], strict=True))


def link_drawing(build: Build, plate: Plate) -> Pen:
    """A link in full size, the notes below it."""
    pen, low = Pen.new(), plate_extent(plate)[0]
    draw_part(pen, plate)
    for number, line in enumerate(notes(build, plate, "1:1"), 1):
        pen.text(line, low - 1j * (2 * FIRST + LINE * number))
    return pen

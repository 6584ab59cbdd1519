"""A link as a solid body, in STEP: by Open CASCADE, the kernel that CAD programs in Python share.

By itself it is a 67 MB download, under build123d 165 MB.
"""

import itertools
import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.drawing.part import on_paper
from fes_mj.linkage.plates import Plate

# What Open CASCADE says of the moment: date, and how many bodies this process has written.
_DATE, _COUNT = re.compile(r"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'"), re.compile(r"(?<=PRODUCT\()'(\w+) \d+','\w+ \d+'")


def step_text(plate: Plate) -> str:
    """The plate in its drawing's frame, mm, its lower face at height 0; without a date."""
    from OCP.Interface import Interface_Static
    from OCP.Message import Message
    from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

    Message.DefaultMessenger_s().ChangePrinters().Clear()  # it would tell its progress on standard output
    writer = STEPControl_Writer()
    Interface_Static.SetCVal_s("write.step.product.name", plate.body)
    writer.Transfer(solid(plate), STEPControl_StepModelType.STEPControl_AsIs)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{plate.body}.step"
        writer.Write(str(path))
        return _COUNT.sub(r"'\1','\1'", _DATE.sub("''", path.read_text()))


def solid(plate: Plate) -> Any:
    """Open CASCADE's shape: the outline raised by the thickness, less cylinders."""
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
    from OCP.GC import GC_MakeArcOfCircle
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec

    def point(place: complex) -> Any:
        at = on_paper(place)
        return gp_Pnt(at.real, at.imag, 0.0)

    arcs = [
        [corner.centre + plate.margin * corner.before * np.exp(1j * part * corner.angle) for part in (0.0, 0.5, 1.0)]
        for corner in plate.corners
    ]
    outline, height = BRepBuilderAPI_MakeWire(), 1000 * plate.thickness
    for arc, (following, *_) in itertools.pairwise([*arcs, arcs[0]]):
        outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(*map(point, arc)).Value()).Edge())
        outline.Add(BRepBuilderAPI_MakeEdge(point(arc[-1]), point(following)).Edge())
    shape = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()).Face(), gp_Vec(0, 0, height)).Shape()
    for hole in plate.holes:
        axis = gp_Ax2(point(hole.place), gp_Dir(0, 0, 1))
        shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(axis, 500 * hole.diameter, height).Shape()).Shape()
    return shape

"""What goes with the drawings as CSV: links with their holes, forces on every pin and moments in links over a turn."""

import numpy as np

from fes_mj.common.writing import csv_text
from fes_mj.drawing.part import drawn
from fes_mj.statics.sizes import Build


def links_csv(build: Build) -> str:
    """A row a hole: where it is in the drawing of its link (m), hole and pin diameter (m), layer, thickness (m)."""
    rows = ["link,hole,x_m,y_m,hole_diameter_m,pin_diameter_m,layer,thickness_m"]
    for body, plate in build.plates.items():
        for joint, place, diameter in plate.holes:
            at = drawn(place) / 1000
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

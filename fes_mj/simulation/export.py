"""What other tools get: the model as commented MJCF, a scene around it, and its turn as a table (the sidecar)."""

import math
import re
from collections.abc import Collection, Iterable
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from string import Template
from xml.sax.saxutils import escape

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, read_toml
from fes_mj.common.text import printable
from fes_mj.common.writing import csv_text, require_replaceable, require_writable, write_files
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.shapes import lowest_point
from fes_mj.linkage.turning import FROM_TOP, turning
from fes_mj.linkage.variables import crank_speed
from fes_mj.muscles.drive import Muscles
from fes_mj.simulation.appearance import FIELD_OF_VIEW, Spec, framing
from fes_mj.simulation.native_muscles import native_muscles
from fes_mj.simulation.road_mjcf import ROAD
from fes_mj.simulation.variants import variant_model, variant_options
from fes_mj.statics.drive import Drive, driven_speed, torque_source
from fes_mj.statics.equilibrium import crank_moment

SIDECAR_ROWS = 720  # a turn: every half degree
CAMERA_SIDE = (-0.55, 0.80, 0.25)  # of the oblique camera: from the front right, a little above
LIGHT = (-0.5, 1.0, 3.0)  # m from the middle of the model
FLOOR_GAP = 0.1  # m below the lowest point of the turn


def mjcf_text(spec: Spec) -> str:
    """A model of build_mjcf as commented MJCF that reloads bit for bit."""
    heading = f"{spec.comment}. Written by fes_mj {version('fes-mj')}; m, kg, s, rad."
    spec.comment = re.sub("-(?=-)", "- ", heading)  # no comment may hold two hyphens in a row
    spec.compile()
    kinds = ("model", "road") if any(joint.name == ROAD for joint in spec.joints) else ("model",)
    comments = read_toml(DATA / "mjcf_comments.toml", "comments")
    texts = {mark: text for kind in kinds for mark, text in comments.section(kind).content.items()}
    lines, pending = [], {mark: text for mark, text in texts.items() if text}
    for line in spec.to_xml().splitlines():
        indent = line[: len(line) - len(line.lstrip())]
        lines += [f"{indent}<!-- {pending.pop(mark)} -->" for mark in [*pending] if mark in line]
        lines.append(line)
    return "\n".join(lines) + "\n"


def scene_text(design: Design, model_file: str) -> str:
    """A scene in MJCF that includes the model: floor, light, sky and a camera from the front right."""
    centre, distance = framing(design)
    middle = np.array([centre.real, 0.0, centre.imag])
    position, light = middle + distance * np.array(CAMERA_SIDE), middle + LIGHT
    right = np.cross(middle - position, (0.0, 0.0, 1.0))
    up = np.cross(right, middle - position)

    def text(*values: float) -> str:
        return " ".join(f"{value:.4g}" for value in values)

    return Template((files("fes_mj") / "data" / "scene.xml").read_text(encoding="utf-8")).substitute(
        name=escape(design.name, {'"': "&quot;"}),
        model_file=escape(model_file, {'"': "&quot;"}),
        centre=text(*middle),
        extent=text(distance * math.tan(math.radians(FIELD_OF_VIEW) / 2)),
        camera=text(*position),
        camera_axes=text(*right / np.linalg.norm(right), *up / np.linalg.norm(up)),
        field_of_view=text(FIELD_OF_VIEW),
        floor=text(lowest_point(design) - FLOOR_GAP),
        light=text(*light),
    )


def sidecar_text(design: Design, drive: Drive, cadence: float | None = None, legs: int = 1) -> str:
    """One turn at a cadence (rad/s, by default Eq. 16) as CSV, uniform in crank angle.

    Angles and moments of the driven joints, named as in the model, then the moment of all legs on the crank: with
    masses and weight, as the model shows it, and without (quasi-static). With muscles also their activations, and
    moments as statics has them.
    """
    cadence = crank_speed(design, cadence)
    torque = torque_source(drive, design, cadence)
    native = native_muscles(design, drive, cadence) if isinstance(drive, Muscles) else None
    angle = kinematics.uniform_turn(SIDECAR_ROWS)
    columns = {"crank_angle_deg": np.degrees(angle), FROM_TOP: turning(design).degrees_from_top(angle)}
    massive, massless = np.zeros((2, SIDECAR_ROWS))
    for leg in LEGS[legs]:
        motion, leg_torque = kinematics.solve(design, angle - leg.lag), torque.of(leg.prefix)
        moment = leg_torque.along(motion, cadence)
        for joint, angles in motion.joint_angle.items():
            columns[f"{leg.prefix}{joint}_deg"] = np.degrees(angles)
            columns[f"{leg.prefix}{joint}_Nm"] = moment[joint]
        for muscle, activation in (native.activation(angle - leg.lag) if native else {}).items():
            columns[f"{leg.prefix}{muscle}_activation"] = activation
        massive += crank_moment(motion, leg_torque, cadence)
        massless += crank_moment(motion, leg_torque, cadence, mass_scale=0.0)
    return csv_text(columns | {"crank_Nm": massive, "quasi_static_crank_Nm": massless})


_SCENE = "scene.xml"


def export(
    design: Design,
    drive: Drive,
    path: str | Path,
    *,
    cadence: float | None = None,
    variants: Iterable[str] = (),
    scene: bool = False,
    inputs: Collection[Path] = (),
) -> dict[str, Path]:
    """Write the MJCF model of a design to `path` (.xml) and, beside it as CSV, its moments over a turn.

    drive: JointMoments, or with the variant muscles Muscles, of which it is the most probable rider.
    cadence: rad/s, by default Eq. 16. variants: names of variants.VARIANTS, combined. scene: also write scene.xml,
    beside the model: floor, light and camera. inputs: files that must not be replaced. Returns the paths by what they
    hold. Raises InputError for variants that exclude each other and for files that cannot be written, before any is.

    >>> files = fes_mj.export(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), folder / "d1.xml")
    >>> [file.name for file in files.values()]
    ['d1.xml', 'd1.csv']
    """
    options, out = variant_options(variants), Path(path)
    cadence = driven_speed(design, drive, cadence, options.get("legs", 1))
    require_writable(out, "the model", ".xml", inputs)
    files = {"model": out, "table": out.with_suffix(".csv")}
    require_replaceable([files["table"]], "the table", inputs)
    if scene:
        if out.name.lower() == _SCENE or printable(out.name) != out.name:
            raise InputError(f"{out}: the scene is {_SCENE}, which names the model; give the model another name")
        files["scene"] = out.with_name(_SCENE)
        require_replaceable([files["scene"]], "the scene", inputs)
    texts = {
        "model": mjcf_text(variant_model(design, drive, cadence, options)),
        "table": sidecar_text(design, drive, cadence, options.get("legs", 1)),
        "scene": scene_text(design, out.name),
    }
    write_files({file: texts[content] for content, file in files.items()}, unnamed={*files.values()} - {out})
    return files

"""Measurement files (TOML): what the columns of a file of joint moments mean, and on what they were measured."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.common.reading import Section, is_list, is_text, read_toml
from fes_mj.common.units import RPM
from fes_mj.linkage.design_file import read_rider, read_values
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import VARIABLES
from fes_mj.moments.conventions import CONVENTIONS, SIGNS, Convention
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.moments.trial import TIME_UNITS

_COLUMNS = {
    "crank": "crank_angle_deg", "knee": "knee_Nm", "hip": "hip_Nm",
    "knee_angle": "knee_angle_r", "hip_angle": "hip_flexion_r", "time": "", "trial": "", "rider": "",  # "": none
}  # fmt: skip
_OTHERS = (
    "file", "kinematics", "angle_unit", "zero", "turning", "leg", "time_unit", "unit", "convention", "extension",
    "pedal_force",
)  # fmt: skip
_SENSES = {"forward": 1.0, "backward": -1.0}
ANGLE_UNITS = {"deg": math.radians(1), "rad": 1.0, "turn": 2 * math.pi, "percent": 2 * math.pi / 100}  # rad
MOMENT_UNITS = {"N m": 1.0, "N mm": 1e-3}  # N m; each also per kg
_OF_MOMENTS = ("knee", "hip", "unit", "convention", "extension")  # what a file of pedal forces does not have
_OF_THE_CRANK = ("crank", "angle_unit", "zero", "turning", "leg")  # what a trial counted by the knee does not have


@dataclass(frozen=True)
class Description:
    """A measurement file, every key checked.

    files: those that it names, moments first. columns: by key, "" for one that is not said. convention: signs of
    extension. sense: of the crank angle. zero: where that is, rad after top dead centre. scale: N m per unit of the
    file. time_unit: "" if it is not said. riders: by file, or none. pedal_force: columns of its components, or none.
    """

    section: Section
    data: list[Path]
    kinematics: list[Path]
    columns: dict[str, str]
    convention: Convention
    sense: float
    zero: float
    scale: float
    time_unit: str
    riders: list[str]
    pedal_force: list[str]
    measured_on: ReferenceTricycle
    cadence_known: bool

    @property
    def files(self) -> list[Path]:
        """The files that it names."""
        return [*self.data, *self.kinematics]

    @classmethod
    def read(cls, path: Path) -> "Description":
        """Raises InputError naming file, key, value and what is allowed."""
        content = read_toml(path, "measurement file")
        content.only(("moments", "measured_on"))
        section, measured_on = content.section("moments"), read_tricycle(content.section("measured_on"))
        section.only((*_COLUMNS, *_OTHERS))
        section.require(["file"], "it names the file that holds the moments")
        data, kinematics = _paths(section, "file"), _paths(section, "kinematics")
        if kinematics:
            _only_by_knee(section, data, kinematics)
        pedal_force = _pedal_force(section)
        return cls(
            section,
            data,
            kinematics,
            {key: _word(section, key, default) for key, default in _COLUMNS.items()},
            _convention(section),
            _SENSES[section.choice("turning", _SENSES, "forward")],
            _zero(section, measured_on),
            _scale(section, content.section("measured_on").section("rider"), measured_on),
            section.choice("time_unit", ("", *TIME_UNITS), ""),
            _riders(section, len(data)),
            pedal_force,
            measured_on,
            bool({"cadence_rpm", "gear_ratio"} & content.section("measured_on").content.keys()),
        )


def _paths(section: Section, key: str) -> list[Path]:
    """One file name or a list of them, looked for beside the measurement file."""

    def fits(value: Any) -> bool:
        names = value if isinstance(value, list) else [value]
        return bool(names or key != "file") and is_list(names, lambda name: is_text(name) and name and "\0" not in name)

    value = section.value(key, [], fits, "the name of a file, or a list of such names")
    return [section.path.parent / name for name in (value if isinstance(value, list) else [value])]


def _word(section: Section, key: str, default: str) -> str:
    if key == "rider" and isinstance(section.content.get(key), list):
        return default
    return str(section.value(key, default, is_text, "the name of a column"))


def _riders(section: Section, files: int) -> list[str]:
    """The rider of each file, where the key `rider` is a list; empty where it is a column."""
    value = section.content.get("rider")
    if not isinstance(value, list):
        return []
    allowed = "the name of a column, or a list with a name for each file"
    return [*section.value("rider", [], lambda names: is_list(names, is_text, files), allowed)]


def _convention(section: Section) -> Convention:
    """The signs that are said: by name or one by one, 0 where neither says it."""
    extension = section.section("extension")
    if "convention" in section.content:
        _exclude(section, ["extension"], "convention", "tell the signs in two ways: leave out one of them")
        return CONVENTIONS[section.choice("convention", CONVENTIONS)]
    extension.only((*JOINTS, *(f"{joint}_angle" for joint in JOINTS)))

    def sign(key: str) -> float:
        return SIGNS[extension.choice(key, SIGNS)] if key in extension.content else 0.0

    return Convention(PerJoint.of(lambda joint: sign(f"{joint}_angle")), PerJoint.of(sign))


def _pedal_force(section: Section) -> list[str]:
    """The columns of pedal_force; empty where the file holds moments."""
    allowed = "the names of two columns: force on the pedal along x and y, N"
    columns = section.value("pedal_force", [], lambda value: value == [] or is_list(value, is_text, 2), allowed)
    if columns:
        _exclude(section, _OF_MOMENTS, "pedal_force", "exclude each other: the file holds moments or pedal forces")
    return [*columns]


def _exclude(section: Section, keys: Iterable[str], other: str, why: str) -> None:
    """Refuse keys that cannot stand beside another."""
    for key in keys:
        if key in section.content:
            raise InputError(f"{section.path}: {section.label(key)} and {section.label(other)} {why}")


def _only_by_knee(section: Section, data: list[Path], kinematics: list[Path]) -> None:
    """Refuse a trial whose crank angle is told twice, or whose files do not pair."""
    twice = "tell the crank angle in two ways; with kinematics the knee tells it: leave out one of them"
    _exclude(section, _OF_THE_CRANK, "kinematics", twice)
    if len(data) != len(kinematics):
        raise InputError(
            f"{section.path}: {section.label('file')} names {len(data)} and {section.label('kinematics')} "
            f"{len(kinematics)} files; each trial needs one of both"
        )


def _zero(section: Section, measured_on: ReferenceTricycle) -> float:
    """Where the crank angle is zero, rad after top dead centre of the leg: the left leg's comes half a turn later."""
    value = section.content.get("zero", "tdc")
    later = math.pi * (section.choice("leg", ("right", "left"), "right") == "left")
    if isinstance(value, str):
        named = {"tdc": 0.0, "horizontal": -measured_on.top_dead_centre}
        return named[section.choice("zero", named, "tdc")] - later
    allowed = '"tdc", "horizontal" or degrees after tdc from -360 to 360'
    return math.radians(section.number("zero", -360, 360, allowed)) - later


def _scale(section: Section, rider: Section, measured_on: ReferenceTricycle) -> float:
    """N m per unit of the file."""
    unit = section.choice("unit", [name + per for per in ("", "/kg") for name in MOMENT_UNITS], "N m")
    name, per_kg, _ = unit.partition("/kg")
    if per_kg:
        rider.require(["mass"], f"{section.label('unit')} is {unit}: the moments are per kg of the rider's body mass")
    return MOMENT_UNITS[name] * (measured_on.design.rider.mass if per_kg else 1.0)


def read_tricycle(section: Section) -> ReferenceTricycle:
    """The tricycle, rider and cadence: the paper's, with what the file says of its own."""
    section.choice("kind", ("trt",), "trt")
    rider, paper = section.section("rider"), PAPER_TRICYCLE.design
    linkage = read_values(section, "trt", "kind", "cadence_rpm", "rider", owner="linkage", partial=True)
    design = replace(paper.with_linkage(**linkage), rider=read_rider(rider, "trt", paper.rider))
    allowed = VARIABLES["cadence_rpm"]
    cadence = design.linkage.cadence
    if "cadence_rpm" in section.content:
        cadence = section.number("cadence_rpm", allowed.low, allowed.high, allowed.allowed) * RPM
    try:
        turning(replace(design, name=f"{section.path}: measured_on"))
    except AssemblyError as error:
        raise InputError(f"{error}; moments cannot have been measured on it") from None
    return ReferenceTricycle(design, cadence)

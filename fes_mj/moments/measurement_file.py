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
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle

_COLUMNS = {"crank": "crank_angle_deg", "knee": "knee_Nm", "hip": "hip_Nm"}
_OTHERS = ("file", "kinematics", "knee_angle", "angle_unit", "zero", "turning", "unit", "extension", "pedal_force")
_SIGNS = {"positive": 1.0, "negative": -1.0}
_SENSES = {"forward": 1.0, "backward": -1.0}
_OF_MOMENTS = ("knee", "hip", "unit", "extension")  # what a file of pedal forces does not have
_OF_THE_CRANK = ("crank", "angle_unit", "zero", "turning")  # what a trial counted by the knee does not have


@dataclass(frozen=True)
class Description:
    """A measurement file, every key checked.

    files: those that it names, moments first. sign: of extension. sense: of the crank angle. zero: where that is, rad
    after top dead centre. scale: N m per unit of the file. knee_angle: its column in the kinematics. pedal_force:
    columns of its components, or none.
    """

    section: Section
    data: list[Path]
    kinematics: list[Path]
    columns: dict[str, str]
    knee_angle: str
    sign: PerJoint[float]
    sense: float
    zero: float
    scale: float
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
        section, measured_on = content.section("moments"), _measured_on(content.section("measured_on"))
        section.only((*_COLUMNS, *_OTHERS))
        section.require(["file"], "it names the file that holds the moments")
        data, kinematics = _paths(section, "file"), _paths(section, "kinematics")
        if kinematics:
            _only_by_knee(section, data, kinematics)
        pedal_force = _pedal_force(section)
        extension = section.section("extension")
        extension.only(JOINTS)
        return cls(
            section,
            data,
            kinematics,
            {key: _word(section, key, default) for key, default in _COLUMNS.items()},
            _word(section, "knee_angle", "knee_angle_r"),
            PerJoint.of(lambda joint: _SIGNS[extension.choice(joint, _SIGNS, "positive")]),
            _SENSES[section.choice("turning", _SENSES, "forward")],
            _zero(section, measured_on),
            _scale(section, content.section("measured_on").section("rider"), measured_on),
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
    return str(section.value(key, default, is_text, "the name of a column"))


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
    """Where the crank angle is zero, rad after top dead centre."""
    value = section.content.get("zero", "tdc")
    if isinstance(value, str):
        named = {"tdc": 0.0, "horizontal": -measured_on.top_dead_centre}
        return named[section.choice("zero", named, "tdc")]
    return math.radians(section.number("zero", -360, 360, '"tdc", "horizontal" or degrees after tdc from -360 to 360'))


def _scale(section: Section, rider: Section, measured_on: ReferenceTricycle) -> float:
    """N m per unit of the file."""
    if section.choice("unit", ("N m", "N m/kg"), "N m") == "N m":
        return 1.0
    rider.require(["mass"], f"{section.label('unit')} is N m/kg: the moments are per kg of the rider's body mass")
    return float(measured_on.design.rider.mass)


def _measured_on(section: Section) -> ReferenceTricycle:
    """The tricycle, rider and cadence: the paper's, with what the file says of its own."""
    section.choice("kind", ("trt",), "trt")
    rider, paper = section.section("rider"), PAPER_TRICYCLE.design
    linkage = read_values(section, "trt", "kind", "cadence_rpm", "rider", owner="linkage", partial=True)
    own = replace(paper.with_linkage(**linkage), rider=read_rider(rider, "trt", paper.rider))
    allowed = VARIABLES["cadence_rpm"]
    cadence = own.linkage.cadence
    if "cadence_rpm" in section.content:
        cadence = section.number("cadence_rpm", allowed.low, allowed.high, allowed.allowed) * RPM
    try:
        turning(replace(own, name=f"{section.path}: measured_on"))
    except AssemblyError as error:
        raise InputError(f"{error}; moments cannot have been measured on it") from None
    return ReferenceTricycle(own, cadence)

"""Options that several commands share, and what they load."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

from cyclopts import Parameter

from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.errors import InputError
from fes_mj.moments import JointMoments, load_moments
from fes_mj.torque_velocity import load_torque_velocity
from fes_mj.units import RPM
from fes_mj.variables import VARIABLES


class Loaded(NamedTuple):
    """What the options of a run name: a design, the joint moments, the cadence in rad/s."""

    design: Design
    moments: JointMoments
    cadence: float


@Parameter(name="*")
@dataclass
class MomentsOptions:
    """Whose joint moments.

    Parameters
    ----------
    group
        Rider group whose recovered joint moments are used (default p1p2).
    moments
        Your own joint moments instead: a CSV with the header crank_angle_deg,knee_Nm,hip_Nm.
    """

    group: Literal["p1p2", "p1p3"] | None = None
    moments: Path | None = None

    def load_moments(self) -> JointMoments:
        """The joint moments that the options name. Raises InputError for what cannot be used."""
        if self.group and self.moments:
            raise InputError("--group and --moments exclude each other; a file of moments is a group of its own")
        return load_moments(self.moments or self.group or "p1p2")


@Parameter(name="*")
@dataclass
class PrintOptions:
    """What is printed.

    Parameters
    ----------
    json
        Print one JSON object and nothing else.
    quiet
        Print nothing but errors.
    """

    json: Annotated[bool, Parameter(negative="")] = False
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False

    @property
    def silent(self) -> bool:
        """Whether neither tables nor progress are shown."""
        return self.json or self.quiet


@Parameter(name="*")
@dataclass
class LoadOptions(MomentsOptions):
    """Options of every command that needs a design in motion.

    Parameters
    ----------
    cadence
        Crank speed in rpm; by default the one at which the tricycle does 5.71 km/h.
    dims
        Dimensions of one of the paper's designs: as identified, or as the paper prints them.
    torque_velocity
        Let joint moments change with joint speed, by Hill's relation; by default they do not, as in the paper.
    """

    cadence: float | None = None
    dims: Literal["identified", "printed"] = "identified"
    torque_velocity: Literal["hill"] | None = None

    def load(self, design: str) -> Loaded:
        """Load everything the options name. Raises InputError for what cannot be used."""
        moments, loaded = self.load_moments(), load_design(design, self.dims)
        if self.torque_velocity:
            moments = replace(moments, torque_velocity=load_torque_velocity(self.torque_velocity))
        return Loaded(loaded, moments, crank_speed(self.cadence, loaded))

    def inputs(self, *designs: str) -> list[Path]:
        """The files that a command with these options and designs reads, which none of its outputs may replace."""
        return [Path(source) for source in (*designs, self.moments) if source]


@Parameter(name="*")
@dataclass
class RunOptions(PrintOptions, LoadOptions):
    """Options of every command that runs a design.

    Parameters
    ----------
    verbose
        Print more: energies and joint forces.
    """

    verbose: Annotated[bool, Parameter(alias="-v", negative="")] = False


def crank_speed(cadence: float | None, design: Design) -> float:
    """Crank speed in rad/s of a --cadence in rpm, by default the design's own."""
    allowed = VARIABLES["cadence_rpm"]
    if cadence is not None:
        if not allowed.accepts(cadence):
            raise InputError(f"--cadence is {cadence:g}; it must be {allowed.allowed}")
        return cadence * RPM
    own = design.linkage.cadence / RPM
    if not allowed.accepts(own):
        raise InputError(
            f"{design.name}: linkage.gear_ratio is {design.linkage.gear_ratio:g}, which makes {own:.3g} rpm at the "
            f"tricycle's speed; it must be {allowed.allowed}: change the ratio or give --cadence"
        )
    return design.linkage.cadence

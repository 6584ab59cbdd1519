"""Options that several commands share, and what they load."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

from cyclopts import Parameter

from fes_mj.common.console import complain
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.variables import VARIABLES
from fes_mj.moments.files import load_moments, measured_files
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_velocity import load_torque_velocity


class Range(NamedTuple):
    """What an option may be."""

    low: float
    high: float
    what: str

    def require(self, option: str, value: float) -> None:
        """Raise InputError for a value that is not in it."""
        if not self.low <= value <= self.high:
            raise InputError(f"--{option} is {value:g}; it must be {self.what} from {self.low:g} to {self.high:g}")


LAG = Range(0, 1, "a time in s")


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
        Your own joint moments instead: a CSV with the header crank_angle_deg,knee_Nm,hip_Nm (crank angle from top
        dead centre), or a measurement file (.toml). With two legs given twice, the right leg's first.
    """

    group: Literal["p1p2", "p1p3"] | None = None
    # a name may begin like a JSON list
    moments: Annotated[list[Path] | None, Parameter(json_list=False, negative="")] = None

    def load_moments(self, legs: int = 1) -> JointMoments:
        """The joint moments that the options name; says what looks misread. Raises InputError for what is unusable."""
        if self.group and self.moments:
            raise InputError("--group and --moments exclude each other; a file of moments is a group of its own")
        files = [*map(str, self.moments or ()), *([] if self.moments else [self.group or "p1p2"])]
        if len(files) > legs:
            raise InputError(
                f"--moments is given {len(files)} times; one file serves every leg, two are the right and the left "
                "leg's: with simulate --legs 2"
            )
        moments = load_moments(*files)
        warn_of(moments)
        return moments

    def moment_files(self) -> list[Path]:
        """The files that are read for them."""
        return [file for path in self.moments or () for file in measured_files(path)]


@Parameter(name="*")
@dataclass
class PrintOptions:
    """What is printed.

    Parameters
    ----------
    json
        Print one JSON object and nothing else.
    quiet
        Print nothing but errors and warnings.
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

    def load(self, design: str, legs: int = 1) -> Loaded:
        """Load everything the options name. Raises InputError for what cannot be used."""
        moments, loaded = self.load_moments(legs), load_design(design, self.dims)
        if self.torque_velocity:
            moments = moments.at_speed(load_torque_velocity(self.torque_velocity))
        return Loaded(loaded, moments, crank_speed(self.cadence, loaded))

    def inputs(self, *designs: str) -> list[Path]:
        """The files that a command with these options and designs reads, which none of its outputs may replace."""
        return [*map(Path, designs), *self.moment_files()]


@Parameter(name="*")
@dataclass
class RunOptions(PrintOptions, LoadOptions):
    """Options of every command that runs a design.

    Parameters
    ----------
    verbose
        Print more: energies, joint forces, the whole error budget.
    """

    verbose: Annotated[bool, Parameter(alias="-v", negative="")] = False


def warn_of(moments: JointMoments) -> None:
    """Say on standard error what looks misread in joint moments."""
    for each in moments.misreadings:
        complain(f"{moments.name}: {each.text}")
    if moments.left:
        warn_of(moments.left)


PICTURES = (".png", ".svg")


def require_picture(plot: Path) -> None:
    """Raise InputError unless the name says which kind of picture."""
    if plot.suffix.lower() not in PICTURES:
        raise InputError(f"{plot}: cannot write the plot: the name must end in {' or '.join(PICTURES)}")


def require_lag(lag: float, design: Design, cadence: float) -> None:
    """Raise InputError for a lag (s) that is none or takes a turn of the crank (rad/s) or more."""
    LAG.require("lag", lag)
    turn = 2 * math.pi / cadence
    if lag >= turn:
        raise InputError(
            f"--lag is {lag:g}; it must be shorter than a turn of the crank, which takes {turn:.3g} s in "
            f"{design.name} at {cadence / RPM:.4g} rpm: no stimulation can lead a muscle by more"
        )


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

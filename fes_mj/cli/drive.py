"""What drives the legs: joint moments that belong to joint angles, or muscles that are stimulated."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

from cyclopts import Group, Parameter

from fes_mj.cli.options import DRIVEN_BY, WHOSE, LoadOptions, MomentsOptions, needs, speed_at
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, design_path, load_design
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.timing import DUTIES, DUTY, is_duty
from fes_mj.statics.drive import Drive, driven_speed
from fes_mj.statics.muscle_static import MuscleStatic

if TYPE_CHECKING:
    from fes_mj.verification.case import VerificationCase


class Driven(NamedTuple):
    """What the options of a run name: a design, what drives it, the cadence in rad/s."""

    design: Design
    drive: Drive
    cadence: float


_MUSCLES = Group("Muscles", validator=needs("--drive", "muscles"))


def _share(_: object, duty: float) -> None:
    if not is_duty(duty):
        raise ValueError(f"It must be {DUTIES}.")


@Parameter(name="*", group=_MUSCLES)
@dataclass
class DriveOptions:
    """What drives the legs.

    Args:
        drive: Joint moments that belong to joint angles, as in the paper, or stimulated muscles.
        timing: When muscles are stimulated: best in expectation, as in the measurement, or as the joint angles say;
            by-angle is the paper's rule, in which the moments of the measurement belong to the joint angles.
        duty: Largest share of the turn in which a muscle group is stimulated: 0.222 for windows of at most 80 deg.
        muscles: An ensemble of riders (.npz) instead of the group's.
    """

    drive: Annotated[Literal["moments", "muscles"], Parameter(group=(_MUSCLES, DRIVEN_BY))] = "moments"
    timing: Literal["best", "measured", "by-angle", "stimulation-by-angle"] = "best"
    duty: Annotated[float, Parameter(validator=_share, show_default=lambda share: f"{360 * share:.0f}/360")] = DUTY
    muscles: Annotated[Path | None, Parameter(group=(_MUSCLES, WHOSE, DRIVEN_BY))] = None

    def inputs(self, options: MomentsOptions, *designs: str) -> list[Path]:
        """The files that a command with these options and designs reads, which none of its outputs may replace."""
        return [*options.inputs(*designs), *([self.muscles] if self.muscles else [])]

    def load_riders(self, options: MomentsOptions) -> Riders:
        """Whose muscles. Raises InputError for a file that has none."""
        return load_riders(self.muscles or options.group or "p1p2")

    def load_muscles(self, options: MomentsOptions) -> Muscles:
        """Whose muscles, and when they are stimulated. Raises InputError as load_riders."""
        return Muscles(self.load_riders(options), self.timing, self.duty)

    def load(self, options: LoadOptions, name: str) -> Driven:
        """Everything the options name. Raises InputError for what cannot be used."""
        if self.drive == "moments":
            return Driven(*options.load(name))
        design = load_design(name, options.dims)
        return Driven(design, self.load_muscles(options), speed_at(options.cadence, design))

    def solve(self, options: LoadOptions, name: str) -> MuscleStatic:
        """A design driven by muscles. Raises InputError as load_muscles."""
        design, muscles = load_design(name, options.dims), self.load_muscles(options)
        speed = speed_at(options.cadence, design)
        return MuscleStatic.solve(design, muscles.riders, speed, muscles.timing, muscles.duty, options.legs)

    def case(self, options: LoadOptions, name: str, **more: Any) -> "VerificationCase":
        """The case of one leg, valid for all legs that are asked for. Raises InputError for what cannot be used.

        more: of VerificationCase.
        """
        from fes_mj.paper.printed import table1
        from fes_mj.verification.case import VerificationCase

        loaded = self.load(options, name)
        driven_speed(*loaded, options.legs)
        printed = table1()[name] if name in DESIGNS and options.dims == "identified" else None
        return VerificationCase(*loaded, expected=printed, file=design_path(name, options.dims), **more)


@Parameter(name="*")
@dataclass
class MusclesFirst(DriveOptions):
    """The same where muscles drive unless moments are asked for."""

    drive: Annotated[Literal["moments", "muscles"], Parameter(group=(_MUSCLES, DRIVEN_BY))] = "muscles"

"""Options that several commands share, and what they load."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias
from urllib.parse import urlsplit

from cyclopts import Argument, ArgumentCollection, Group, Parameter
from cyclopts.validators import Number, all_or_none, mutually_exclusive

from fes_mj.common.console import complain, print_json, say
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.variables import VARIABLES, crank_speed
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.friction import Bearings


def bounds(variable: str) -> Callable[[Any, Any], None]:
    """A validator with the bounds that a design variable has in files, in words with its unit."""
    allowed = VARIABLES[variable]

    def check(_: Any, value: Any) -> None:
        numbers = value if isinstance(value, Sequence) else [value]
        if not all(allowed.accepts(number) for number in numbers if number is not None):
            raise ValueError(f"It must be {allowed.allowed}.")

    return check


def value_of(argument: Argument) -> Any:
    """Of an option, its default where it is not given."""
    return argument.value if argument.tokens else argument.field_info.default


def needs(flag: str, *values: str) -> Callable[[ArgumentCollection], None]:
    """A validator of a group whose options mean nothing without one of them, or unless it has one of some values."""

    def check(arguments: ArgumentCollection) -> None:
        value = next(value_of(argument) for argument in arguments if argument.name == flag)
        if value in values if values else value:
            return
        for argument in arguments:
            if argument.tokens and argument.name != flag:
                option = _given(argument.name, argument.value)
                raise ValueError(f"{option} needs {' '.join([flag, ' or '.join(values)]).rstrip()}.")

    return check


def _given(flag: str, value: object) -> str:
    """An option as it was given; value: True or text of what has no value."""
    values = value if isinstance(value, (list, tuple)) else [value]
    return " ".join([flag, *(str(part) for part in values if part is not True)])


def changed(options: object, *but: str) -> dict[str, Any]:
    """Options of a dataclass, by flag, that are not as they are by default."""
    defaults = {field.name: field.default for field in fields(options)}  # type: ignore[arg-type]
    return {
        f"--{name.replace('_', '-')}": value
        for name, value in vars(options).items()
        if name not in but and value != defaults[name]
    }


def refuse_beside(flag: str, others: Mapping[str, object]) -> None:
    """Raise InputError if an option is given that has no effect beside `flag`; others: None, False or () if not."""
    for name, value in others.items():
        if value is not None and value is not False and value != ():
            raise InputError(f"{_given(name, value)} and {flag} exclude each other; leave out one of them")


def _tcp(_: object, address: str | None) -> None:
    """Refuse what is no tcp://host:port: Dask takes it for something else, and may wait for it."""
    if address is None:
        return
    try:
        parts = urlsplit(address)
        host = (parts.hostname or "").encode("idna")
        sound = bool(host) and bool(parts.port) and address == f"tcp://{parts.netloc}" and "@" not in address
    except ValueError:
        sound = False
    if not sound:
        raise ValueError("No Dask scheduler has such an address; give tcp://host:port as `dask scheduler` prints it.")


DESIGN_HELP = (
    "Of the paper trt, the traditional recumbent tricycle (four-bar), r1 or r2, a crank-rocker tricycle (CRT), d1 or "
    "d2, a coupler-driven one (CDT); or a path to a design file."
)
DesignName: TypeAlias = Annotated[str, Parameter(help=DESIGN_HELP)]
Flag: TypeAlias = Annotated[bool, Parameter(negative="")]
Out: TypeAlias = Annotated[Path, Parameter(name=["--out", "-o"])]
Cadence: TypeAlias = Annotated[float, Parameter(validator=bounds("cadence_rpm"))]
LegCount: TypeAlias = Literal[1, 2]
Dims: TypeAlias = Annotated[
    Literal["identified", "printed"],
    Parameter(help="Dimensions of one of the paper's designs: as identified, or as the paper prints them."),
]
Seed: TypeAlias = Annotated[int, Parameter(validator=Number(gte=0))]
_WORKERS = Group("jobs or cluster", show=False, validator=mutually_exclusive)
Jobs: TypeAlias = Annotated[int, Parameter(group=("Parameters", _WORKERS), validator=Number(gte=1))]
Cluster: TypeAlias = Annotated[str, Parameter(group=("Parameters", _WORKERS), validator=_tcp)]
PeopleOfEachSex: TypeAlias = Annotated[int, Parameter(validator=Number(gte=10, lte=100_000))]
_MOMENTS = Group("Joint moments")


def _no_muscles(arguments: ArgumentCollection) -> None:
    """A validator: own moments say nothing of muscles."""
    values = {argument.name: value_of(argument) for argument in arguments}
    if values.get("--drive") == "muscles" and values.get("--moments") and not values.get("--muscles"):
        raise ValueError(
            f"--moments say nothing of muscles; `fes_mj moments {values['--moments'][0]} --fit-muscles -o RIDER.npz` "
            "finds muscles that may have given them, for --muscles RIDER.npz"
        )


WHOSE = Group("joint moments or muscles", show=False, validator=mutually_exclusive)
DRIVEN_BY = Group("what drives", show=False, validator=_no_muscles)


@Parameter(name="*")
@dataclass
class MomentsOptions:
    """Whose joint moments.

    Args:
        group: Rider group whose recovered joint moments are used: p1p2 (default), three quarters of those measured, who
            push in the first two phases of the turn, or p1p3, the others.
        moments: Your own joint moments instead: a CSV with the header crank_angle_deg,knee_Nm,hip_Nm (crank angle from
            top dead centre), or a measurement file (.toml). With two legs given twice, the right leg's first.
    """

    group: Annotated[Literal["p1p2", "p1p3"] | None, Parameter(group=(_MOMENTS, WHOSE))] = None
    # a name may begin like a JSON list
    moments: Annotated[
        list[Path] | None, Parameter(group=(_MOMENTS, WHOSE, DRIVEN_BY), json_list=False, negative="")
    ] = None

    def load_moments(self, legs: int = 1) -> JointMoments:
        """The joint moments that the options name; says what looks misread. Raises InputError for what is unusable."""
        files = [*map(str, self.moments or ()), *([] if self.moments else [self.group or "p1p2"])]
        if len(files) > legs:
            raise InputError(
                f"--moments is given {len(files)} times; one file serves every leg, two are the right and the left "
                "leg's: with --legs 2"
            )
        moments = load_moments(*files)
        warn_of(moments)
        return moments

    def inputs(self, *designs: str) -> list[Path]:
        """The files that a command with these options and designs reads, which none of its outputs may replace."""
        if not self.moments:
            return [*map(Path, designs)]
        from fes_mj.moments.measurement import measured_files  # much to read for those who have none

        return [*map(Path, designs), *(file for path in self.moments for file in measured_files(path))]


@Parameter(name="*")
@dataclass
class PrintOptions:
    """What is printed.

    Args:
        json: Print one JSON object and nothing else.
        quiet: Print nothing but errors and warnings.
    """

    json: Flag = False
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False

    @property
    def silent(self) -> bool:
        """Whether neither tables nor progress are shown."""
        return self.json or self.quiet

    def show(
        self,
        content: Callable[[], Mapping[str, Any]],
        tables: Callable[[], None],
        **files: Path | Sequence[Path] | None,
    ) -> None:
        """Print the result as JSON, or as tables with the names of what was written."""
        if self.json:
            print_json(content())
        elif not self.quiet:
            tables()
            self.name_files(**files)

    def name_files(self, **files: Path | Sequence[Path] | None) -> None:
        """Say where what was written is, unless JSON or nothing is printed."""
        for content, paths in files.items() if not self.silent else ():
            for path in [paths] if isinstance(paths, Path) else paths or ():
                say(f"{content.replace('_', ' ')}: {path}")


@Parameter(name="*")
@dataclass
class LoadOptions(MomentsOptions):
    """Options of every command that needs a design in motion.

    Args:
        cadence: Crank speed in rpm; by default the one at which the tricycle does 5.71 km/h.
        legs: One leg, or two half a turn apart on the same crank.
    """

    cadence: Cadence | None = None
    legs: LegCount = 1
    dims: Dims = "identified"

    def load(self, design: str) -> tuple[Design, JointMoments, float]:
        """The design, the joint moments, the cadence in rad/s. Raises InputError for what cannot be used."""
        moments, loaded = self.load_moments(self.legs), load_design(design, self.dims)
        return loaded, moments, speed_at(self.cadence, loaded)


@Parameter(name="*")
@dataclass
class VerboseOptions(PrintOptions):
    """What is printed, and how much.

    Args:
        verbose: Print more: every check, energies, joint forces, the whole error budget.
    """

    verbose: Annotated[bool, Parameter(alias="-v", negative="")] = False


@Parameter(name="*")
@dataclass
class RunOptions(VerboseOptions, LoadOptions):
    """Options of every command that runs a design."""


_BEARINGS = Group("Bearings", validator=all_or_none)


@Parameter(name="*")
@dataclass
class BearingOptions:
    """Friction in the linkage's bearings; by default there is none.

    Args:
        bearing_friction: Coefficient of friction: about 0.1 of plain bearings, 0.002 of rolling ones.
        pin_radius: Radius at which it acts, m: that of the pins.
    """

    bearing_friction: Annotated[float | None, Parameter(group=_BEARINGS, validator=Number(gte=0, lte=1))] = None
    pin_radius: Annotated[float | None, Parameter(group=_BEARINGS, validator=Number(gt=0, lte=0.1))] = None

    def load(self) -> Bearings | None:
        """The bearings that they describe, if any."""
        if self.bearing_friction is None or self.pin_radius is None:
            return None
        return Bearings(self.bearing_friction, self.pin_radius)


def warn_of(moments: JointMoments) -> None:
    """Say on standard error what looks misread in joint moments."""
    for misreading in moments.misreadings:
        complain(f"{moments.name}: {misreading.text}")
    if moments.left:
        warn_of(moments.left)


def speed_at(cadence: float | None, design: Design) -> float:
    """Crank speed in rad/s of a --cadence in rpm, by default the design's own."""
    return crank_speed(design, None if cadence is None else cadence * RPM)

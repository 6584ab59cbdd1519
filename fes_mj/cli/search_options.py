"""Options of `fes_mj optimize`: what is searched for, how, and by which limits."""

from __future__ import annotations

import os
import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Group, Parameter
from cyclopts.validators import Number, mutually_exclusive

from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import (
    Cluster,
    Flag,
    Jobs,
    MomentsOptions,
    PeopleOfEachSex,
    PrintOptions,
    Seed,
    needs,
    refuse_beside,
)
from fes_mj.common.errors import require_extra
from fes_mj.common.provenance import provenance
from fes_mj.linkage.riders import PEOPLE_PER_SEX
from fes_mj.muscles.rules import BEST

if TYPE_CHECKING:
    from fes_mj.optimization.problem import ProblemOptions

Methods = Literal["differential-evolution", "cma-es", "nsga-ii", "random-pursuit"]
_Speed = Annotated[float, Parameter(validator=Number(gt=0))]
_START, _SPEEDS = (Group(f"like or {name}", show=False, validator=mutually_exclusive) for name in ("start", "speeds"))
_BUILD = Group("What can be built", validator=needs("--limits", "buildable"))
_FRONT = Group("front", show=False, validator=needs("--method", "nsga-ii"))
_SEARCHES = Group(
    "searches", show=False, validator=needs("--method", "differential-evolution", "cma-es", "random-pursuit")
)
_PEOPLE = Group("People", validator=needs("--riders", "population", "population-p10"))
_PACKAGES = {"cma-es": "cma", "nsga-ii": "pymoo"}
_WITHOUT_EFFECT = ("json", "quiet", "jobs", "cluster", "print_problem")  # on what is found


@Parameter(name="*")
@dataclass
class SearchOptions(PrintOptions, MomentsOptions):
    """Options of a search.

    Args:
        drive: What drives the legs.
        method: The method; cma-es and nsga-ii come with the extra `optimize`, and nsga-ii weighs both groups.
        budget: Evaluations of each search (default 50,000, with --drive muscles 3,000; random pursuit stops by itself).
        searches: Independent searches, of which the best counts (nsga-ii makes one).
        seed: Of the random numbers; the same seed finds the same design, however many jobs.
        like: Your own design (trt, r1, ..., or a file): its rider, seat, place and cadence, its joint speeds as limits,
            and the start if it is of the kind; takes the place of --start and --speeds-of.
        start: A design to start from (trt, r1, ..., or a file); by default random ones. If it does not keep the
            limits, the nearest that does.
        speeds_of: The design whose mean joint speeds are the limits, and whose power is compared.
        knee_speed_limit: Largest mean absolute knee speed in deg/s instead (107.1 in the TRT).
        hip_speed_limit: Largest mean absolute hip speed in deg/s instead (69.1 in the TRT).
        ripple_limit: Largest ripple of the crank speed in %, (largest - smallest) / mean, on a tricycle with two legs
            and fixed gear.
        caution: Take so many standard deviations of the gain off it: finds designs that win for sure (not with
            --moments).
        riders: Whose power counts: the design's own rider's, or that of a sample of people, each with the seat moved
            within the limits of `fes_mj fit`: in the mean (population), or what 9 of 10 have (population-p10).
        samples: People of each sex.
        sample_seed: Of the sample's random numbers.
        smooth: With nsga-ii: also the least coefficient of fluctuation.
        problem: Your own limits, search ranges and design space: an edited copy of optimization.toml.
        limits: Those of what can be built beside the paper's (buildable), or the paper's alone (paper).
        transmission_angle_min: Smallest transmission angle, deg, instead of the problem file's (30).
        hole_distance_min: Least distance of two holes in a link, m (0.025).
        pin_force_max: Largest force on a pin, N, riding with masses (1500).
        hip_swing_min: Least swing of the hip, deg (5).
        extrapolated_max: Largest share of the turn outside the moments' range (0).
        clearance_min: Least clearance of what moves, m (0.005).
        print_problem: Print the problem that is solved, as a problem file with comments, and solve nothing.
        jobs: Processes; each search is a task.
        cluster: Dask scheduler, tcp://host:port, to send the searches to.
    """

    drive: DriveOptions = field(default_factory=DriveOptions)
    method: Annotated[Methods, Parameter(group=("Parameters", _FRONT, _SEARCHES))] = "differential-evolution"
    budget: Annotated[int | None, Parameter(validator=Number(gte=1000))] = None
    searches: Annotated[int, Parameter(group=("Parameters", _SEARCHES), validator=Number(gte=1))] = 4
    seed: Seed = 0
    like: Annotated[str | None, Parameter(group=("Parameters", _START, _SPEEDS))] = None
    start: Annotated[str | None, Parameter(group=("Parameters", _START))] = None
    speeds_of: Annotated[str, Parameter(group=("Parameters", _SPEEDS))] = "trt"
    knee_speed_limit: _Speed | None = None
    hip_speed_limit: _Speed | None = None
    ripple_limit: Annotated[float | None, Parameter(validator=Number(gt=0, lte=200))] = None
    caution: Annotated[float, Parameter(validator=Number(gte=0, lte=10))] = 0.0
    riders: Annotated[Literal["one", "population", "population-p10"], Parameter(group=_PEOPLE)] = "one"
    samples: Annotated[PeopleOfEachSex, Parameter(group=_PEOPLE)] = PEOPLE_PER_SEX
    sample_seed: Annotated[Seed, Parameter(group=_PEOPLE)] = 0
    smooth: Annotated[bool, Parameter(group=("Parameters", _FRONT), negative="")] = False
    problem: Path | None = None
    limits: Annotated[Literal["buildable", "paper"], Parameter(group=_BUILD)] = "buildable"
    transmission_angle_min: Annotated[float | None, Parameter(group=_BUILD, validator=Number(gte=0, lte=90))] = None
    hole_distance_min: Annotated[float | None, Parameter(group=_BUILD, validator=Number(gte=0, lte=1))] = None
    pin_force_max: Annotated[float | None, Parameter(group=_BUILD, validator=Number(gt=0))] = None
    hip_swing_min: Annotated[float | None, Parameter(group=_BUILD, validator=Number(gte=0, lte=180))] = None
    extrapolated_max: Annotated[float | None, Parameter(group=_BUILD, validator=Number(gte=0, lte=1))] = None
    clearance_min: Annotated[float | None, Parameter(group=_BUILD, validator=Number(lte=1))] = None
    print_problem: Flag = False
    jobs: Jobs = 1
    cluster: Cluster | None = None

    def check(self) -> None:
        """Refuse what cannot be asked for together, and a missing package, before anything runs."""
        people = None if self.riders == "one" else self.riders
        caution, muscles = self.caution or None, self.drive.drive == "muscles"
        if self.method == "nsga-ii":  # weighs the powers of both groups
            refuse_beside("--method nsga-ii", {"--caution": caution, "--riders": people, "--drive muscles": muscles})
        if caution:  # needs the error bars of one group's recovered moments
            refuse_beside(f"--caution {caution:g}", {"--moments": self.moments, "--riders": people})
        if muscles:
            timing = None if self.drive.timing == BEST else self.drive.timing
            others = {"--timing": timing, "--caution": caution, "--ripple-limit": self.ripple_limit}
            refuse_beside("--drive muscles", others)
            self.drive.load_riders(self)
        if self.limits == "buildable":
            require_extra("build", "shapely")
        if self.method in _PACKAGES:
            require_extra("optimize", _PACKAGES[self.method])

    @property
    def overrides(self) -> dict[str, float]:
        """Limits of what can be built that options give, by key of a problem file."""
        from fes_mj.optimization.buildable import KEYS

        return {key: value for key in KEYS if (value := getattr(self, key)) is not None}

    def problem_options(self) -> ProblemOptions:
        """What they ask of the problem, as make_problem takes it."""
        from fes_mj.optimization.limits import DEFAULT
        from fes_mj.optimization.people import ONE_RIDER, sampled
        from fes_mj.optimization.stimulated import MuscleDrive

        by_muscles = self.drive.drive == "muscles"
        return {
            "compared_with": self.speeds_of,
            "start": self.start,
            "like": self.like,
            "build": None if self.limits == "paper" else self.overrides,
            "limits": self.problem or DEFAULT,
            "knee_speed": self.knee_speed_limit,
            "hip_speed": self.hip_speed_limit,
            "caution": self.caution,
            "ripple": None if self.ripple_limit is None else self.ripple_limit / 100,
            "people": ONE_RIDER if self.riders == "one" else sampled(self.riders, self.samples, self.sample_seed),
            "muscles": MuscleDrive(self.drive.load_riders(self), self.drive.duty) if by_muscles else None,
        }

    def inputs(self, *designs: str) -> list[Path]:
        """The files that the options name, which no output may replace."""
        named = [name for name in (self.like, self.start, self.speeds_of) if name]
        return [*([self.problem] if self.problem else []), *super().inputs(*designs, *named)]

    def command(self, kind: str) -> str:
        """The command line, for a shell, that finds the same again with this version: what is not by default."""
        words, options, defaults = ["fes_mj", "optimize", kind], vars(self) | vars(self.drive), SearchOptions()
        usual = vars(defaults) | vars(defaults.drive)
        for name, value in options.items():
            if name in _WITHOUT_EFFECT or value == usual[name]:
                continue
            text = value[0] if isinstance(value, list) else value  # the one file of moments
            words.append(f"--{name.replace('_', '-')}" + ("" if value is True else f"={text}"))
        return " ".join(map(shell_word, words))

    def recipe(self, kind: str) -> dict[str, Any]:
        """What the outcome depends on beside the problem: the command and the versions of what carries it out."""
        packages = [_PACKAGES[self.method]] if self.method in _PACKAGES else []
        return provenance(packages=packages) | {"command": self.command(kind)}


def shell_word(word: str) -> str:
    r"""A word as a shell takes it on one line: bytes of what cannot be printed as $'\xe9'."""
    if word.isprintable():
        return shlex.quote(word)
    plain = range(ord(" "), 127)
    escaped = (chr(byte) if byte in plain and byte not in b"'\\" else f"\\x{byte:02x}" for byte in os.fsencode(word))
    return f"$'{''.join(escaped)}'"

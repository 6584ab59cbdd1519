"""`fes_mj fit`: the seat for a rider, and who of a population can ride."""

import math
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Group, Parameter
from cyclopts.validators import Number, all_or_none, mutually_exclusive

from fes_mj.budget.answer import Answer, answer
from fes_mj.cli.answers import FOR_A_RIDER
from fes_mj.cli.options import (
    Cadence,
    DesignName,
    Dims,
    LegCount,
    MomentsOptions,
    Out,
    PeopleOfEachSex,
    PrintOptions,
    Seed,
    bounds,
    changed,
    needs,
    refuse_beside,
    speed_at,
)
from fes_mj.cli.tables import or_dash, print_notes, span
from fes_mj.common.console import conclude, print_table, progress_bar, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.text import printable
from fes_mj.common.units import RPM
from fes_mj.common.writing import require_writable, write_text
from fes_mj.fit.population import FIT_STEPS, GRADES, PopulationFit, fit_population
from fes_mj.fit.seat import SeatFit, fit_seat, seat_text
from fes_mj.fit.seats import SeatLimits
from fes_mj.linkage.design import Design, Rider
from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.linkage.riders import PEOPLE_PER_SEX, populations
from fes_mj.muscles.riders import load_riders

_OF_RIDER, _OF_SEAT = Group("Rider"), Group("Seat")
_LEG = Group("legs, thigh and shank", show=False, validator=all_or_none)
_WHO = Group("a rider, one of", show=False, validator=mutually_exclusive)
_PEOPLE = Group("people", show=False, validator=needs("--sex", "male", "female"))


def _ascending(_: object, ends: tuple[float, float]) -> None:
    if ends[0] > ends[1]:
        raise ValueError("An empty range; give the smaller number first.")


def _range(low: float, high: float) -> Parameter:
    return Parameter(group=_OF_SEAT, negative="", validator=(Number(gte=low, lte=high), _ascending))


_Metres = Annotated[tuple[float, float], _range(-1, 1)]
_Degrees = Annotated[tuple[float, float], _range(-90, 90)]


@Parameter(name="*")
@dataclass
class RiderOptions:
    """Who rides: by default the design's own rider.

    Args:
        thigh: Thigh in m, from hip to knee; with --shank.
        shank: Shank in m as in design files, from the knee to the level of the pedal axle: to the ankle and 10.5 cm
            more.
        stature: Stature in m instead, for legs of the median's proportions; with --sex.
        percentile: Percentile of thigh, shank and mass instead, above 0 and below 100; with --sex.
        sex: Whose statures or percentiles.
    """

    thigh: Annotated[float | None, Parameter(group=(_OF_RIDER, _LEG, _WHO), validator=bounds("thigh"))] = None
    shank: Annotated[float | None, Parameter(group=(_OF_RIDER, _LEG), validator=bounds("shank"))] = None
    stature: Annotated[float | None, Parameter(group=(_OF_RIDER, _WHO, _PEOPLE))] = None
    percentile: Annotated[float | None, Parameter(group=(_OF_RIDER, _WHO, _PEOPLE), validator=Number(gt=0, lt=100))] = (
        None
    )
    sex: Annotated[Literal["male", "female"] | None, Parameter(group=(_OF_RIDER, _PEOPLE))] = None

    def load(self, design: Design) -> Rider:
        """The rider that the options describe. Raises InputError for what contradicts itself and for nobody."""
        if self.thigh is not None and self.shank is not None:
            return replace(design.rider, thigh=self.thigh, shank=self.shank)
        if self.sex is None:
            return design.rider
        if self.stature is None and self.percentile is None:
            raise InputError(f"--sex {self.sex} needs --stature or --percentile")
        people = next(people for people in populations().values() if people.sex == self.sex)
        if self.percentile is not None:
            return people.rider(self.percentile)
        low, high = people.statures
        if self.stature is None or not low <= self.stature <= high:
            raise InputError(f"--stature is {self.stature:g}; it must be from {low:.2f} to {high:.2f} in metres")
        return people.of_stature(self.stature)


@Parameter(name="*")
@dataclass
class SeatOptions:
    """How far the seat moves from where it is drawn: least and most of each.

    Args:
        forward: Towards the crank, m.
        up: In height, m.
        recline: Change of the seat angle, deg.
    """

    forward: _Metres = (-0.05, 0.30)
    up: _Metres = (-0.15, 0.15)
    recline: _Degrees = (-20.0, 20.0)

    def load(self) -> SeatLimits:
        """The limits."""
        return SeatLimits(self.forward, self.up, (math.radians(self.recline[0]), math.radians(self.recline[1])))


_POPULATION = Group("Population", validator=needs("--population"))


def fit(
    design: DesignName,
    /,
    *,
    who: RiderOptions = RiderOptions(),
    seat: SeatOptions = SeatOptions(),
    moments: MomentsOptions = MomentsOptions(),
    options: PrintOptions = PrintOptions(),
    cadence: Cadence | None = None,
    legs: LegCount = 1,
    dims: Dims = "identified",
    out: Out | None = None,
    population: Annotated[bool, Parameter(group=_POPULATION, negative="")] = False,
    samples: Annotated[PeopleOfEachSex, Parameter(group=_POPULATION)] = PEOPLE_PER_SEX,
    seed: Annotated[Seed, Parameter(group=_POPULATION)] = 0,
    plot: Annotated[Path | None, Parameter(group=_POPULATION)] = None,
) -> None:
    """Find the seat with which a rider can ride a design, joints within their moments' range, with the most power.

    That no seat within the limits suits is a result as well: what lacks, where in the turn, and what would help.

    Args:
        cadence: Crank speed in rpm for which the seat is sought; by default the one at which the tricycle does 5.71
            km/h.
        legs: One leg, or two, which may have moments of their own: the right leg's and the left leg's.
        out: The design file to write (.toml): the rider, and the seat where it was moved to.
        population: Instead of one rider a sample of men and women: who can ride, with which power.
        samples: People of each sex.
        seed: Of the random numbers.
        plot: A picture (.png) of the power over thigh and shank.
    """
    loaded, joint_moments, limits = load_design(design, dims), moments.load_moments(legs), seat.load()
    inputs, ratio = moments.inputs(design), loaded.linkage.gear_ratio
    # with another gear ratio the crank has the cadence at the speed of the tricycle
    loaded = loaded.with_linkage(gear_ratio=ratio * speed_at(cadence, loaded) / loaded.linkage.cadence)
    if population:
        refuse_beside("--population", {"--out": out, **changed(who)})
        if plot:
            require_extra("report", "matplotlib")
        require_writable(plot, "the picture", ".png", inputs)
        with progress_bar(f"{loaded.name}, riders", FIT_STEPS, options.silent) as advance:
            people = fit_population(
                loaded, joint_moments, limits=limits, samples=samples, seed=seed, done=lambda: advance(1)
            )
        _show_population(people, plot, options)
    else:
        require_writable(out, "the design", ".toml", inputs)
        riders = None if moments.moments else load_riders(moments.group or "p1p2")
        seated = fit_seat(loaded, who.load(loaded), joint_moments, limits)
        powers = Answer(seated.design)
        if seated.static:
            powers = answer(seated.design, seated.static.turns, riders, cadence and cadence * RPM)
        _show_seat(seated, powers, ratio, out, options)


def _show_seat(result: SeatFit, powers: Answer, gear_ratio: float, out: Path | None, options: PrintOptions) -> None:
    """Write the design, if the rider fits, geared as it was given; print the result."""
    written = out if result.fits else None
    if written:
        write_text(written, design_toml(result.design.with_linkage(gear_ratio=gear_ratio), _origin(result)))
    options.show(
        lambda: result.summary() | powers.summary() | {"design_file": written and str(written)},
        lambda: _print(result, powers),
        design_file=written,
    )


def _origin(result: SeatFit) -> str:
    """Comment of the design file."""
    rider = result.rider
    return printable(
        f"{result.drawn.name} with the seat moved by fes_mj {version('fes-mj')} ({result.moments.name}) for a thigh of "
        f"{100 * rider.thigh:.1f} and a shank of {100 * rider.shank:.1f} cm: {seat_text(result.seat)}."
    )


def _print(result: SeatFit, powers: Answer) -> None:
    summary, rider = result.summary(), result.rider
    legs = f"thigh {100 * rider.thigh:.1f}, shank {100 * rider.shank:.1f} cm, {rider.mass:.1f} kg"
    rows = [("seat", seat_text(result.seat)), ("seat angle, deg", f"{summary['seat_angle_deg']:.1f}")]
    if result.static:
        rows += [
            ("mean crank power as the paper assumes, W", f"{summary['power_mean_W']:.2f}"),
            ("with the seat as drawn, W", or_dash(summary["power_unmoved_W"], ".2f", "does not turn")),
            ("the paper's rider, seat as drawn, W", or_dash(summary["power_paper_rider_W"], ".2f", "does not turn")),
            *((f"{joint} angle, deg", span(ends)) for joint, ends in result.static.first.joint_range_deg.items()),
        ]
        if powers.rider_power:
            rows.insert(5, (f"{FOR_A_RIDER} (5 to 95 %)", powers.rider_power.text(1)))
    print_table(f"{result.drawn.name}; {result.moments.name}; {legs}", ("", "best seat"), rows)
    if powers.missing:
        say(f"for a rider: {powers.missing}")
    if result.static:
        for turn in result.static.turns:
            print_notes(turn)
        for name in result.ends:
            say(f"note: the seat is at the end of its range {name} (--{name}): a wider one may suit better")
        conclude(True, "Fits", ".")
    else:
        conclude(False, "Does not fit", f": {result.why}.")
        for change in summary["helps"]:
            say(f"it would with {change}")


def _show_population(people: PopulationFit, plot: Path | None, options: PrintOptions) -> None:
    if plot:
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.people import population_figure

        write_figure(plot, population_figure, [people])
    summary = people.summary()
    options.show(lambda: summary, lambda: _print_population(summary), picture=plot)


def _print_population(summary: dict[str, Any]) -> None:
    rows = []
    for who in summary["share_fitted"]:
        for seat, title in (("unmoved", "as drawn"), ("fitted", "moved")):
            cells = (summary[f"{key}_{seat}_W"][who] for key in ("power_mean", "power_p10"))
            powers = (or_dash(power, ".2f") for power in cells)
            shares = (f"{100 * summary[f'{grade}_{seat}'][who]:.1f}" for grade in GRADES)
            rows.append((f"{who}, seat {title}", *shares, *powers))
    title = f"{summary['design']}; {summary['group']}; {summary['samples']} of each sex"
    heads = ("", "turns, %", "can ride, %", "inside the moments, %", "their mean power, W", "10th percentile, W")
    print_table(title, heads, rows)

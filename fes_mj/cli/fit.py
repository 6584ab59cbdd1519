"""`fes_mj fit`: the seat for a rider, and who of a population can ride."""

from __future__ import annotations

import sys
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from fes_mj.cli.fit_options import RiderOptions, SeatOptions, sample_size
from fes_mj.cli.options import MomentsOptions, PrintOptions, crank_speed
from fes_mj.cli.static import print_notes, span, with_error
from fes_mj.common.console import conclude, print_table, progress_bar, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.text import printable
from fes_mj.common.writing import json_text, replacing, require_writable, write_text
from fes_mj.fit.seat import SeatFit, fit_seat, seat_text
from fes_mj.linkage.design_file import design_toml, load_design

if TYPE_CHECKING:
    from fes_mj.fit.seat import SeatLimits
    from fes_mj.linkage.design import Design
    from fes_mj.moments.joint_moments import JointMoments

_PRINT, _MOMENTS, _RIDER, _SEAT = PrintOptions(), MomentsOptions(), RiderOptions(), SeatOptions()


def fit(
    design: str,
    /,
    *,
    who: RiderOptions = _RIDER,
    seat: SeatOptions = _SEAT,
    moments: MomentsOptions = _MOMENTS,
    options: PrintOptions = _PRINT,
    dims: Literal["identified", "printed"] = "identified",
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    population: Annotated[bool, Parameter(negative="")] = False,
    samples: int | None = None,
    seed: int | None = None,
    plot: Path | None = None,
) -> int:
    """Find the seat with which a rider can ride a design, joints within their moments' range, with the most power.

    That no seat within the limits suits is a result as well: what lacks, where in the turn, and what would help.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    dims
        Dimensions of one of the paper's designs: as identified, or as the paper prints them.
    out
        The design file to write (.toml): the rider, and the seat where it was moved to.
    population
        Instead of one rider a sample of men and women: who can ride, with which power.
    samples
        With --population: people of each sex (default 1000).
    seed
        With --population: of the random numbers (default 0).
    plot
        With --population: a picture (.png) of the power over thigh and shank.
    """
    loaded, joint_moments, limits = load_design(design, dims), moments.load_moments(), seat.load()
    inputs = [Path(design), *moments.moment_files()]
    crank_speed(None, loaded)
    if population:
        given = {"--out": out, **{f"--{key}": value for key, value in vars(who).items()}}
        _refuse(given, "is of one rider; leave it out with --population")
        return _population(loaded, joint_moments, limits, options, samples, seed, plot, inputs)
    _refuse({"--samples": samples, "--seed": seed, "--plot": plot}, "is of a population; it needs --population")
    if out:
        require_writable(out, "the design", ".toml", inputs)
    result = fit_seat(loaded, who.load(loaded), joint_moments, limits)
    if out and result.fits:
        write_text(out, design_toml(result.design, _origin(result)))
    if options.json:
        written = str(out) if out and result.fits else None
        sys.stdout.write(json_text(result.summary() | {"design_file": written}))
    elif not options.quiet:
        _print(result)
        if out and result.fits:
            say(f"design file: {out}")
    return 0


def _refuse(given: dict[str, Any], why: str) -> None:
    """Raise InputError for an option that would have no effect."""
    for name, value in given.items():
        if value is not None:
            raise InputError(f"{name} {why}")


def _origin(result: SeatFit) -> str:
    """Comment of the design file."""
    rider = result.rider
    return printable(
        f"{result.drawn.name} with the seat moved by fes_mj {version('fes-mj')} ({result.moments.name}) for a thigh of "
        f"{100 * rider.thigh:.1f} and a shank of {100 * rider.shank:.1f} cm: {seat_text(result.seat)}."
    )


def _print(result: SeatFit) -> None:
    summary, rider = result.summary(), result.rider
    legs = f"thigh {100 * rider.thigh:.1f}, shank {100 * rider.shank:.1f} cm, {rider.mass:.1f} kg"
    rows = [("seat", seat_text(result.seat)), ("seat angle, deg", f"{summary['seat_angle_deg']:.1f}")]
    if result.static:
        rows += [
            ("mean crank power, W", with_error(summary["power_mean_W"], summary["power_sd_W"])),
            ("with the seat as drawn, W", _power(summary["power_unmoved_W"])),
            ("the paper's rider, seat as drawn, W", _power(summary["power_paper_rider_W"])),
            *((f"{joint} angle, deg", span(ends)) for joint, ends in result.static.joint_range_deg.items()),
        ]
    print_table(f"{result.drawn.name}; {result.moments.name}; {legs}", ("", "best seat"), rows)
    if result.static:
        print_notes(result.static)
        conclude(True, "Fits", ".")
    else:
        conclude(False, "Does not fit", f": {result.why}.")
        for help_ in summary["helps"]:
            say(f"it would with {help_}")


def _power(value: float | None) -> str:
    return "does not turn" if value is None else f"{value:.2f}"


def _population(
    design: Design,
    moments: JointMoments,
    limits: SeatLimits,
    options: PrintOptions,
    samples: int | None,
    seed: int | None,
    plot: Path | None,
    inputs: list[Path],
) -> int:
    """Sample people, and print or draw who can ride."""
    size, seed = sample_size(samples), seed or 0
    if seed < 0:
        raise InputError(f"--seed is {seed}; it must not be negative")
    if plot:
        require_extra("report", "matplotlib")
        require_writable(plot, "the picture", ".png", inputs)
    from fes_mj.fit.population import STEPS, fit_population

    with progress_bar(f"{design.name}, riders", STEPS, options.silent) as advance:
        result = fit_population(design, moments, limits=limits, samples=size, seed=seed, done=lambda: advance(1))
    if plot:
        import matplotlib as mpl

        from fes_mj.common.style import STYLE
        from fes_mj.viewing.people import population_figure

        with mpl.rc_context(STYLE), replacing(plot) as temporary:
            population_figure([result]).savefig(temporary, dpi=150)
    if options.json:
        sys.stdout.write(json_text(result.summary()))
    elif not options.quiet:
        _print_population(result.summary())
    return 0


def _print_population(summary: dict[str, Any]) -> None:
    rows = []
    for who in summary["share_fitted"]:
        for seat, title in (("unmoved", "as drawn"), ("fitted", "moved")):
            cells = (summary[f"{key}_{seat}_W"][who] for key in ("power_mean", "power_p10"))
            powers = ("-" if power is None else f"{power:.2f}" for power in cells)
            rows.append((f"{who}, seat {title}", f"{100 * summary[f'share_{seat}'][who]:.1f}", *powers))
    title = f"{summary['design']}; {summary['group']}; {summary['samples']} of each sex"
    print_table(title, ("", "can ride, %", "their mean power, W", "10th percentile, W"), rows)

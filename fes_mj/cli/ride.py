"""`fes_mj ride`: the tricycle on a road, by two solvers side by side."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from fes_mj.cli.options import LAG, MomentsOptions, PrintOptions, Range, require_lag
from fes_mj.cli.simulate import check_rows, conclude_checks
from fes_mj.cli.static import what_moves
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.units import KMH, RPM
from fes_mj.common.writing import json_text, require_folder, require_replaceable, require_writable, write_files
from fes_mj.linkage.design import TRICYCLE_SPEED
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.torque_velocity import load_torque_velocity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fes_mj.crosscheck.ride_case import RideCase
    from fes_mj.riding.ride import Ride
    from fes_mj.riding.starts import Starts
    from fes_mj.riding.trace import Trace


_RANGES = {
    "slope": Range(-30, 30, "a slope in percent that a tricycle may climb or descend,"),
    "launch": Range(0.1, 60, "a speed in km/h"),
    "from-rest": Range(0, 360, "a crank angle in degrees"),
    "duration": Range(1, 300, "a time in s"),
    "lag": LAG,
    "tricycle-mass": Range(1, 500, "a mass in kg"),
    "rolling-mass": Range(0, 50, "a mass in kg"),
    "crr": Range(0, 0.5, "a force per weight"),
    "drag-area": Range(0, 10, "an area in m2"),
}


@Parameter(name="*")
@dataclass
class RideOptions(PrintOptions, MomentsOptions):
    """A ride.

    Parameters
    ----------
    transmission
        freewheel: the crank pushes the wheel, the wheel runs ahead of it; fixed: the two turn together.
    slope
        Of the road, in percent; uphill is positive.
    launch
        Speed at the start in km/h; by default 5.71.
    from_rest
        Start from rest instead, at this crank angle in degrees.
    duration
        Of the ride, in s.
    torque_velocity
        Let joint moments change with joint speed by Hill's relation, or not. Without it there is no sensible steady
        speed on the flat.
    lag
        Time constant in s with which the muscles follow the stimulation. The stimulation makes good what the tricycle
        of the measurement lags at its cadence, and is timed ahead for the actual one.
    tricycle_mass
        Of the tricycle with its wheels, in kg, without crank and linkage.
    rolling_mass
        Of its rims, in kg, which count twice when it accelerates.
    crr
        Coefficient of rolling resistance.
    drag_area
        Drag coefficient times frontal area, in m2.
    dims
        Dimensions of one of the paper's designs: as identified, or as the paper prints them.
    """

    transmission: Literal["freewheel", "fixed"] = "freewheel"
    slope: float = 0.0
    launch: float | None = None
    from_rest: float | None = None
    duration: float = 60.0
    torque_velocity: Literal["hill", "none"] = "hill"
    lag: float = 0.0
    tricycle_mass: float = 20.0
    rolling_mass: float = 3.0
    crr: float = 0.008
    drag_area: float = 0.4
    dims: Literal["identified", "printed"] = "identified"

    def load(self, name: str) -> Ride:
        """Load everything the options name. Raises InputError for what cannot be used."""
        for option, allowed in _RANGES.items():
            value = getattr(self, option.replace("-", "_"))
            if option == "launch" and value == 0:
                raise InputError("--launch is 0; for a start from rest give its crank angle: --from-rest DEG")
            if value is not None:
                allowed.require(option, value)
        if self.launch is not None and self.from_rest is not None:
            raise InputError("--launch and --from-rest exclude each other; a start from rest has no speed")
        design, moments = load_design(name, self.dims), self.load_moments(2)
        require_lag(self.lag, design, design.linkage.cadence)
        if self.torque_velocity == "hill":
            moments = moments.at_speed(load_torque_velocity("hill"))
        if self.lag:
            moments.require_cadence("with a lag")
        from fes_mj.riding.ride import Ride, Road

        launch = TRICYCLE_SPEED if self.launch is None else self.launch * KMH
        return Ride(
            design,
            moments,
            Road(self.slope / 100, self.tricycle_mass, self.rolling_mass, self.crr, self.drag_area),
            transmission=self.transmission,
            lag=self.lag,
            launch=launch if self.from_rest is None else 0.0,
            start=math.radians(self.from_rest or 0.0),
            duration=self.duration,
        )


_DEFAULTS = RideOptions()


def ride(
    design: str,
    /,
    *,
    options: RideOptions = _DEFAULTS,
    starts: Annotated[bool, Parameter(negative="")] = False,
    out: Path | None = None,
    render: Path | None = None,
) -> int:
    """Ride a design on a road, in MuJoCo and by the reduced equation of motion; exit code 1 if the two disagree.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    starts
        Also find from which crank angles it starts from rest, the launch it needs and the slope it climbs.
    out
        Existing folder for the result (JSON), the ride (CSV), the model (MJCF) and, with --starts, a picture (SVG).
    render
        Write a video (.mp4) of the ride beside speed and crank power.
    """
    loaded = options.load(design)
    inputs = [Path(design), *options.moment_files()]
    if render:
        require_writable(render, "the video", ".mp4", inputs)
    paths = _results(loaded, out, starts, inputs) if out else {}
    from fes_mj.crosscheck.ride_case import RideCase

    case, found = RideCase(loaded), None
    if starts:
        from fes_mj.riding.starts import starts as find_starts

        found = find_starts(loaded)
    if paths:
        _write(case, found, paths)
    if options.json:
        sys.stdout.write(json_text(case.summary() | (found.summary() if found else {})))
    elif not options.quiet:
        _print(case, found)
    if render:
        from fes_mj.viewing.render import render_video

        render_video(case, render, quiet=options.quiet)
        if not options.silent:
            say(f"video: {render}")
    return 0 if case.agrees else 1


def _print(case: RideCase, starts: Starts | None) -> None:
    ride, run = case.ride, case.simulation.trace
    road = f"{ride.transmission}{' gear' if ride.fixed else ''}, {100 * ride.road.slope:g} % slope"
    both = [(name, mine, other) for (name, mine), (_, other) in zip(_rows(run), _rows(case.reference), strict=True)]
    print_table(f"{what_moves(ride.design, ride.moments)}; {road}", ("", "MuJoCo", "reduced model"), both)
    print_table("Checks", ("check", "value", "limit", "verdict"), check_rows(case.checks))
    if starts:
        rows = [
            ("starts from rest at, % of crank angles", f"{100 * starts.share:.0f}"),
            ("launch needed from everywhere, km/h", _text(starts.launch and starts.launch / KMH, ".2f")),
            ("steepest slope, %", _text(starts.slope and 100 * starts.slope, ".2f")),
        ]
        print_table("Starts, by the reduced model", ("", ""), rows)
    if run.rides:
        say(f"It rides: {_text(run.mean_speed and run.mean_speed / KMH, '.2f')} km/h at the end.", "bold")
    else:
        say(f"It stops after {run.stopped_at:.1f} s and {run.distance.max():.1f} m.", "bold")
    conclude_checks("The two solvers", case.checks)


def _rows(trace: Trace) -> list[tuple[str, str]]:
    """Quantity and value of one solver, as text."""
    speed, cadence, ripple = trace.mean_speed, trace.cadence, trace.ripple
    return [
        ("speed over the last turns, km/h", _text(speed and speed / KMH, ".3f")),
        ("cadence, rpm", _text(cadence and cadence / RPM, ".1f")),
        ("speed ripple, %", _text(ripple and 100 * ripple, ".2f")),
        ("freewheeling, % of the time", f"{100 * trace.coasting_share:.1f}"),
        ("distance, m", f"{trace.distance.max():.2f}"),
        ("stopped after, s", _text(trace.stopped_at, ".2f")),
        ("muscle power, W", _text(trace.muscle_power, ".2f")),
        ("road power, W", _text(trace.road_power, ".2f")),
    ]


def _text(value: float | None, spec: str) -> str:
    return "-" if value is None else format(value, spec)


def _results(ride: Ride, folder: Path, starts: bool, inputs: Sequence[Path]) -> dict[str, Path]:
    """Where the results go. Raises InputError, before anything runs, if files of others are there."""
    from fes_mj.simulation.export import MARKS

    require_folder(folder, "the results")
    marks = {"json": '"transmission": ', "csv": ",reduced_speed_m_s,", "xml": MARKS["model"]}
    if starts:
        require_extra("video", "matplotlib")
        from fes_mj.viewing.rings import MARK

        marks["svg"] = MARK
    paths = {suffix: folder / f"{ride.design.name}-{ride.moments.name}-ride.{suffix}" for suffix in marks}
    for suffix, path in paths.items():
        require_replaceable(path, "the results", marks[suffix], inputs)
    return paths


def _write(case: RideCase, starts: Starts | None, paths: dict[str, Path]) -> None:
    from fes_mj.simulation.export import mjcf_text
    from fes_mj.simulation.road_mjcf import build_road_mjcf

    texts = {
        "json": json_text(case.summary() | (starts.summary() if starts else {})),
        "csv": case.trace_csv(),
        "xml": mjcf_text(build_road_mjcf(case.ride, case.timestep)),
    }
    if starts:
        from fes_mj.viewing.rings import starts_svg

        texts["svg"] = starts_svg(starts)
    write_files({path: texts[suffix] for suffix, path in paths.items()})

"""`fes_mj ride`: the tricycle on a road, by two solvers side by side."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Group, Parameter
from cyclopts.validators import Number, mutually_exclusive

import fes_mj
from fes_mj.cli.drive import MusclesFirst
from fes_mj.cli.options import DesignName, Dims, Flag, MomentsOptions, Out, VerboseOptions
from fes_mj.cli.tables import beside, conclude_checks, or_dash, print_checks, what_moves
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import require_extra
from fes_mj.common.units import KMH, RPM
from fes_mj.common.writing import json_text, require_results, require_writable, write_results
from fes_mj.linkage.design import TRICYCLE_SPEED
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.stimulated import StimulatedRider, stimulated_rider

if TYPE_CHECKING:
    from fes_mj.riding.starts import Starts
    from fes_mj.riding.trace import Trace

_BEGIN = Group("How the ride begins", validator=mutually_exclusive)
_TRICYCLE = Group("Tricycle and road")
NO_FALL = "Joint moments do not fall with speed, as muscles do: how fast it gets says nothing of a rider."


@Parameter(name="*")
@dataclass
class RideOptions(VerboseOptions, MomentsOptions):
    """A ride.

    Args:
        transmission: freewheel: the crank pushes the wheel, the wheel runs ahead of it; fixed: the two turn together.
        slope: Of the road, in percent; uphill is positive.
        launch: Speed at the start in km/h; by default 5.71.
        from_rest: Start from rest instead, at this crank angle in degrees.
        duration: Of the ride, in s.
        tricycle_mass: Of the tricycle with its wheels, in kg, without crank and linkage.
        rolling_mass: Of its rims, in kg, which count twice when it accelerates.
        crr: Coefficient of rolling resistance.
        drag_area: Drag coefficient times frontal area, in m2.
    """

    transmission: Annotated[Literal["freewheel", "fixed"], Parameter(group=_TRICYCLE)] = "freewheel"
    slope: Annotated[float, Parameter(group=_TRICYCLE, validator=Number(gte=-30, lte=30))] = 0.0
    launch: Annotated[float | None, Parameter(group=_BEGIN, validator=Number(gte=0.1, lte=60))] = None
    from_rest: Annotated[float | None, Parameter(group=_BEGIN, validator=Number(gte=0, lte=360))] = None
    duration: Annotated[float, Parameter(validator=Number(gte=1, lte=300))] = 60.0
    tricycle_mass: Annotated[float, Parameter(group=_TRICYCLE, validator=Number(gte=1, lte=500))] = 20.0
    rolling_mass: Annotated[float, Parameter(group=_TRICYCLE, validator=Number(gte=0, lte=50))] = 3.0
    crr: Annotated[float, Parameter(group=_TRICYCLE, validator=Number(gte=0, lte=0.5))] = 0.008
    drag_area: Annotated[float, Parameter(group=_TRICYCLE, validator=Number(gte=0, lte=10))] = 0.4
    dims: Dims = "identified"

    def load(self, name: str, drive: MusclesFirst) -> Ride:
        """Load everything the options name. Raises InputError for what cannot be used."""
        design = load_design(name, self.dims)
        launch = TRICYCLE_SPEED if self.launch is None else self.launch * KMH
        return Ride(
            design,
            stimulated_rider(drive.load_muscles(self), design) if drive.drive == "muscles" else self.load_moments(2),
            Road(self.slope / 100, self.tricycle_mass, self.rolling_mass, self.crr, self.drag_area),
            transmission=self.transmission,
            launch=launch if self.from_rest is None else 0.0,
            start=math.radians(self.from_rest or 0.0),
            duration=self.duration,
        )


def ride(
    design: DesignName,
    /,
    *,
    options: RideOptions = RideOptions(),
    drive: MusclesFirst = MusclesFirst(),
    starts: Flag = False,
    out: Out | None = None,
    render: Path | None = None,
) -> int:
    """Ride a design on a road, in MuJoCo and by the reduced equation of motion; exit code 1 if the two disagree.

    Args:
        starts: Also find from which crank angles it starts from rest, the launch it needs and the slope it climbs.
        out: Folder for the result (JSON), the ride (CSV), the model (MJCF) and, with --starts, a picture (SVG); it is
            made if its parent exists.
        render: Write a video (.mp4) of the ride beside speed and crank power.
    """
    loaded, inputs = options.load(design, drive), drive.inputs(options, design)
    require_writable(render, "the video", ".mp4", inputs)
    if render:
        from fes_mj.viewing.render import require_video

        require_video()
    if out and starts:
        require_extra("video", "matplotlib")
    suffixes = ("json", "csv", "xml", *(["svg"] if starts else []))
    stem = f"{loaded.design.name}-{loaded.drive.name.replace(' ', '-')}-ride"
    paths = require_results(out, [f"{stem}.{suffix}" for suffix in suffixes], inputs) if out else []
    case, result = fes_mj.RideCase(loaded), fes_mj.starts(loaded) if starts else None
    content = case.summary() | (result.summary() if result else {})
    if paths:
        write_results(dict(zip(paths, _texts(case, result, json_text(content)), strict=True)))
    options.show(lambda: content, lambda: _print(case, result, options.verbose))
    if render:
        from fes_mj.viewing.render import render_video

        render_video(case, render, quiet=options.quiet)
        options.name_files(video=render)
    return 0 if case.agrees else 1


def _texts(case: fes_mj.RideCase, starts: Starts | None, result: str) -> list[str]:
    """What is written: the result, the ride, the model, the ring of starts."""
    from fes_mj.simulation.export import mjcf_text
    from fes_mj.simulation.road_mjcf import build_road_mjcf

    texts = [result, case.trace_csv(), mjcf_text(build_road_mjcf(case.ride, case.simulation.timestep))]
    if starts:
        from fes_mj.viewing.rings import starts_svg

        texts.append(starts_svg(starts))
    return texts


def _print(case: fes_mj.RideCase, starts: Starts | None, verbose: bool) -> None:
    ride, run = case.ride, case.simulation.trace
    if isinstance(ride.drive, JointMoments):
        say(NO_FALL)
    if case.agrees:
        road = f"{ride.transmission}{' gear' if ride.fixed else ''}, {100 * ride.road.slope:g} % slope"
        moved = ride.drive.name
        if isinstance(ride.drive, StimulatedRider):
            moved = f"{ride.drive.driver}, the most probable rider"
        title = f"{what_moves(ride.design, moved)}; {road}"
        error = case.uncertainty
        rows = beside(_rows(run, error["mujoco"]), _rows(case.reference, error["reduced"]))
        print_table(title, ("", "MuJoCo", "reduced model"), [row for row in rows if set(row[1:]) != {"-"}])
    if verbose or not case.agrees:
        print_checks("Checks", case.checks)
    if starts:
        rows = [
            ("starts from rest at, % of crank angles", f"{100 * starts.share:.0f}"),
            ("launch needed from everywhere, km/h", or_dash(starts.launch and starts.launch / KMH, ".2f")),
            ("steepest slope, %", or_dash(starts.slope and 100 * starts.slope, ".2f")),
        ]
        print_table("Starts, by the reduced model", ("", ""), rows)
    say(case.sentence, "bold")
    conclude_checks("The two solvers", case.checks)


def _rows(trace: Trace, uncertainty: float) -> list[tuple[str, str]]:
    """Quantity and value of one solver, as text."""
    speed, cadence, ripple = trace.mean_speed, trace.cadence, trace.ripple
    return [
        ("speed over the last turns, km/h", or_dash(speed and speed / KMH, ".3f")),
        ("numerical uncertainty of the speed, %", or_dash(speed and 100 * uncertainty, ".2g")),
        ("cadence, rpm", or_dash(cadence and cadence / RPM, ".1f")),
        ("speed ripple, %", or_dash(ripple and 100 * ripple, ".2f")),
        ("freewheeling, % of the time", f"{100 * trace.coasting_share:.1f}"),
        ("distance, m", f"{trace.distance.max():.2f}"),
        ("stopped after, s", or_dash(trace.stopped_at, ".2f")),
        ("ended after, s", f"{trace.time[-1]:.2f}"),
        ("muscle power of both legs, W", or_dash(trace.muscle_power, ".2f")),
        ("road power, W", or_dash(trace.road_power, ".2f")),
    ]

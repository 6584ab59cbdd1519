"""The right half of a video: curves that are drawn once, and a copy of them with a cursor for each frame."""

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from fes_mj.budget.answer import Answer
from fes_mj.common.arrays import Picture
from fes_mj.common.style import BAD, COLOURS, FAINT, GOOD, INK, STYLE, literal
from fes_mj.common.units import KMH, RPM
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.drive import Muscles
from fes_mj.riding.stimulated import StimulatedRider
from fes_mj.riding.verdict import verdict
from fes_mj.viewing.charts import any_letters, plot_power
from fes_mj.viewing.stage import PLOT_WIDTH, SIDE

_SMOOTH = 0.02  # s over which a ride's power is drawn
_DPI = 100
_LEFT, _RIGHT = 0.05, 0.97  # of the width, where lines of text begin and end


class Panel:
    """A figure of PLOT_WIDTH times SIDE pixels, which `draw` fills and whose axes it returns."""

    def __init__(self, draw: Callable[[Figure], list[Axes]]) -> None:
        with mpl.rc_context(STYLE), any_letters():
            figure = Figure(figsize=(PLOT_WIDTH / _DPI, SIDE / _DPI), dpi=_DPI, facecolor="white")
            canvas = FigureCanvasAgg(figure)
            self._axes = draw(figure)
            canvas.draw()  # type: ignore[no-untyped-call]
        self._background = np.asarray(canvas.buffer_rgba())[..., :3].copy()  # type: ignore[no-untyped-call]

    def with_cursor(self, x: float, y: float | None = None, colour: str = INK) -> Picture:
        """The panel with a line across all axes at x, and a dot at y on it; shape (SIDE, PLOT_WIDTH, 3)."""
        picture = Image.fromarray(self._background)
        draw = ImageDraw.Draw(picture)
        for axes in self._axes:
            draw.line([self._pixel(axes, x, end) for end in axes.get_ylim()], fill=INK, width=2)
            if y is not None:
                across, down = self._pixel(axes, x, y)
                draw.ellipse([across - 6, down - 6, across + 6, down + 6], fill=colour, outline="white", width=2)
        return np.asarray(picture)

    def _pixel(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        across, up = axes.transData.transform((x, y))
        return float(across), SIDE - float(up)


def write_title(figure: Figure, design: Design, below: str) -> None:
    """At the top: the design's name and kind, and what is said of the run."""
    _fit(figure, 0.955, f"{design.name}: {design.linkage.title}", size=13, weight="bold")
    _fit(figure, 0.925, below, size=11, color=FAINT)


def write_verdict(figure: Figure, text: str, good: bool) -> None:
    """At the bottom, green or red."""
    _fit(figure, 0.02, text, size=12, weight="bold", color=GOOD if good else BAD)


def _fit(figure: Figure, y: float, text: str, size: float, **look: Any) -> None:
    """A line of text of this size, or of the largest with which it fits into the width."""
    line = figure.text(_LEFT, y, literal(text), size=size, **look)
    width = line.get_window_extent().width / figure.bbox.width
    line.set_fontsize(size * min(1.0, (_RIGHT - _LEFT) / width))


def power_panel(case: Case, answer: Answer | None) -> Callable[[int], Picture]:
    """Crank power over the turn, dynamic and static: step of the turn -> the panel with the cursor there."""
    run, panel = case.simulation, Panel(lambda figure: [_draw_power(figure, case, answer)])
    angle = np.degrees(run.crank_angle) % 360
    return lambda step: panel.with_cursor(angle[step], run.power[step], COLOURS["mujoco"])


def _draw_power(figure: Figure, case: Case, answer: Answer | None) -> Axes:
    run = case.simulation
    axes = figure.add_axes((0.14, 0.31, 0.81, 0.44))
    plot_power(axes, case)
    mean = len(run.legs) * run.power_mean
    axes.axhline(mean, color=COLOURS["mujoco"], lw=1, ls=":", label=f"MuJoCo, mean of the turn: {mean:.1f} W")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), fontsize=11)
    legs = "one leg" if len(run.legs) == 1 else "two legs"
    moved = isinstance(run.drive, Muscles)
    write_title(figure, run.design, f"driven by {_driver(run.drive)}; {run.cadence / RPM:.1f} rpm, {legs}")
    whose = "the most probable rider" if moved else "as the paper assumes"
    facts = [
        (f"{whose}, statics", f"{case.static_power_mean:.2f} W", COLOURS["quasi-static"]),
        ("the same in MuJoCo", f"{run.power_mean:.2f} W", COLOURS["mujoco"]),
    ]
    if answer and answer.rider_power:
        facts.append(("for a rider: muscles, best timing", f"{answer.rider_power.text(1)} W", INK))
    if answer and answer.rider_ratio:
        facts.append(("for a rider, per equally timed TRT", answer.rider_ratio.text(2), INK))
    figure.text(_LEFT, 0.2, "Mean of the turn, one leg (5 to 95 %)", size=11, color=FAINT)
    for row, (name, value, colour) in enumerate(facts):
        figure.text(_LEFT, 0.165 - 0.034 * row, name, size=12, color=colour)
        figure.text(_RIGHT, 0.165 - 0.034 * row, value, size=12, color=colour, ha="right", family="DejaVu Sans")
    write_verdict(figure, agreement(case), case.agrees)
    return axes


def _driver(drive: JointMoments | Muscles | StimulatedRider) -> str:
    """What drives the legs, in words."""
    return f"joint moments {drive.name}" if isinstance(drive, JointMoments) else drive.driver


def agreement(case: Case) -> str:
    """What agrees, or which checks fail."""
    failed = [check.name.replace("_", " ") for check in case.checks if not check.ok]
    if failed:
        return f"check failed: {', '.join(failed)}"
    return f"mean power agrees: difference {case.difference_text}"


def ride_panel(case: RideCase, end: float) -> Callable[[int], Picture]:
    """Speed and muscle power by both solvers until `end`, s: step of the ride -> the panel with the cursor there."""
    time, panel = case.simulation.trace.time, Panel(lambda figure: _draw_ride(figure, case, end))
    return lambda step: panel.with_cursor(time[step])


def _draw_ride(figure: Figure, case: RideCase, end: float) -> list[Axes]:
    speed, power = (figure.add_axes((0.14, bottom, 0.81, 0.30)) for bottom in (0.53, 0.14))
    looks = (
        ("reduced model", case.reference, COLOURS["reference"], 4, 0.45),
        ("MuJoCo", case.simulation.trace, COLOURS["mujoco"], 1.5, 1.0),
    )
    grid = np.arange(0, end, _SMOOTH)
    for label, trace, colour, width, alpha in looks:
        look: dict[str, Any] = {"color": colour, "lw": width, "alpha": alpha}
        speed.plot(grid, np.interp(grid, trace.time, trace.speed) / KMH, label=label, **look)
        work = np.interp(grid, trace.time, trace.muscle_work)
        power.plot(grid[:-1] + _SMOOTH / 2, np.diff(work) / _SMOOTH, **look)
    speed.set(xlim=(0, end), ylabel="tricycle, km/h")
    power.set(xlim=(0, end), ylabel="muscles, W", xlabel="time, s")
    power.axhline(0, color="black", lw=0.8)
    speed.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), fontsize=11, ncols=2)
    ride, trace = case.ride, case.simulation.trace
    whole = float(trace.time[-1])
    part = f"the whole ride, {whole:.1f} s" if end > whole - 0.1 else f"the first {end:.0f} of {whole:.0f} s"
    road = f"{ride.transmission}, {100 * ride.road.slope:.3g} % slope; {part}"
    write_title(figure, ride.design, f"driven by {_driver(ride.drive)}; {road}")
    at_end = "" if trace.mean_speed is None else f": {trace.mean_speed / KMH:.1f} km/h over its last turns"
    result = f"{verdict(trace).word.replace('-', ' ')}{at_end}; the two solvers agree"
    write_verdict(figure, result if case.agrees else "the two solvers DO NOT agree", case.agrees)
    return [speed, power]

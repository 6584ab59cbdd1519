"""Speed and muscle power over time by both solvers, with a cursor that moves: the right half of a ride's video."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import Picture
from fes_mj.common.style import COLOURS
from fes_mj.common.units import KMH
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.viewing.panel import Panel, write_title, write_verdict

_SMOOTH = 0.02  # s over which power is drawn


class RidePanel:
    """The panel of a ride."""

    def __init__(self, case: RideCase, end: float, width: int, height: int) -> None:
        """end: s, until which the ride is shown."""
        self._time = case.simulation.trace.time
        self._panel = Panel(width, height, lambda figure: _draw(figure, case, end))

    def frame(self, step: int) -> Picture:
        """The panel with the cursor at a step of the ride, shape (height, width, 3)."""
        return self._panel.with_cursor(self._time[step])


def _draw(figure: Figure, case: RideCase, end: float) -> list[Axes]:
    speed, power = (figure.add_axes((0.14, bottom, 0.81, 0.30)) for bottom in (0.53, 0.14))
    _plot(case, end, speed, power)
    _write_facts(figure, case)
    return [speed, power]


def _plot(case: RideCase, end: float, speed: Axes, power: Axes) -> None:
    looks = (
        ("reduced model", case.reference, COLOURS["reference"], 4, 0.45),
        ("MuJoCo", case.simulation.trace, COLOURS["mujoco"], 1.5, 1.0),
    )
    grid = np.arange(0, end, _SMOOTH)
    for label, trace, colour, width, alpha in looks:
        work = np.interp(grid, trace.time, trace.muscle_work)
        speed.plot(
            grid, np.interp(grid, trace.time, trace.speed) / KMH, color=colour, lw=width, alpha=alpha, label=label
        )
        power.plot(grid[:-1] + _SMOOTH / 2, np.diff(work) / _SMOOTH, color=colour, lw=width, alpha=alpha)
    speed.set(xlim=(0, end), ylabel="tricycle, km/h")
    power.set(xlim=(0, end), ylabel="muscles, W", xlabel="time, s")
    power.axhline(0, color="black", lw=0.8)
    speed.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), fontsize=11, ncols=2)


def _write_facts(figure: Figure, case: RideCase) -> None:
    """Title above and the verdict below the curves."""
    ride, trace = case.ride, case.simulation.trace
    road = f"joint moments {ride.moments.name.upper()}, {ride.transmission}, {100 * ride.road.slope:.3g} % slope"
    write_title(figure, ride.design, road)
    speed = trace.mean_speed
    end = f"rides, {(speed or 0) / KMH:.1f} km/h at the end" if trace.rides else f"stops after {trace.stopped_at:.1f} s"
    verdict = "the two solvers agree" if case.agrees else "the two solvers DO NOT agree"
    write_verdict(figure, f"{end}; {verdict}", case.agrees)

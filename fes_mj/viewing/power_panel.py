"""Crank power over the turn, dynamic and static, with a cursor that moves: the right half of the video."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import Picture
from fes_mj.common.style import COLOURS, INK
from fes_mj.common.units import RPM
from fes_mj.crosscheck.turn_case import Case
from fes_mj.viewing.charts import plot_power
from fes_mj.viewing.panel import Panel, write_title, write_verdict


class PowerPanel:
    """The panel of one turn."""

    def __init__(self, case: Case, width: int, height: int) -> None:
        run = case.simulation
        steps = len(run.crank_angle) // run.turns
        self._angle = np.degrees(run.crank_angle[:steps]) % 360
        self._power = run.power[:steps]
        self._panel = Panel(width, height, lambda figure: [_draw(figure, case)])

    def frame(self, step: int) -> Picture:
        """The panel with the cursor at a step of the turn, shape (height, width, 3)."""
        return self._panel.with_cursor(self._angle[step], self._power[step], COLOURS["mujoco"])


def _draw(figure: Figure, case: Case) -> Axes:
    run = case.simulation
    axes = figure.add_axes((0.14, 0.27, 0.81, 0.48))
    plot_power(axes, case)
    mean = len(run.legs) * run.power_mean
    axes.axhline(mean, color=COLOURS["mujoco"], lw=1, ls=":", label=f"mean of MuJoCo, {mean:.1f} W")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), fontsize=11)
    write_title(
        figure,
        run.design,
        f"joint moments {run.moments.name.upper()}, {run.cadence / RPM:.1f} rpm, "
        f"{'one leg' if len(run.legs) == 1 else 'two legs'}",
    )
    _write_facts(figure, case)
    return axes


def _write_facts(figure: Figure, case: Case) -> None:
    """The numbers and the verdict below the curves."""
    run = case.simulation
    facts = (
        ("mean power, MuJoCo", f"{run.power_mean:.3f} W a leg", COLOURS["mujoco"]),
        ("mean power, quasi-static", f"{case.static_power_mean:.3f} W a leg", COLOURS["quasi-static"]),
        ("MuJoCo less exact power, rms", f"{case.rms_per_leg(run):.3f} W a leg", INK),
        ("largest loop gap", f"{1e6 * run.loop_gap_max:.1f} µm", INK),
    )
    for row, (name, value, colour) in enumerate(facts):
        figure.text(0.14, 0.165 - 0.034 * row, name, size=12, color=colour)
        figure.text(0.95, 0.165 - 0.034 * row, value, size=12, color=colour, ha="right", family="DejaVu Sans")
    write_verdict(figure, verdict(case), case.agrees)


def verdict(case: Case) -> str:
    """What agrees, or which checks fail."""
    failed = [each.name.replace("_", " ") for each in case.checks if not each.ok]
    if failed:
        return f"check failed: {', '.join(failed)}"
    return f"mean power agrees: difference {case.difference_text}"

"""Crank power over the turn, dynamic and static, with a cursor that moves: the right half of the video."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.arrays import Picture
from fes_mj.crosscheck import Case
from fes_mj.style import BAD, COLOURS, FAINT, GOOD, literal
from fes_mj.units import RPM
from fes_mj.viewing.charts import plot_power
from fes_mj.viewing.panel import Panel


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
    axes = figure.add_axes((0.14, 0.30, 0.81, 0.49))
    plot_power(axes, case)
    axes.axhline(len(run.legs) * run.power_mean, color=COLOURS["mujoco"], lw=1, ls=":")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), fontsize=11)
    _write_facts(figure, case)
    return axes


def _write_facts(figure: Any, case: Case) -> None:
    """Title above and the numbers below the curves."""
    run = case.simulation
    design, rpm = run.design, run.cadence / RPM
    figure.text(
        0.05, 0.955, literal(f"{design.name.upper()}: {design.linkage.architecture.title}"), size=13, weight="bold"
    )
    legs = "one leg" if len(run.legs) == 1 else "two legs"
    moments = literal(f"joint moments {run.moments.name.upper()}, {rpm:.1f} rpm, {legs}")
    figure.text(0.05, 0.925, moments, size=11, color=FAINT)
    facts = (
        ("mean power, dynamic", f"{run.power_mean:.3f} W a leg", COLOURS["mujoco"]),
        ("mean power, quasi-static", f"{case.static_power_mean:.3f} W a leg", COLOURS["quasi-static"]),
        ("difference", case.difference_text, "black"),
        ("largest loop gap", f"{1e6 * run.loop_gap_max:.1f} µm", "black"),
    )
    for row, (name, value, colour) in enumerate(facts):
        figure.text(0.14, 0.185 - 0.038 * row, name, size=12, color=colour)
        figure.text(0.95, 0.185 - 0.038 * row, value, size=12, color=colour, ha="right", family="DejaVu Sans")
    verdict = "dynamic and static agree" if case.agrees else "dynamic and static DO NOT agree"
    figure.text(0.14, 0.025, verdict, size=12, weight="bold", color=GOOD if case.agrees else BAD)

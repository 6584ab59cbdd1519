"""The report's figures, as SVG that scales with the page."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from fes_mj.style import STYLE
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.problems import Chain
from fes_mj.verification.refinement import Level, Refinement
from fes_mj.viewing.charts import plot_power, svg_text

WIDTH, HEIGHT = 6.4, 3.6  # inches; text stays readable at the width of a phone
READABLE: dict[Any, Any] = STYLE | {"font.size": 12, "legend.fontsize": 11}


def power_curve(case: VerificationCase) -> str:
    """Simulated crank power over the turn beside its massive and its quasi-static reference."""
    with mpl.rc_context(READABLE):
        figure, axes = _axes("", "")
        plot_power(axes, case)
        axes.set_title(case.name, loc="left", fontsize=12)
        return _svg(figure, axes)


def refinement_curve(name: str, refinement: Refinement) -> str:
    """Errors of one run over the time step."""
    steps = refinement.steps
    with mpl.rc_context(READABLE):
        figure, axes = _axes("time step, ms", "relative error, or gap in m")
        _line(axes, steps, "gap", f"loop gap, order {refinement.gap_order:.2f}")
        _line(axes, steps, "power_rms", f"crank power, W rms, order {refinement.power_order:.2f}")
        _line(axes, steps, "lost", "energy lost")
        _line(axes, steps, "work_error", "work per turn, against statics")
        axes.set_xscale("log", base=2)
        axes.set_xticks([1e3 * level.timestep for level in steps], [f"{1e3 * level.timestep:.3f}" for level in steps])
        axes.set_yscale("log")
        axes.set_title(name, loc="left", fontsize=12)
        return _svg(figure, axes)


def _line(axes: Any, levels: tuple[Level, ...], field: str, label: str) -> None:
    values = [abs(getattr(level, field)) for level in levels]
    axes.plot([1e3 * level.timestep for level in levels], values, "o-", label=label)


def chain_curve(chains: list[Chain]) -> str:
    """Energy drift of the chain A02 over time, by settings."""
    with mpl.rc_context(READABLE):
        figure, axes = _axes("time, s", "change of energy so far, J")
        for chain in chains:
            step = slice(1, None, max(1, len(chain.time) // 500))
            worst = np.maximum.accumulate(np.abs(chain.energy))
            axes.plot(chain.time[step], worst[step], label=chain.settings.name)
        axes.set_yscale("log")
        return _svg(figure, axes)


def _axes(x: str, y: str) -> tuple[Figure, Any]:
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=x, ylabel=y)
    return figure, axes


def _svg(figure: Figure, axes: Any) -> str:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3 if sum(map(len, labels)) < 50 else 2)
    return svg_text(figure)

"""The report's figures, as SVG that scales with the page."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from fes_mj.style import STYLE, literal
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.problems import Chain
from fes_mj.verification.refinement import Refinement
from fes_mj.viewing.charts import plot_power, svg_text

WIDTH, HEIGHT = 6.4, 3.6  # inches; text stays readable at the width of a phone
READABLE: dict[Any, Any] = STYLE | {"font.size": 12, "legend.fontsize": 11}


@mpl.rc_context(READABLE)
def power_curve(case: VerificationCase) -> str:
    """Simulated crank power over the turn beside its massive and its quasi-static reference."""
    figure, axes = _axes("", "")
    plot_power(axes, case)
    axes.set_title(literal(case.name), loc="left", fontsize=12)
    return _svg(figure, axes)


@mpl.rc_context(READABLE)
def refinement_curve(name: str, refinement: Refinement) -> str:
    """Errors of one run over the time step."""
    steps = refinement.steps
    figure, axes = _axes("time step, ms", "relative error, or gap in m")
    timestep = [1e3 * level.timestep for level in steps]
    for field, label in {
        "gap": f"loop gap, order {refinement.gap_order:.2f}",
        "power_rms": f"crank power, W rms, order {refinement.power_order:.2f}",
        "lost": "energy lost",
        "work_error": "work per turn, against statics",
    }.items():
        axes.plot(timestep, [abs(getattr(level, field)) for level in steps], "o-", label=label)
    axes.set_xscale("log", base=2)
    axes.set_xticks(timestep, [f"{each:.3f}" for each in timestep])
    axes.set_yscale("log")
    axes.set_title(literal(name), loc="left", fontsize=12)
    return _svg(figure, axes)


@mpl.rc_context(READABLE)
def chain_curve(chains: list[Chain]) -> str:
    """Energy drift of the chain A02 over time, by settings."""
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

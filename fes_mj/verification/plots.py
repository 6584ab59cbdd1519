"""The report's figures, as SVG that scales with the page."""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure

from fes_mj.crosscheck import reference_power
from fes_mj.verification.details import Details
from fes_mj.verification.problems import Chain
from fes_mj.verification.refinement import Level, Refinement

WIDTH, HEIGHT = 6.4, 3.6  # inches; text stays readable at the width of a phone
STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "fes-mj",  # the same figure is the same file
    "font.family": "sans-serif",
    "font.size": 12,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e3e6ea",
    "legend.frameon": False,
    "axes.prop_cycle": cycler(color=["#1b6ca8", "#d1495b", "#3a7d44", "#8a6d3b"]),
}


def power_curve(each: Details) -> str:
    """Simulated crank power over the turn beside its massive and its quasi-static reference."""
    run = each.result.simulation
    angle, step = np.degrees(run.crank_angle), slice(None, None, max(1, len(run.crank_angle) // 720))
    with mpl.rc_context(STYLE):
        figure, axes = _axes("crank angle, deg", "crank power of one leg, W")
        axes.plot(angle[step], run.power[step], lw=4, alpha=0.35, label="simulated")
        axes.plot(angle[step], reference_power(run)[step], lw=1.4, label="inverse dynamics")
        axes.plot(angle[step], reference_power(run, 0.0)[step], lw=1.4, ls="--", label="quasi-static")
        axes.set_xticks(range(0, 361, 60))
        axes.set_title(each.case.name, loc="left", fontsize=12)
        return _svg(figure, axes)


def refinement_curve(name: str, refinement: Refinement) -> str:
    """Errors of one run over the time step."""
    steps = refinement.steps
    with mpl.rc_context(STYLE):
        figure, axes = _axes("time step, ms", "relative error, or gap in m")
        _line(axes, steps, "gap", f"loop gap, order {refinement.gap_order:.2f}")
        _line(axes, steps, "lost", f"energy lost, order {refinement.energy_order:.2f}")
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
    with mpl.rc_context(STYLE):
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
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    return figure, axes


def _svg(figure: Figure, axes: Any) -> str:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside upper center", ncols=3 if sum(map(len, labels)) < 50 else 2, fontsize=11
    )
    stream = io.StringIO()
    figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    return text[text.index("<svg") :]

"""Power of designs over the thighs and shanks of people."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import FloatArray
from fes_mj.common.style import INK, literal
from fes_mj.fit.population import PowerMap, Study
from fes_mj.linkage.design import Rider

_PERCENTILES = (5, 50, 95)
_MARKERS = {"men": "s", "women": "o"}


def population_figure(studies: Sequence[Study]) -> Figure:
    """Maps over thigh and shank, a column a design: above with the seat as drawn, below with the best seat.

    White is where nobody can ride.
    """
    figure = Figure(figsize=(2.6 + 1.9 * len(studies), 5.4), layout="constrained")
    axes = figure.subplots(2, len(studies), squeeze=False, sharex=True, sharey=True)
    powers = np.concatenate([found.power.ravel() for study in studies for found in (study.drawn, study.map)])
    levels = np.arange(np.floor(np.nanmin(powers)), np.ceil(np.nanmax(powers)) + 1)
    for column, study in zip(axes.T, studies, strict=True):
        for ax, found, seat in zip(column, (study.drawn, study.map), ("as drawn", "moved"), strict=True):
            mesh = _draw(ax, study, found, levels)
            ax.set_title(literal(f"{study.design.name}, seat {seat}"), loc="left", weight="bold")
            ax.label_outer()
    figure.colorbar(mesh, ax=axes, label="mean crank power, W")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=1 if len(studies) == 1 else 3)
    return figure


def _draw(ax: Axes, study: Study, found: PowerMap, levels: FloatArray) -> Any:
    """The map, the sample as dots, percentiles 5, 50 and 95 of thigh and shank, the paper's rider."""
    mesh = ax.contourf(100 * found.thigh, 100 * found.shank, found.power.T, levels)
    for who, riders in study.riders.items():
        ax.plot(100 * riders.legs.thigh, 100 * riders.legs.shank, ",", color=INK, alpha=0.4)
        some = [riders.people.rider(percentile) for percentile in _PERCENTILES]
        legs = [100 * each.thigh for each in some], [100 * each.shank for each in some]
        label = f"{who}, percentiles {', '.join(map(str, _PERCENTILES))}"
        ax.plot(*legs, _MARKERS[who] + "-", color=INK, lw=0.8, ms=5, mfc="white", label=label)
    ax.plot(100 * Rider.thigh, 100 * Rider.shank, "*", ms=9, color=INK, mfc="white", label="the paper's rider")
    ax.set(xlabel="thigh, cm", ylabel="shank, knee to axle level, cm")
    ax.grid(visible=False)
    return mesh

"""Power of designs over the thighs and shanks of people."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import FloatArray
from fes_mj.common.style import INK, literal
from fes_mj.fit.population import PopulationFit, PowerMap
from fes_mj.linkage.design import Rider

_PERCENTILES = (5, 50, 95)
_MARKERS = {"men": "s", "women": "o"}


def population_figure(fits: Sequence[PopulationFit]) -> Figure:
    """Maps over thigh and shank, a column a design: above with the seat as drawn, below with the best seat.

    White is where nobody can ride.
    """
    figure = Figure(figsize=(2.2 + 1.0 * len(fits), 4.2), layout="constrained")
    axes = figure.subplots(2, len(fits), squeeze=False, sharex=True, sharey=True)
    powers = np.concatenate([power_map.power.ravel() for fit in fits for power_map in (fit.drawn, fit.map)])
    levels = np.arange(np.floor(np.nanmin(powers)), np.ceil(np.nanmax(powers)) + 1)
    for column, fit in zip(axes.T, fits, strict=True):
        for ax, power_map, seat in zip(column, (fit.drawn, fit.map), ("as drawn", "moved"), strict=True):
            mesh = _draw(ax, fit, power_map, levels)
            ax.set_title(literal(f"{fit.design.name}, {seat}"), loc="left", size=9, weight="bold")
            ax.label_outer()
    figure.colorbar(mesh, ax=axes, label="mean crank power, W, as the paper assumes")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=1 if len(fits) == 1 else 3)
    return figure


def _draw(ax: Axes, fit: PopulationFit, power_map: PowerMap, levels: FloatArray) -> Any:
    """The map, the sample as dots, percentiles 5, 50 and 95 of thigh and shank, the paper's rider."""
    mesh = ax.contourf(100 * power_map.thigh, 100 * power_map.shank, power_map.power.T, levels)
    for who, sample in fit.riders.items():
        ax.plot(100 * sample.legs.thigh, 100 * sample.legs.shank, ",", color=INK, alpha=0.4)
        riders = [sample.people.rider(percentile) for percentile in _PERCENTILES]
        legs = [100 * rider.thigh for rider in riders], [100 * rider.shank for rider in riders]
        label = f"{who}, percentiles {', '.join(map(str, _PERCENTILES))}"
        ax.plot(*legs, _MARKERS[who] + "-", color=INK, lw=0.8, ms=4, mfc="white", label=label)
    ax.plot(100 * Rider.thigh, 100 * Rider.shank, "*", ms=8, color=INK, mfc="white", label="the paper's rider")
    ax.set(xlabel="thigh, cm", ylabel="shank (knee to axle), cm")
    ax.grid(visible=False)
    return mesh

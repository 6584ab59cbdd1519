"""Power of a design over the thighs and shanks of people."""

import numpy as np
from matplotlib.figure import Figure

from fes_mj.design import Rider
from fes_mj.population import Study
from fes_mj.style import FAINT, INK

_PERCENTILES = (5, 50, 95)
_MARKERS = {"men": "s", "women": "o"}


def population_figure(study: Study) -> Figure:
    """Maps over thigh and shank, with the seat as drawn and with the best seat; white is where nobody can ride."""
    figure = Figure(figsize=(8.4, 4.0), layout="constrained")
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    maps = {"seat as drawn": study.drawn, "seat moved": study.map}
    powers = np.concatenate([each.power.ravel() for each in maps.values()])
    low, high = np.nanpercentile(powers, [1, 100])
    for ax, (title, found) in zip(axes, maps.items(), strict=True):
        shading = "gouraud" if np.isfinite(found.power).all() else "nearest"  # the first cannot leave anything out
        axis = 100 * found.thigh, 100 * found.shank
        mesh = ax.pcolormesh(*axis, found.power.T, vmin=low, vmax=high, shading=shading)
        for who, riders in study.riders.items():
            thigh, shank = 100 * riders.legs.thigh, 100 * riders.legs.shank
            ax.plot(thigh, shank, ".", color=INK, ms=1, alpha=0.25)
            points = [riders.people.rider(percentile) for percentile in _PERCENTILES]
            ax.plot(
                [100 * each.thigh for each in points],
                [100 * each.shank for each in points],
                _MARKERS[who] + "-",
                color=INK,
                lw=0.8,
                mfc="white",
                label=f"{who}, percentiles {', '.join(map(str, _PERCENTILES))}",
            )
        ax.plot(100 * Rider.thigh, 100 * Rider.shank, "*", ms=11, color="white", mec=INK, label="the paper's rider")
        ax.set_title(title, loc="left", weight="bold")
        ax.set(xlabel="thigh, cm", facecolor="white")
        ax.grid(visible=False)
    axes[0].set_ylabel("shank, knee to pedal axle's level, cm")
    figure.colorbar(mesh, ax=axes, label="mean crank power, W")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, labelcolor=FAINT)
    return figure

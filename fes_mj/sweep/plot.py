"""Mean crank power of a study in which one or two numbers vary, as a picture."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.style import STYLE
from fes_mj.common.writing import replacing
from fes_mj.sweep.study import NAMES, label
from fes_mj.sweep.sweep import Sweep

POWER = "mean crank power, W"


def write_plot(sweep: Sweep, path: Path) -> None:
    """Write a PNG with the power of all finished points: lines over one number, or a map over two."""
    numbers = sweep.study.varied_numbers
    names = [*NAMES, *numbers, "power_mean_W", "power_sd_W"]
    columns = {name: column.to_numpy() for name, column in zip(names, sweep.read(names).columns, strict=True)}
    with mpl.rc_context(STYLE), replacing(path) as temporary:
        figure = Figure(figsize=(6.4, 4.4), layout="constrained")
        axes = figure.subplots()
        (_lines if len(numbers) == 1 else _map)(axes, columns, *numbers)
        axes.set_xlabel(label(numbers[0]))
        figure.savefig(temporary, dpi=150)


def _lines(axes: Axes, columns: dict[str, Any], number: str) -> None:
    """A line for each design and moments, with a band of one standard deviation."""
    order = np.argsort(columns[number], kind="stable")
    at, power, deviation = (columns[name][order] for name in (number, "power_mean_W", "power_sd_W"))
    pairs = np.stack([columns["design"], columns["moments"]])[:, order]
    for pair in dict.fromkeys(zip(*pairs, strict=True)):
        line = np.all(pairs == np.array(pair, object)[:, None], axis=0)
        axes.plot(at[line], power[line], ".-", label=", ".join(pair))
        axes.fill_between(at[line], (power - deviation)[line], (power + deviation)[line], alpha=0.2, lw=0)
    axes.set_ylabel(POWER)
    axes.legend()


def _map(axes: Axes, columns: dict[str, Any], number: str, other: str) -> None:
    """Every point in the colour of its power."""
    x, y, power = (columns[name] for name in (number, other, "power_mean_W"))
    none = np.isnan(power)
    side = float(np.clip(200 / np.sqrt(len(power)), 1, 12))
    axes.scatter(x[none], y[none], side**2, "0.85", marker="s", lw=0)
    axes.set_title("grey: no power, see the column why" if none.any() else "", loc="left")
    points = axes.scatter(x[~none], y[~none], side**2, power[~none], marker="s", lw=0)
    axes.figure.colorbar(points, ax=axes, label=POWER)
    axes.set_ylabel(label(other))

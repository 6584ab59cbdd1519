"""Rings of crank angles, as seen from the rider's right: the rider faces right, the crank turns clockwise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from fes_mj.common.style import BAD, FAINT, GOOD, INK, SERIES, STYLE, literal
from fes_mj.common.units import KMH
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import turning
from fes_mj.riding.starts import Starts
from fes_mj.riding.stimulation import CORE, MUSCLES, Window
from fes_mj.viewing.charts import svg_text

_INNER, _RING = 0.35, 0.2  # radius of the first ring, distance of two
_OUTER = _INNER + 3 * _RING


def windows_figure(design: Design, windows: Sequence[Window]) -> Figure:
    """Where the right leg's muscle groups drive the crank, and their cores, a ring a group."""
    figure = Figure(figsize=(4.4, 5.2))
    axes = clockwise(figure.add_subplot(projection="polar"))
    for window in (window for window in windows if window.leg == "right"):
        place = list(MUSCLES).index(window.muscle)
        for (start, end), shade in ((window.works, 0.35), (window.core, 1.0)):
            draw_window(axes, place, (start + end) / 2, end - start, alpha=shade, zorder=2)
    finish_rings(axes, design)
    figure.suptitle(literal(f"{design.name}: where muscles drive the crank"), weight="bold", y=0.98)
    muscles = zip(MUSCLES.items(), SERIES, strict=True)
    labels = [
        *(Patch(color=colour, label=f"{name} ({muscle.moment})") for (name, muscle), colour in muscles),
        Patch(color=FAINT, alpha=0.35, label="drives the crank"),
        Patch(color=FAINT, label=f"core: at least {CORE:g} of its best"),
    ]
    figure.legend(handles=labels, loc="lower center", ncols=2)
    figure.subplots_adjust(bottom=0.2, top=0.86)
    return figure


def draw_window(axes: Any, place: int, middle: float, width: float, **look: Any) -> None:
    """A window of crank angles, rad, in the ring of a muscle group, by its place."""
    height = _INNER + _RING * place
    axes.bar(middle, 0.8 * _RING, width=width, bottom=height, color=SERIES[place], lw=0, **look)


def finish_rings(axes: Any, design: Design) -> None:
    """Around the rings: angles, and a line where the leg is bent most."""
    top = turning(design).top_dead_centre
    axes.plot([top, top], [0, _OUTER], color=INK, lw=1, ls=(0, (4, 2)), zorder=3)
    axes.text(top, 0.1, "TDC", ha="center", va="center", fontsize=8, color=INK, backgroundcolor="white", zorder=4)
    axes.set(ylim=(0, _OUTER), yticks=[], xticks=np.radians(np.arange(0, 360, 45)))


def starts_svg(starts: Starts) -> str:
    """From which crank angles a tricycle starts from rest, as SVG."""
    ride, width = starts.ride, 2 * np.pi / len(starts.crank_angle)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.6, 4.6))
        axes = clockwise(figure.add_axes((0.12, 0.08, 0.76, 0.76), projection="polar"))
        colours = [GOOD if works else BAD for works in starts.works]
        axes.bar(starts.crank_angle, 0.35, width=width, bottom=0.65, color=colours, lw=0)
        axes.set(ylim=(0, 1), yticks=[])
        axes.grid(visible=False)
        launch = "no launch helps" if starts.launch is None else f"launch needed: {starts.launch / KMH:.1f} km/h"
        slope = "climbs nothing" if starts.slope is None else f"climbs {100 * starts.slope:.1f} %"
        lines = ((0.62, f"starts from {100 * starts.share:.0f} %", INK), (0.5, launch, FAINT), (0.38, slope, FAINT))
        for height, text, colour in lines:
            axes.text(0.5, height, text, ha="center", va="center", color=colour, transform=axes.transAxes)
        title = f"{ride.design.name}, {ride.drive.name}, {ride.transmission}, {100 * ride.road.slope:g} %"
        figure.text(0.5, 0.94, literal(title), ha="center", size=11, weight="bold")
        return f"<!-- Written by fes_mj: starts from rest -->\n{svg_text(figure)}"


def clockwise(axes: Any) -> Any:
    """Polar axes whose angle is 0 where the crank points backwards."""
    axes.set_theta_zero_location("W")
    axes.set_theta_direction(-1)
    return axes

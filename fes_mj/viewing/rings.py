"""Rings of crank angles, as seen from the rider's right: the rider faces right, the crank turns clockwise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from fes_mj.common.style import BAD, FAINT, GOOD, INK, SERIES, STYLE, literal
from fes_mj.common.units import KMH, RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import turning
from fes_mj.riding.starts import Starts
from fes_mj.riding.stimulation import CORE, MUSCLES, Window
from fes_mj.viewing.charts import svg_text

_RING, _WIDTH = 0.28, 0.11  # distance of two rings; of the band of a window, beside that of its stimulation
_INNER = 0.30


def windows_figure(design: Design, windows: Sequence[Window]) -> Figure:
    """The right leg's stimulation windows, a ring a muscle and a panel a cadence.

    Where each muscle group drives the crank, its core, and when to stimulate for that.
    """
    cadences = list(dict.fromkeys(window.cadence for window in windows))
    figure = Figure(figsize=(4.4 * len(cadences), 5.4))
    for number, cadence in enumerate(cadences):
        axes = _clockwise(figure.add_subplot(1, len(cadences), number + 1, projection="polar"))
        _rings(axes, design, [window for window in windows if window.cadence == cadence and window.leg == "right"])
    title = f"{design.name}: when to stimulate, lag {windows[0].lag:g} s"
    figure.suptitle(literal(title), weight="bold", y=0.98)
    muscles = zip(MUSCLES.items(), SERIES, strict=True)
    labels = [
        *(Patch(color=colour, label=f"{name} ({muscle.moment})") for (name, muscle), colour in muscles),
        Patch(color=FAINT, alpha=0.25, label="drives the crank"),
        Patch(color=FAINT, alpha=0.55, label=f"core: at least {CORE:g} of its best"),
        Patch(color=FAINT, label="stimulate, for the core"),
    ]
    figure.legend(handles=labels, loc="lower center", ncols=2 if len(cadences) == 1 else 3)
    figure.subplots_adjust(bottom=0.2, top=0.86, wspace=0.35)
    return figure


def _rings(axes: Any, design: Design, windows: Sequence[Window]) -> None:
    for window in windows:
        place = list(MUSCLES).index(window.muscle)
        colour, height = SERIES[place], _INNER + _RING * place
        core = window.core[0] - window.lead, window.core[1] - window.lead
        look = {"color": colour, "lw": 0, "zorder": 2}
        bands = ((window.works, height, 0.25), (window.core, height, 0.55), (core, height + _WIDTH, 1.0))
        for (start, end), bottom, shade in bands:
            axes.bar((start + end) / 2, _WIDTH, width=end - start, bottom=bottom, alpha=shade, **look)
    top = turning(design).top_dead_centre
    axes.plot([top, top], [0, _INNER + 3 * _RING], color=INK, lw=1, ls=(0, (4, 2)), zorder=3)
    axes.text(top, 0.1, "TDC", ha="center", va="center", fontsize=8, color=INK, backgroundcolor="white", zorder=4)
    axes.set(ylim=(0, _INNER + 3 * _RING), yticks=[], xticks=np.radians(np.arange(0, 360, 45)))
    cadence, lead = windows[0].cadence, math.degrees(windows[0].lead)
    speed = f"{cadence / RPM:.1f} rpm ({cadence / (2 * math.pi):.2f} Hz)"
    axes.set_title(f"{speed}, advanced by {lead:.0f} deg", size=9, pad=14)


def starts_svg(starts: Starts) -> str:
    """From which crank angles a tricycle starts from rest, as SVG."""
    ride, width = starts.ride, 2 * np.pi / len(starts.crank_angle)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.6, 4.6))
        axes = _clockwise(figure.add_axes((0.12, 0.08, 0.76, 0.76), projection="polar"))
        colours = [GOOD if works else BAD for works in starts.works]
        axes.bar(starts.crank_angle, 0.35, width=width, bottom=0.65, color=colours, lw=0)
        axes.set(ylim=(0, 1), yticks=[])
        axes.grid(visible=False)
        launch = "no launch helps" if starts.launch is None else f"launch needed: {starts.launch / KMH:.1f} km/h"
        slope = "climbs nothing" if starts.slope is None else f"climbs {100 * starts.slope:.1f} %"
        lines = ((0.62, f"starts from {100 * starts.share:.0f} %", INK), (0.5, launch, FAINT), (0.38, slope, FAINT))
        for height, text, colour in lines:
            axes.text(0.5, height, text, ha="center", va="center", color=colour, transform=axes.transAxes)
        title = f"{ride.design.name}, {ride.moments.name}, {ride.transmission}, {100 * ride.road.slope:g} %"
        figure.text(0.5, 0.94, literal(title), ha="center", size=11, weight="bold")
        return f"<!-- Written by fes_mj: starts from rest -->\n{svg_text(figure)}"


def _clockwise(axes: Any) -> Any:
    """Polar axes whose angle is 0 where the crank points backwards."""
    axes.set_theta_zero_location("W")
    axes.set_theta_direction(-1)
    return axes

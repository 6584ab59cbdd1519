"""A ring of crank angles: from which of them a tricycle starts from rest."""

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from fes_mj.common.style import BAD, FAINT, GOOD, INK, STYLE, literal
from fes_mj.common.units import KMH
from fes_mj.riding.starts import Starts
from fes_mj.viewing.charts import svg_text

MARK = "<!-- Written by fes_mj: starts from rest -->"


def starts_svg(starts: Starts) -> str:
    """The ring as SVG, as seen from the rider's right: the rider faces right, the crank turns clockwise."""
    ride, width = starts.ride, 2 * np.pi / len(starts.crank_angle)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(4.6, 4.6))
        axes = figure.add_axes((0.12, 0.08, 0.76, 0.76), projection="polar")
        axes.set_theta_zero_location("W")  # type: ignore[attr-defined]
        axes.set_theta_direction(-1)  # type: ignore[attr-defined]
        colours = [GOOD if works else BAD for works in starts.works]
        axes.bar(starts.crank_angle, 0.35, width=width, bottom=0.65, color=colours, lw=0)
        axes.set(ylim=(0, 1), yticks=[])
        axes.grid(visible=False)
        launch = "no launch helps" if starts.launch is None else f"launch needed: {starts.launch / KMH:.1f} km/h"
        slope = "climbs nothing" if starts.slope is None else f"climbs {100 * starts.slope:.1f} %"
        for height, text, colour in (
            (0.12, f"starts from {100 * starts.share:.0f} %", INK),
            (0, launch, FAINT),
            (-0.12, slope, FAINT),
        ):
            axes.text(0.5, 0.5 + height, text, ha="center", va="center", color=colour, transform=axes.transAxes)
        title = f"{ride.design.name}, {ride.moments.name}, {ride.transmission}, {100 * ride.road.slope:g} %"
        figure.text(0.5, 0.94, literal(title), ha="center", size=11, weight="bold")
        return f"{MARK}\n{svg_text(figure)}"

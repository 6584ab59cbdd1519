"""Stimulation windows as rings: where each muscle group drives the crank, its core, and when to stimulate for that."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from fes_mj.common.style import FAINT, INK, SERIES, STYLE, literal
from fes_mj.common.units import RPM
from fes_mj.common.writing import replacing
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import turning
from fes_mj.riding.stimulation import CORE, MUSCLES, Window
from fes_mj.viewing.charts import any_letters

_RING, _WIDTH = 0.28, 0.11  # distance of two rings; of the band of a window, beside that of its stimulation
_INNER = 0.30


def write_plot(path: Path, design: Design, windows: Sequence[Window]) -> None:
    """Write the right leg's windows, a ring a muscle and a panel a cadence, as the suffix of `path` says.

    As seen from the rider's right: the rider faces right, the crank turns clockwise.
    """
    cadences = list(dict.fromkeys(window.cadence for window in windows))
    with mpl.rc_context(STYLE), any_letters(), replacing(path) as temporary:
        figure = Figure(figsize=(4.4 * len(cadences), 5.4))
        for number, cadence in enumerate(cadences):
            axes: Any = figure.add_subplot(1, len(cadences), number + 1, projection="polar")
            _rings(axes, design, [each for each in windows if each.cadence == cadence and each.leg == "right"])
        title = f"{design.name}: when to stimulate, lag {windows[0].lag:g} s"
        figure.suptitle(literal(title), weight="bold", y=0.98)
        labels = [
            *(
                Patch(color=colour, label=f"{name} ({muscle.moment})")
                for (name, muscle), colour in zip(MUSCLES.items(), SERIES, strict=True)
            ),
            Patch(color=FAINT, alpha=0.25, label="drives the crank"),
            Patch(color=FAINT, alpha=0.55, label=f"core: at least {CORE:g} of its best"),
            Patch(color=FAINT, label="stimulate, for the core"),
        ]
        figure.legend(handles=labels, loc="lower center", ncols=2 if len(cadences) == 1 else 3)
        figure.subplots_adjust(bottom=0.2, top=0.86, wspace=0.35)
        figure.savefig(temporary, dpi=150)


def _rings(axes: Any, design: Design, windows: Sequence[Window]) -> None:
    axes.set_theta_zero_location("W")
    axes.set_theta_direction(-1)
    for window in windows:
        place = list(MUSCLES).index(window.muscle)
        colour, height = SERIES[place], _INNER + _RING * place
        core = window.core[0] - window.lead, window.core[1] - window.lead
        for (start, end), bottom, shade in (
            (window.works, height, 0.25),
            (window.core, height, 0.55),
            (core, height + _WIDTH, 1.0),
        ):
            axes.bar(
                (start + end) / 2, _WIDTH, width=end - start, bottom=bottom, color=colour, alpha=shade, lw=0, zorder=2
            )
    top = turning(design).top_dead_centre
    axes.plot([top, top], [0, _INNER + 3 * _RING], color=INK, lw=1, ls=(0, (4, 2)), zorder=3)
    axes.text(top, 0.1, "TDC", ha="center", va="center", fontsize=8, color=INK, backgroundcolor="white", zorder=4)
    axes.set(ylim=(0, _INNER + 3 * _RING), yticks=[], xticks=np.radians(np.arange(0, 360, 45)))
    cadence, lead = windows[0].cadence, math.degrees(windows[0].lead)
    speed = f"{cadence / RPM:.1f} rpm ({cadence / (2 * math.pi):.2f} Hz)"
    axes.set_title(f"{speed}, advanced by {lead:.0f} deg", size=9, pad=14)

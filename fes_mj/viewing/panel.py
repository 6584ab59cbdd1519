"""The right half of a video: curves that are drawn once, and a copy of them with a cursor for each frame."""

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image, ImageDraw

from fes_mj.common.arrays import Picture
from fes_mj.common.style import BAD, FAINT, GOOD, INK, STYLE, literal
from fes_mj.linkage.design import Design
from fes_mj.viewing.charts import any_letters

_DPI = 100
_LEFT, _RIGHT = 0.05, 0.97  # of the width, where lines of text begin and end


class Panel:
    """A figure of so many pixels, which `draw` fills and whose axes it returns."""

    def __init__(self, width: int, height: int, draw: Callable[[Figure], list[Axes]]) -> None:
        self._height = height
        with mpl.rc_context(STYLE), any_letters():
            figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
            canvas = FigureCanvasAgg(figure)
            self._axes = draw(figure)
            canvas.draw()  # type: ignore[no-untyped-call]
        self._background = np.asarray(canvas.buffer_rgba())[..., :3].copy()  # type: ignore[no-untyped-call]

    def with_cursor(self, x: float, y: float | None = None, colour: str = INK) -> Picture:
        """The panel with a line across all axes at x, and a dot at y on it; shape (height, width, 3)."""
        picture = Image.fromarray(self._background)
        draw = ImageDraw.Draw(picture)
        for axes in self._axes:
            draw.line([self._pixel(axes, x, end) for end in axes.get_ylim()], fill=INK, width=2)
            if y is not None:
                across, down = self._pixel(axes, x, y)
                draw.ellipse([across - 6, down - 6, across + 6, down + 6], fill=colour, outline="white", width=2)
        return np.asarray(picture)

    def _pixel(self, axes: Axes, x: float, y: float) -> tuple[float, float]:
        across, up = axes.transData.transform((x, y))
        return float(across), self._height - float(up)


def write_title(figure: Figure, design: Design, below: str) -> None:
    """At the top: the design's name and kind, and what is said of the run."""
    _fit(figure, 0.955, f"{design.name.upper()}: {design.linkage.architecture.title}", size=13, weight="bold")
    _fit(figure, 0.925, below, size=11, color=FAINT)


def write_verdict(figure: Figure, text: str, good: bool) -> None:
    """At the bottom, green or red."""
    _fit(figure, 0.02, text, size=12, weight="bold", color=GOOD if good else BAD)


def _fit(figure: Figure, y: float, text: str, size: float, **look: Any) -> None:
    """A line of text of this size, or of the largest with which it fits into the width."""
    line = figure.text(_LEFT, y, literal(text), size=size, **look)
    width = line.get_window_extent().width / figure.bbox.width
    line.set_fontsize(size * min(1.0, (_RIGHT - _LEFT) / width))

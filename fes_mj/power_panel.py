"""The right half of the video: crank power over the turn, dynamic and static, with a cursor that moves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from fes_mj.crosscheck import CrossCheck, reference_power

DYNAMIC, STATIC, REFERENCE = "#1f4fd8", "#d97a00", "#8a8f98"
_DPI = 100


class PowerPanel:
    """Draws the curves once; each frame is a copy with the cursor at another step."""

    def __init__(self, result: CrossCheck, width: int, height: int) -> None:
        run = result.simulation
        steps = len(run.crank_angle) // run.turns
        self._angle = np.degrees(run.crank_angle[:steps]) % 360
        self._power = run.power[:steps]
        figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
        canvas = FigureCanvasAgg(figure)
        self._axes = figure.add_axes((0.14, 0.30, 0.81, 0.49))
        self._draw(result, steps)
        _write_facts(figure, result)
        canvas.draw()
        self._background = np.asarray(canvas.buffer_rgba())[..., :3].copy()
        self._height = height

    def _draw(self, result: CrossCheck, steps: int) -> None:
        run, axes, order = result.simulation, self._axes, np.argsort(self._angle)
        curves = (
            ("exact inverse dynamics", reference_power(run), REFERENCE, {"lw": 5, "alpha": 0.45}),
            ("MuJoCo, with masses and weight", run.power, DYNAMIC, {"lw": 1.8}),
            ("quasi-static, no masses", reference_power(run, 0.0), STATIC, {"lw": 1.8, "ls": (0, (5, 2))}),
        )
        for label, power, colour, style in curves:
            axes.plot(self._angle[order], power[:steps][order], color=colour, label=label, **style)
        axes.axhline(0, color="black", lw=0.8)
        axes.axhline(len(run.legs) * run.power_mean, color=DYNAMIC, lw=1, ls=":")
        axes.set(xlim=(0, 360), xticks=range(0, 361, 60), xlabel="crank angle, deg", ylabel="crank power, W")
        axes.grid(alpha=0.25)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), frameon=False, fontsize=11)

    def frame(self, step: int) -> NDArray[np.uint8]:
        """The panel with the cursor at a step of the turn, shape (height, width, 3)."""
        picture = Image.fromarray(self._background)
        draw = ImageDraw.Draw(picture)
        (x, y), (_, bottom), (_, top) = (
            self._pixel(self._angle[step], power) for power in (self._power[step], *self._axes.get_ylim())
        )
        draw.line([(x, bottom), (x, top)], fill="#20242c", width=2)
        draw.ellipse([x - 6, y - 6, x + 6, y + 6], fill=DYNAMIC, outline="white", width=2)
        return np.asarray(picture)

    def _pixel(self, angle: float, power: float) -> tuple[float, float]:
        x, y = self._axes.transData.transform((angle, power))
        return float(x), self._height - float(y)


def _write_facts(figure: Any, result: CrossCheck) -> None:
    """Title above and the numbers below the curves."""
    run, static = result.simulation, result.static
    design, rpm = run.design, run.cadence * 30 / math.pi
    figure.text(0.05, 0.955, f"{design.name.upper()}: {design.linkage.architecture.title}", size=13, weight="bold")
    legs = "one leg" if len(run.legs) == 1 else "two legs"
    figure.text(
        0.05, 0.925, f"joint moments {run.moments.name.upper()}, {rpm:.1f} rpm, {legs}", size=11, color="#444a55"
    )
    facts = (
        ("mean power, dynamic", f"{run.power_mean:.3f} W a leg", DYNAMIC),
        ("mean power, quasi-static", f"{static.power_mean:.3f} W a leg", STATIC),
        ("difference", result.difference_text, "black"),
        ("largest loop gap", f"{1e6 * run.loop_gap_max:.1f} µm", "black"),
    )
    for row, (name, value, colour) in enumerate(facts):
        figure.text(0.14, 0.185 - 0.038 * row, name, size=12, color=colour)
        figure.text(0.95, 0.185 - 0.038 * row, value, size=12, color=colour, ha="right", family="DejaVu Sans")
    verdict = "dynamic and static agree" if result.agrees else "dynamic and static DO NOT agree"
    figure.text(0.14, 0.025, verdict, size=12, weight="bold", color="#1a7f37" if result.agrees else "#c01c28")

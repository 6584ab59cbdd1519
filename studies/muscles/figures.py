"""Pictures of results/muscles.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.style import BY_DESIGN, FAINT, INK, SERIES
from fes_mj.linkage.design_file import DESIGNS, SIX_BARS, load_design
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.by_angle import Gains
from fes_mj.muscles.fatigue import recoveries
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.setting import Setting
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.viewing.charts import write_figure
from studies.muscles.gains import MEASURED_W, WIDTHS, known_gains, paper_gains
from studies.muscles.use import MINUTES, tired

NAMES = [name.upper() for name in SIX_BARS]
Rows = Sequence[Mapping[str, Any]]


def write(folder: Path, tables: Mapping[str, Rows]) -> None:
    """All of them, as .png; tables: the page's, by title."""
    write_figure(folder / "muscles-null-test.png", null_test, known_gains())
    write_figure(folder / "muscles-gains.png", gains, tables)
    write_figure(folder / "muscles-windows.png", windows)
    write_figure(folder / "muscles-fatigue.png", over_time, tables["Power by cadence"])


def interval(axes: Axes, place: float, ends: Sequence[float], **look: Any) -> None:
    """5 to 95 % as a line, the median as a dot."""
    low, middle, high = ends
    axes.plot([low, high], [place, place], lw=2.5, solid_capstyle="round", **{**look, "label": None})
    axes.plot(middle, place, "o", ms=6, **look)


def unity(axes: Axes, label: str) -> None:
    axes.axvline(1, color=INK, lw=0.8, ls=(0, (4, 2)))
    axes.set(xlabel=label)


def null_test(gains: Gains) -> Figure:
    """What the paper's rule makes of riders who are known, beside what is true of them."""
    figure = Figure(figsize=(7.2, 3.4), layout="constrained")
    axes, cloud = figure.subplots(1, 2, width_ratios=(3, 2))
    ends, paper = (0.05, 0.5, 0.95), paper_gains()
    for place, name in enumerate(SIX_BARS):
        labels = ("true", "by angle, the paper's rule", "printed in the paper") if place == 0 else (None,) * 3
        interval(axes, place + 0.16, np.quantile(gains.true[place], ends), color=SERIES[0], label=labels[0])
        predicted = np.quantile(gains.by_angle[place], ends)
        interval(axes, place - 0.16, predicted, color=SERIES[1], label=labels[1])
        axes.plot(paper[name], place, "D", color=INK, ms=5, label=labels[2])
    axes.set_yticks(range(len(NAMES)), NAMES)
    axes.invert_yaxis()
    unity(axes, "power per the TRT's")
    axes.set_title("400 riders whose muscles are known, 5 to 95 %", loc="left", size=9)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1.08), ncols=3)
    number = SIX_BARS.index("d1")
    cloud.plot(gains.true[number], gains.by_angle[number], ".", color=SERIES[1], ms=4, alpha=0.6)
    cloud.plot([0, 2], [0, 2], color=FAINT, lw=0.8, ls=(0, (4, 2)))
    cloud.text(1.0, 0.9, "by angle = true", color=FAINT, rotation=38, size=8, ha="left", va="bottom")
    cloud.set(xlim=(0, 1.3), ylim=(0.8, 2.1), xlabel="true gain of D1", ylabel="gain of D1 by angle")
    return figure


def gains(tables: Mapping[str, Rows]) -> Figure:
    """Gains of every six-bar by rule, for the P1P2 riders; at the paper's gears and at one cadence."""
    figure = Figure(figsize=(7.2, 4.6), layout="constrained")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    rules = ("best, 100 deg", "measured", "stimulation-by-angle", "by-angle")
    colours = (SERIES[0], SERIES[2], FAINT, SERIES[1])
    for axes, title in zip(panels, ("Gains at the paper's gears", "Gains at 60 rpm"), strict=True):
        for row in tables[title]:
            if row["group"] == "p1p2" and row["timing"] in rules and row["design"] in NAMES:
                rule = rules.index(row["timing"])
                place = NAMES.index(row["design"]) + 0.18 * (rule - 1.5)
                ends = [row[f"gain {end} %"] for end in (5, 50, 95)]
                label = row["timing"] if row["design"] == NAMES[0] else None
                interval(axes, place, ends, color=colours[rule], label=label)
        axes.set_title(f"{title}, riders P1P2", loc="left", size=9)
        unity(axes, "power per the TRT's, 5 to 95 % of the riders")
    panels[0].set_yticks(range(len(NAMES)), NAMES)
    panels[0].invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    return figure


def windows() -> Figure:
    """Best windows of the five designs, and the power of both legs over the turn (P1P2, at the paper's gears)."""
    figure = Figure(figsize=(7.2, 3.8), layout="constrained")
    bars, power = figure.subplots(1, 2)
    riders = load_riders("p1p2")
    for place, (name, colour) in enumerate(BY_DESIGN.items()):
        design = load_design(name)
        setting = Setting.best(design, riders, design.linkage.cadence)
        for number, group in enumerate(MUSCLE_GROUPS):
            on, width = setting.windows.on[number, 0, 0], setting.windows.width[number, 0, 0]
            pieces = [(on, min(width, 360 - on)), (0, max(0, on + width - 360))]
            label = group if place == 0 else None
            bars.broken_barh(pieces, (place - 0.36 + 0.25 * number, 0.22), color=SERIES[number], lw=0, label=label)
        if name in ("trt", "r1", "d1"):
            power.plot(np.degrees(TURN_ANGLES), setting.together.mean(axis=0), color=colour, label=name.upper())
    bars.set_yticks(range(len(DESIGNS)), [name.upper() for name in DESIGNS])
    bars.invert_yaxis()
    for axes in (bars, power):
        axes.set(xlim=(0, 360), xticks=range(0, 361, 60), xlabel="crank angle, deg (0: crank backwards)")
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=3)
    power.axhline(0, color=INK, lw=0.8)
    power.set_ylabel("expected power of both legs, W; riders P1P2")
    return figure


def over_time(cadences: Rows) -> Figure:
    """Power of both legs by cadence, and on the TRT over half an hour."""
    figure = Figure(figsize=(7.2, 3.8), layout="constrained")
    by_cadence, course = figure.subplots(1, 2)
    rows = [row for row in cadences if row["group"] == "p1p2"]
    for name, colour in BY_DESIGN.items():
        by_cadence.plot(
            [row["rpm"] for row in rows], [row[f"{name.upper()}, W"] for row in rows], "o-", ms=3, color=colour,
            label=name.upper(),
        )  # fmt: skip
    by_cadence.axhspan(*MEASURED_W, color=FAINT, alpha=0.15, lw=0)
    by_cadence.text(21, MEASURED_W[0] + 1, "measured FES cycling", size=8, color=FAINT)
    by_cadence.set(xlabel="cadence, rpm", ylabel="expected power of both legs, W; riders P1P2", ylim=(0, None))
    by_cadence.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=5)
    riders, trt = load_riders("p1p2"), load_design("trt")
    for width, colour in zip(WIDTHS, SERIES, strict=True):
        turn, _ = best_turn(riders, trt, duty=width / 360)
        for (title, recovery), style in zip(recoveries().items(), ("-", (0, (4, 2))), strict=True):
            label = f"{width} deg, {title}"
            course.plot(MINUTES, tired(turn, recovery), color=colour, ls=style, label=label)
    course.set(xlabel="minutes on the TRT", xlim=(0, 30), ylim=(0, None))
    course.legend(loc="upper right")
    return figure

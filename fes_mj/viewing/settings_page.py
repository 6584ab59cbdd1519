"""One page for whoever sets a stimulator: windows of this seat, what they give and cost, how they go with cadence."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from fes_mj.common.style import BAD, FAINT, INK, SERIES, literal
from fes_mj.common.text import printable
from fes_mj.common.units import RPM
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.linkage.turning import CRANK_ZERO, turning
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.setting import MISTIMED, Setting
from fes_mj.muscles.settings import Settings
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.viewing.rings import clockwise, draw_window, finish_rings

A4 = 11.69, 8.27  # inches, landscape
_COLUMNS = (
    "gives, W", "effort", "W per\neffort",
    f"{MISTIMED:g} deg\nearly, W", f"{MISTIMED:g} deg\nlate, W",
)  # fmt: skip
_LONGEST = 40  # letters of a name


def settings_figure(settings: Settings) -> Figure:
    """The page: A4, landscape."""
    figure, main = Figure(figsize=A4), settings.main
    name = textwrap.shorten(printable(main.design.name), _LONGEST, placeholder=" ...")
    title = f"{name}: when to stimulate at {main.cadence / RPM:.1f} rpm"
    figure.text(0.04, 0.95, literal(title), size=16, weight="bold")
    figure.text(0.04, 0.93, literal(_for_whom(settings)), size=9, color=FAINT, va="top", linespacing=1.4)
    _ring(clockwise(figure.add_axes((0.04, 0.5, 0.27, 0.34), projection="polar")), main)
    _table(figure.add_axes((0.34, 0.625, 0.63, 0.23)), main)
    figure.text(0.345, 0.50, literal(_totals(main)), size=9, va="bottom", linespacing=1.5)
    _turn(figure.add_axes((0.06, 0.145, 0.25, 0.27)), main)
    _by_cadence(figure.add_axes((0.38, 0.145, 0.29, 0.27)), settings)
    _powers(figure.add_axes((0.74, 0.145, 0.23, 0.27)), settings)
    figure.text(0.04, 0.02, literal(_notes(settings)), size=8, color=FAINT, va="bottom", linespacing=1.4)
    return figure


def _for_whom(settings: Settings) -> str:
    seat, riders = settings.seat, settings.main.riders
    low, high = seat["knee_flexion_deg"]
    return (
        f"this seat: hip to crank centre {seat['hip_to_crank_centre_m']:.3f} m, seat angle "
        f"{seat['seat_angle_deg'] % 360:.0f} deg, crank {seat['crank_m']:.3f} m; this rider: thigh "
        f"{seat['thigh_m']:.2f} m, shank {seat['shank_m']:.2f} m, knee bent by {low:.0f} to {high:.0f} deg\n"
        f"muscles: {printable(riders.name)}, {len(riders)} riders who may be this one; +-: standard deviation over "
        "them, bands: nine of ten"
    )


def _totals(setting: Setting) -> str:
    content = setting.summary()
    low, high = setting.tired
    both = "" if setting.legs == 1 else f"Both legs: {content['power_two_legs_W']:.1f} W, "
    lines = (
        f"{both}{'one' if both else 'One'} leg {content['power_mean_W']:.1f} +- {content['power_sd_W']:.1f} W; "
        f"{'both ' if both else ''}after half an hour {low:.0f} to {high:.0f} W.",
        f"Least over the turn {setting.together.mean(axis=0).min():.1f} W, below zero for "
        f"{100 * content['negative_share']:.0f} % of it.",
        f"Stimulation: {content['stimulation_effort']:.2f} of the measurement's; {content['power_per_effort_W']:.1f} W "
        "of a leg for as much as the measurement's.",
        f"{MISTIMED:g} deg early costs {100 * content['early_loss_share']:.0f} %, late "
        f"{100 * content['late_loss_share']:.0f} % of the power. No window is wider than {360 * setting.duty:.0f} deg "
        f"({100 * setting.duty:.0f} % of the turn), as asked.",
    )
    return "\n".join(lines)


def _notes(settings: Settings) -> str:
    top = np.degrees(turning(settings.main.design).top_dead_centre)
    text = (
        f"Crank angles in deg, 0: {CRANK_ZERO}; they grow as the tricycle goes forward. TDC: the right leg bent most, "
        f"{top:.1f} deg. From the first angle on the current rises within {ramp():g} s, at the second it has come "
        "down. Delay, rise and fall of the muscles are counted in: lead by nothing more. Effort: share of the turn x "
        "strength x largest force, per that of the measurement. Absolute power is hardly known. Another seat, rider "
        "or cadence needs other windows. Begin with little current and with a therapist."
    )
    return textwrap.fill(text, 175)


def _ring(axes: Any, setting: Setting) -> None:
    """Windows of the right leg, a ring a group; the left leg's, half a turn later, pale."""
    windows = setting.windows
    for number, group in enumerate(MUSCLE_GROUPS):
        on, width = (np.radians(values[number, 0, 0]) for values in (windows.on, windows.width))
        for leg, shade in zip(TWO_LEGS[: setting.legs], (1.0, 0.22), strict=False):
            label = group if shade == 1 else None
            draw_window(axes, number, on + width / 2 + leg.lag, width, alpha=shade, label=label)
    finish_rings(axes, setting.design)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3)


def _table(axes: Axes, setting: Setting) -> None:
    rows, cells = [*setting.records()], []
    for number, right in enumerate(rows[:: setting.legs]):
        of_group = rows[setting.legs * number :][: setting.legs]
        ends = [row[f"{end}_deg"] for row in of_group for end in ("on", "off")]
        per = right["power_per_effort_W"]
        cells.append(
            [
                right["muscle"],
                *("-" if end is None else f"{end:.0f}" for end in ends),
                f"{right['power_W']:.1f} +- {right['power_sd_W']:.1f}",
                f"{right['stimulation_effort']:.2f}",
                "-" if per is None else f"{per:.1f}",
                *("-" if per is None else f"{-right[f'{when}_loss_W']:.1f}" for when in ("early", "late")),
            ]
        )
    axes.axis("off")
    legs = [row["leg"] for row in rows[: setting.legs]]
    columns = ["", *(name for leg in legs for name in (f"{leg} on", "off")), *_COLUMNS]
    widths = [0.16, *([0.09, 0.07] * setting.legs), 0.14, 0.08, 0.09, 0.105, 0.105]
    table = axes.table(cells, colLabels=columns, colWidths=widths, cellLoc="center", bbox=Bbox.unit())
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    for (row, column), cell in table.get_celld().items():
        cell.set(edgecolor="#d9dce1", lw=0.6)
        if row == 0:
            cell.get_text().set(weight="bold", size=8)
            cell.set_facecolor("#f2f3f5")
        elif column == 0:
            cell.get_text().set(color=SERIES[row - 1], weight="bold")
        elif column in (1, 2):
            cell.get_text().set(weight="bold", size=11)


def _turn(axes: Axes, setting: Setting) -> None:
    """Power of the legs over the turn, with what 90 % of the riders give."""
    degrees, together = np.append(np.degrees(TURN_ANGLES), 360), setting.together
    closed = np.concatenate([together, together[:, :1]], axis=1)
    low, high = np.quantile(closed, (0.05, 0.95), axis=0)
    axes.fill_between(degrees, low, high, color=SERIES[0], alpha=0.18, lw=0)
    axes.plot(degrees, closed.mean(axis=0), color=SERIES[0])
    axes.axhline(0, color=BAD, lw=0.8)
    axes.set(xlim=(0, 360), xticks=range(0, 361, 90), xlabel="crank angle, deg", ylabel="W")
    axes.set_title(f"power of {_legs(setting)}", size=9, loc="left")


def _by_cadence(axes: Axes, settings: Settings) -> None:
    """The right leg's windows, a line a cadence and group."""
    names = [f"{setting.cadence / RPM:.0f}" for setting in settings.by_cadence]
    for place, setting in enumerate(settings.by_cadence):
        for number, colour in enumerate(SERIES):
            on, width = setting.windows.on[number, 0, 0], setting.windows.width[number, 0, 0]
            pieces = [(on, min(width, 360 - on)), (0, max(0, on + width - 360))]
            axes.broken_barh(pieces, (place - 0.36 + 0.24 * number, 0.2), color=colour, lw=0)
    axes.set(xlim=(0, 360), xticks=range(0, 361, 90), xlabel="crank angle, deg", ylabel="rpm")
    axes.set_yticks(range(len(names)), names)
    axes.set_title("windows of the right leg by cadence", size=9, loc="left")


def _powers(axes: Axes, settings: Settings) -> None:
    """Power of the legs by cadence, over the riders; the main cadence marked."""
    rpm = np.array([setting.cadence / RPM for setting in settings.by_cadence])
    powers = np.array([setting.legs * setting.power.sum(axis=0) for setting in settings.by_cadence])
    mean, (low, high) = powers.mean(axis=1), np.quantile(powers, (0.05, 0.95), axis=1)
    axes.errorbar(rpm, mean, (mean - low, high - mean), fmt="o-", ms=4, color=SERIES[0])
    axes.axvline(settings.main.cadence / RPM, color=INK, lw=0.8, ls=(0, (4, 2)))
    axes.set(xlabel="cadence, rpm", ylabel="W", ylim=(min(0, float(low.min())), None))
    axes.set_title(f"power of {_legs(settings.main)}, 5 to 95 %", size=9, loc="left")


def _legs(setting: Setting) -> str:
    return "one leg" if setting.legs == 1 else "both legs"

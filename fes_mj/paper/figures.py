"""The paper's figures from our numbers, and one it lacks; knee cyan, hip magenta, total blue throughout."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fes_mj.crosscheck import reference_power
from fes_mj.design import BODIES
from fes_mj.kinematics import solve
from fes_mj.paper.printed import SIX_BARS
from fes_mj.paper.reconstruction import Posterior
from fes_mj.paper.runs import Runs
from fes_mj.segments import foot_points
from fes_mj.simulation import Simulation
from fes_mj.torque import GROUPS, JOINTS, TOP_DEAD_CENTRE, joint_angles, reference_ranges, source_angle

Posteriors = dict[str, Posterior]

COLOUR = {"knee": "#00a2bf", "hip": "#c4189a", "total": "#1f3fd8"}
LINK_COLOUR = {"thigh": "#b08968", "shank": "#cda27f", "crank": "#e07d28", "rocker": "#736bab", "coupler": "#5c945c"}
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
    "svg.hashsalt": "fes_mj",  # the same file from the same numbers
}
_TURN = np.radians(np.arange(0.0, 360.5, 1.0))


def moments_over_crank(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 1: recovered joint moments over the TRT's crank angle, with their standard deviation."""
    figure, axes = _grid(1, 2, (7.2, 3.0))
    for ax, (group, posterior) in zip(axes.flat, posteriors.items(), strict=True):
        for joint in JOINTS:
            _band(ax, np.degrees(_TURN + TOP_DEAD_CENTRE), posterior.curve(joint, _TURN), joint, joint)
        _label(ax, group.upper(), "crank angle, deg (top dead centre at 22.4)", "joint moment, N m")
    axes.flat[0].legend(title="mean, band of one sd")
    return figure


def power_of_the_trt(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 4: power of knee, hip and leg in the TRT over the turn."""
    figure, axes = _grid(1, 2, (7.2, 3.4))
    for ax, group in zip(axes.flat, GROUPS, strict=True):
        _power(ax, runs, "trt", group)
    _legend_below(figure, axes)
    return figure


def moments_over_joint_angle(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 5: the torque maps, extension and flexion told apart."""
    figure, axes = _grid(1, 2, (7.2, 3.2))
    for ax, (group, posterior) in zip(axes.flat, posteriors.items(), strict=True):
        _maps(ax, posterior, reference_ranges())
        _label(ax, group.upper(), "joint angle, deg", "joint moment, N m")
    _legend_below(figure, axes, columns=4)
    return figure


def design_space(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 10, as far as the text gives it: where crank centres and rocker pivots lie."""
    figure, axes = _grid(1, 1, (6.0, 3.4))
    (ax,) = axes.flat
    ax.plot(0, 0, "ko", label="hip")
    markers = dict(zip(SIX_BARS, "osD^", strict=True))
    for name in SIX_BARS:
        linkage = runs.static[name, "p1p2"].design.linkage
        pivot, centre = complex(linkage.ground), complex(linkage.crank_centre)
        ax.plot([pivot.real, centre.real], [pivot.imag, centre.imag], color="0.7", lw=1)
        for point, body, title in ((pivot, "rocker", "rocker pivot"), (centre, "crank", "crank centre")):
            label = f"{name.upper()} {title}"
            ax.plot(point.real, point.imag, markers[name], color=LINK_COLOUR[body], label=label)
    trt = runs.static["trt", "p1p2"].design.linkage.crank_centre
    ax.plot(trt.real, trt.imag, "*", ms=9, color=LINK_COLOUR["crank"], label="TRT crank centre")
    _label(ax, "Usable region of the paper: only in its picture, not in its text", "x, m (rider faces left)", "y, m")
    ax.set_aspect("equal")
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def truncated_maps(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 11: the part of the maps that R2 and D1 use, with the jumps at its ends; limits as in Figure 5."""
    figure, axes = _grid(2, 2, (7.2, 5.4))
    for row, name in zip(axes, ("r2", "d1"), strict=True):
        for ax, (group, posterior) in zip(row, posteriors.items(), strict=True):
            angles = joint_angles(runs.static[name, group].motion)
            _maps(ax, posterior, {joint: (angle.min(), angle.max()) for joint, (angle, _) in angles.items()})
            _label(ax, f"{name.upper()}, {group.upper()}", "joint angle, deg", "joint moment, N m")
            ax.set_xlim(*np.degrees((reference_ranges()["knee"][0] - 0.04, reference_ranges()["knee"][1] + 0.04)))
    _legend_below(figure, axes, columns=4)
    return figure


def power_of_r2_and_d1(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 12: power of R2 and D1 over the turn, both groups."""
    figure, axes = _grid(2, 2, (7.2, 6.0), sharey="row")
    for row, name in zip(axes, ("r2", "d1"), strict=True):
        for ax, group in zip(row, GROUPS, strict=True):
            _power(ax, runs, name, group)
    _legend_below(figure, axes)
    return figure


def d1_to_scale(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 13: D1 and a leg to scale at one crank angle, with the paths of knee, pedal and crank pin."""
    figure, axes = _grid(1, 1, (7.2, 4.2))
    (ax,) = axes.flat
    design = runs.static["d1", "p1p2"].design
    motion, pose = solve(design, _TURN), solve(design, np.array([np.radians(60.0)]))
    for name in ("knee", "pedal", "crank_pin", "rocker_joint"):
        path = motion.points[name].value
        ax.plot(path.real, path.imag, color="0.65", lw=0.8, ls=(0, (4, 2)))
    at = {name: complex(np.ravel(jet.value)[0]) for name, jet in pose.points.items()}
    ankle = at["knee"] + foot_points(design)[0] * complex(np.ravel(pose.direction("shank"))[0])
    for body, (origin, tip) in BODIES.items():
        ends = np.array([at[origin], *([ankle] if body == "shank" else []), at[tip]])
        ax.plot(ends.real, ends.imag, color=LINK_COLOUR[body], lw=4, solid_capstyle="round", label=body, zorder=2)
    arm = np.array([at["rocker_joint"], at["pedal"], at["crank_pin"]])
    ax.fill(arm.real, arm.imag, color=LINK_COLOUR["coupler"], alpha=0.35, lw=0)
    for name, point in at.items():
        fixed = name in ("hip", "crank_centre", "rocker_pivot")
        ax.plot(point.real, point.imag, "ks" if fixed else "ko", ms=6 if fixed else 4, zorder=3)
        ax.annotate(name.replace("_", " "), (point.real, point.imag), xytext=(5, 5), textcoords="offset points")
    _label(ax, "D1 at 60 deg of crank angle; squares are fixed to the frame", "x, m (rider faces left)", "y, m")
    ax.set_aspect("equal")
    ax.legend(loc="upper right")
    return figure


def smoothness(runs: Runs, posteriors: Posteriors) -> Figure:
    """What the paper lacks: power with segment masses, one leg and two, beside the quasi-static curve."""
    names = ("trt", "r2", "d1")
    figure, axes = _grid(len(names), 2, (7.2, 7.2), sharey="row")
    for row, name in zip(axes, names, strict=True):
        for ax, legs in zip(row, (1, 2), strict=True):
            run = runs.dynamic[name, "p1p2", legs].simulation
            angle, order = _angles(run)
            ax.plot(angle, run.power[order], color="0.45", label="MuJoCo, with segment masses")
            ax.plot(angle, reference_power(run, 0.0)[order], color=COLOUR["total"], label="quasi-static, no masses")
            ax.axhline(legs * run.power_mean, color="k", lw=0.8, ls=":", label="mean")
            title = f"{name.upper()}, P1P2, {'one leg' if legs == 1 else 'two legs half a turn apart'}"
            _turn_axis(ax, title)
    _legend_below(figure, axes)
    return figure


FIGURES: dict[str, Callable[[Runs, Posteriors], Figure]] = {
    "figure-01-moments-over-crank": moments_over_crank,
    "figure-04-power-of-the-trt": power_of_the_trt,
    "figure-05-moments-over-joint-angle": moments_over_joint_angle,
    "figure-10-design-space": design_space,
    "figure-11-truncated-maps": truncated_maps,
    "figure-12-power-of-r2-and-d1": power_of_r2_and_d1,
    "figure-13-d1-to-scale": d1_to_scale,
    "smoothness-with-masses": smoothness,
}


def _grid(rows: int, columns: int, size: tuple[float, float], sharey: Any = True) -> tuple[Figure, Any]:
    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, sharey=sharey)


def _label(ax: Axes, title: str, x: str, y: str) -> None:
    ax.set_title(title, loc="left", fontsize=9, weight="bold")
    ax.set(xlabel=x, ylabel=y)
    ax.axhline(0, color="black", lw=0.7, zorder=1)
    ax.label_outer()


def _turn_axis(ax: Axes, title: str) -> None:
    _label(ax, title, "crank angle, deg", "crank power, W")
    ax.set(xlim=(0, 360), xticks=range(0, 361, 90))


def _legend_below(figure: Figure, axes: Any, columns: int = 3) -> None:
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def _band(ax: Axes, x: Any, curve: tuple[Any, Any], joint: str, label: str, style: str = "-") -> None:
    mean, deviation = curve
    ax.plot(x, mean, style, color=COLOUR[joint], label=label)
    ax.fill_between(x, mean - deviation, mean + deviation, color=COLOUR[joint], alpha=0.15, lw=0)


def _maps(ax: Axes, posterior: Posterior, ranges: dict[str, tuple[float, float]]) -> None:
    """Moment over joint angle within the given ranges (rad), with the jumps that close them."""
    for joint, (low, high) in ranges.items():
        angle = np.linspace(low, high, 150)
        branches = {}
        for name, sign, style in (("extension", 1.0, "-"), ("flexion", -1.0, "--")):
            curve = posterior.curve(joint, source_angle(joint, angle, sign))
            _band(ax, np.degrees(angle), curve, joint, f"{joint}, {name}", style)
            branches[name] = curve[0]
        for end in (0, -1):
            jump = [branches["extension"][end], branches["flexion"][end]]
            ax.plot([np.degrees(angle[end])] * 2, jump, ":", color=COLOUR[joint], lw=1)


def _power(ax: Axes, runs: Runs, name: str, group: str) -> None:
    """Quasi-static power of knee, hip and both; MuJoCo's with next to no masses (dots) and with all."""
    static, result = runs.static[name, group], runs.dynamic[name, group, 1]
    every, degrees = slice(None, None, 10), np.degrees(static.crank_angle)
    for joint, moment in (("knee", static.knee_moment), ("hip", static.hip_moment)):
        power = static.cadence * moment * joint_angles(static.motion)[joint][1]
        ax.plot(degrees[every], power[every], color=COLOUR[joint], label=f"{joint}, quasi-static")
    ax.plot(degrees[every], static.power[every], color=COLOUR["total"], label="total, quasi-static")
    angle, order = _angles(result.massless)
    ax.plot(angle[::6], result.massless.power[order][::6], "k.", ms=3, label="MuJoCo, nearly massless")
    angle, order = _angles(result.simulation)
    label = "MuJoCo, with segment masses"
    ax.plot(angle, result.simulation.power[order], color="0.55", lw=0.9, ls=(0, (4, 2)), label=label)
    _turn_axis(ax, f"{name.upper()}, {group.upper()}: mean {static.power_mean:.1f} ± {static.power_sd:.1f} W")


def _angles(run: Simulation) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Crank angle in deg from 0 to 360 at about 240 steps of the turn, and the steps in this order."""
    angle = np.degrees(run.crank_angle) % 360
    order = np.argsort(angle)
    order = order[:: max(1, len(order) // 240)]
    return angle[order], order

"""The paper's figures from our numbers, and one it lacks."""

from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.joints import JOINTS
from fes_mj.kinematics import solve
from fes_mj.moments import GROUPS
from fes_mj.paper.printed import SIX_BARS
from fes_mj.paper.reconstruction import Posterior
from fes_mj.paper.runs import Runs
from fes_mj.reference_tricycle import PAPER_TRICYCLE
from fes_mj.style import COLOURS, CRANK_LABEL, LINKS, X_LABEL
from fes_mj.viewing.charts import draw_linkage, over_turn, turn_axis

Posteriors: TypeAlias = dict[str, Posterior]

_TURN = np.radians(np.arange(0.0, 360.5, 1.0))


def moments_over_crank(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 1: recovered joint moments over the TRT's crank angle, with their standard deviation."""
    figure, axes = _grid(1, 2, (7.2, 3.0))
    top = np.degrees(PAPER_TRICYCLE.top_dead_centre)
    for ax, (group, posterior) in zip(axes.flat, posteriors.items(), strict=True):
        for joint in JOINTS:
            _band(ax, np.degrees(_TURN) + top, posterior.curve(joint, _TURN), joint, joint)
        _label(
            ax,
            group.upper(),
            f"crank angle, deg (0: crank backwards; top dead centre at {top:.1f})",
            "joint moment, N m",
        )
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
    """Figure 5: the torque maps, extension and flexion apart."""
    figure, axes = _grid(1, 2, (7.2, 3.2))
    for ax, (group, posterior) in zip(axes.flat, posteriors.items(), strict=True):
        _maps(ax, posterior, PAPER_TRICYCLE.ranges.items())
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
            ax.plot(point.real, point.imag, markers[name], color=LINKS[body], label=label)
    trt = runs.static["trt", "p1p2"].design.linkage.crank_centre
    ax.plot(trt.real, trt.imag, "*", ms=9, color=LINKS["crank"], label="TRT crank centre")
    _label(ax, "Where the hip, the rocker pivots and the crank centres lie", X_LABEL, "y, m")
    ax.set_aspect("equal")
    ax.xaxis.set_inverted(True)
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def truncated_maps(runs: Runs, posteriors: Posteriors) -> Figure:
    """Figure 11: the part of the maps that R2 and D1 use, with the jumps at its ends; limits as in Figure 5."""
    figure, axes = _grid(2, 2, (7.2, 5.4))
    for row, name in zip(axes, ("r2", "d1"), strict=True):
        for ax, (group, posterior) in zip(row, posteriors.items(), strict=True):
            angles = runs.static[name, group].joint_angle
            _maps(ax, posterior, ((joint, (angle.min(), angle.max())) for joint, angle in angles.items()))
            _label(ax, f"{name.upper()}, {group.upper()}", "joint angle, deg", "joint moment, N m")
            low, high = PAPER_TRICYCLE.ranges.knee
            ax.set_xlim(*np.degrees((low - 0.04, high + 0.04)))
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
    design, angle = runs.static["d1", "p1p2"].design, np.radians(60.0)
    draw_linkage(ax, design, float(angle), ("knee", "pedal", "crank_pin", "rocker_joint"))
    for name, jet in solve(design, np.array([angle])).points.items():
        point = complex(np.ravel(jet.value)[0])
        ax.annotate(name.replace("_", " "), (point.real, point.imag), xytext=(5, 5), textcoords="offset points")
    ax.set_title("D1 at 60 deg of crank angle; squares are fixed to the frame", loc="left", weight="bold")
    ax.legend(loc="upper left")
    return figure


def smoothness(runs: Runs, posteriors: Posteriors) -> Figure:
    """What the paper lacks: power with segment masses, one leg and two, beside the quasi-static curve."""
    names = ("trt", "r2", "d1")
    figure, axes = _grid(len(names), 2, (7.2, 7.2), sharey="row")
    for row, name in zip(axes, names, strict=True):
        for ax, legs in zip(row, (1, 2), strict=True):
            case = runs.dynamic[name, "p1p2", legs]
            run, mean = case.simulation, legs * case.simulation.power_mean
            angle, power, massless = over_turn(run.crank_angle, run.power, case.reference_power(mass_scale=0.0))
            ax.plot(angle, power, color=COLOURS["mujoco"], label="MuJoCo, with segment masses")
            ax.plot(angle, massless, color=COLOURS["quasi-static"], label="quasi-static, no masses")
            ax.axhline(mean, color="k", lw=0.8, ls=":", label="mean")
            _turn(ax, f"{name.upper()}, P1P2, {'one leg' if legs == 1 else 'two legs half a turn apart'}")
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


def _turn(ax: Axes, title: str) -> None:
    turn_axis(ax)
    _label(ax, title, CRANK_LABEL, "crank power, W")


def _legend_below(figure: Figure, axes: Any, columns: int = 3) -> None:
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def _band(ax: Axes, x: Any, curve: tuple[Any, Any], joint: str, label: str, style: str = "-") -> None:
    mean, deviation = curve
    ax.plot(x, mean, style, color=COLOURS[joint], label=label)
    ax.fill_between(x, mean - deviation, mean + deviation, color=COLOURS[joint], alpha=0.15, lw=0)


def _maps(ax: Axes, posterior: Posterior, ranges: Iterable[tuple[str, tuple[float, float]]]) -> None:
    """Moment over joint angle within the given ranges (rad), with the jumps that close them."""
    for joint, (low, high) in ranges:
        angle = np.linspace(low, high, 150)
        branches = {}
        for name, sign, style in (("extension", 1.0, "-"), ("flexion", -1.0, "--")):
            curve = posterior.curve(joint, PAPER_TRICYCLE.source_angle(joint, angle, sign))
            _band(ax, np.degrees(angle), curve, joint, f"{joint}, {name}", style)
            branches[name] = curve[0]
        for end in (0, -1):
            jump = [branches["extension"][end], branches["flexion"][end]]
            ax.plot([np.degrees(angle[end])] * 2, jump, ":", color=COLOURS[joint], lw=1)


def _power(ax: Axes, runs: Runs, name: str, group: str) -> None:
    """Quasi-static power of knee, hip and both; MuJoCo's with next to no masses (dots) and with all."""
    static, case = runs.static[name, group], runs.dynamic[name, group, 1]
    for joint in JOINTS:
        power = static.power_of(joint)
        ax.plot(*over_turn(static.crank_angle, power), color=COLOURS[joint], label=f"{joint}, quasi-static")
    total = over_turn(static.crank_angle, static.power)
    ax.plot(*total, color=COLOURS["quasi-static"], label="both, quasi-static")
    massless = over_turn(case.massless.crank_angle, case.massless.power, points=40)
    ax.plot(*massless, ".", color=COLOURS["mujoco"], ms=4, label="MuJoCo, nearly massless")
    label = "MuJoCo, with segment masses"
    massive = over_turn(case.simulation.crank_angle, case.simulation.power)
    ax.plot(*massive, color=COLOURS["mujoco"], lw=0.9, ls=(0, (4, 2)), label=label)
    _turn(ax, f"{name.upper()}, {group.upper()}: mean {static.power_mean:.1f} ± {static.power_sd:.1f} W")

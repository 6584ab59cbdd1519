"""The paper's figures from our numbers, and one it lacks."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.style import COLOURS, CRANK_LABEL, FAINT, LINKS, MOMENTS, X_LABEL
from fes_mj.common.units import KMH
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.fourier import TERMS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import instant_power_weights
from fes_mj.paper.budget_figure import answer_figure, budget_figure
from fes_mj.paper.evidence import DIRECTIONS
from fes_mj.paper.known import BASES, Known, rms
from fes_mj.paper.reconstruction import Posterior
from fes_mj.paper.riding import Riding
from fes_mj.paper.runs import Runs
from fes_mj.riding.ride import TRANSMISSIONS
from fes_mj.viewing.charts import draw_linkage, legend_of_all, over_turn, turn_axis
from fes_mj.viewing.people import population_figure

_TURN = np.radians(np.arange(0.0, 360.5, 1.0))


def moments_over_crank(runs: Runs) -> Figure:
    """Figure 1: recovered joint moments over the TRT's crank angle, before and after the text."""
    figure, axes = _grid(2, 2, (7.2, 5.2))
    top = PAPER_TRICYCLE.top_dead_centre
    for ax, group, title, posterior in _before_and_after(axes, runs.known):
        for joint in JOINTS:
            _band(ax, np.degrees(_TURN), posterior.curve(joint, _TURN - top), joint, joint)
        ax.axvline(np.degrees(top), color=FAINT, lw=0.8, ls=":", label="top dead centre")
        _turn(ax, f"{group.upper()}, {title}", "joint moment, N m")
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=3)
    return figure


def power_of_the_trt(runs: Runs) -> Figure:
    """Figure 4: power of knee, hip and leg in the TRT over the turn, before and after the text."""
    figure, axes = _grid(3, 2, (7.2, 6.8), sharey="row", height_ratios=(2, 2, 1))
    _powers(axes, runs, "trt")
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=3)
    return figure


def moments_over_joint_angle(runs: Runs) -> Figure:
    """Figure 5: the torque maps, extension and flexion apart, before and after the text."""
    figure, axes = _grid(2, 2, (7.2, 5.4))
    for ax, group, title, posterior in _before_and_after(axes, runs.known):
        _maps(ax, posterior, PAPER_TRICYCLE.ranges.items())
        _label(ax, f"{group.upper()}, {title}", "joint angle, deg", "joint moment, N m")
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=4)
    return figure


def design_space(runs: Runs) -> Figure:
    """Figure 10: where crank centres and rocker pivots lie."""
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
    _label(ax, "Rocker pivots and crank centres", X_LABEL, "y, m")
    ax.set_aspect("equal")
    ax.xaxis.set_inverted(True)
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def truncated_maps(runs: Runs) -> Figure:
    """Figure 11: the part of the maps that R2 and D1 use, with the jumps at its ends; limits as in Figure 5."""
    figure, axes = _grid(2, 2, (7.2, 5.4))
    for row, name in zip(axes, ("r2", "d1"), strict=True):
        for ax, (group, posterior) in zip(row, runs.known.text.posteriors.items(), strict=True):
            angles = runs.static[name, group].joint_angle
            _maps(ax, posterior, ((joint, (angle.min(), angle.max())) for joint, angle in angles.items()))
            _label(ax, f"{name.upper()}, {group.upper()}", "joint angle, deg", "joint moment, N m")
            low, high = PAPER_TRICYCLE.ranges.knee
            ax.set_xlim(*np.degrees((low - 0.04, high + 0.04)))
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=4)
    return figure


def power_of_r2_and_d1(runs: Runs) -> Figure:
    """Figure 12: power of R2 and D1 over the turn, both groups, before and after the text."""
    figure, axes = _grid(6, 2, (7.2, 8.2), sharey="row", height_ratios=(2, 2, 1) * 2)
    for rows, name in zip((axes[:3], axes[3:]), ("r2", "d1"), strict=True):
        _powers(rows, runs, name)
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=3)
    return figure


def d1_to_scale(runs: Runs) -> Figure:
    """Figure 13: D1 and a leg to scale at one crank angle, with the paths of knee, pedal and crank pin."""
    figure, axes = _grid(1, 1, (7.2, 4.2))
    (ax,) = axes.flat
    design, angle = runs.static["d1", "p1p2"].design, np.radians(60.0)
    draw_linkage(ax, design, float(angle), ("knee", "pedal", "crank_pin", "rocker_joint"))
    readable = {"fc": "white", "alpha": 0.8, "lw": 0, "pad": 1}
    for name, jet in solve(design, np.array([angle])).points.items():
        point, text = complex(np.ravel(jet.value)[0]), name.replace("_", " ")
        ax.annotate(text, (point.real, point.imag), xytext=(6, 6), textcoords="offset points", bbox=readable)
    ax.set_title("D1 at 60 deg of crank angle; squares are fixed to the frame", loc="left", weight="bold")
    ax.legend(loc="upper left")
    return figure


def smoothness(runs: Runs) -> Figure:
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
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=3)
    return figure


def scores(runs: Runs) -> Figure:
    """Printed powers predicted without themselves, in standard deviations: are the stated errors right?"""
    figure, axes = _grid(1, 2, (7.2, 3.4))
    for number, (ax, title) in enumerate(zip(axes.flat, BASES, strict=True)):
        for group, marker, colour in zip(RIDER_GROUPS, "os", MOMENTS, strict=False):
            rows = [out for out in runs.known.predictions if out.row.group == group]
            values = np.array([out.scores[number] for out in rows])
            label = f"{group.upper()}, rms {rms(values):.2f}"
            ax.plot(values, range(len(rows)), marker, color=colour, label=label)
        for sd in (1, 2):
            ax.axvspan(-sd, sd, color="0.5", alpha=0.12, lw=0)
        names = [out.row.design.upper() + " and 15 W" * (out.title != "itself") for out in rows]
        ax.set(yticks=range(len(names)), yticklabels=names, xlim=(-3, 3), ylim=(len(names) + 0.8, -0.5))
        ax.axvline(0, color="black", lw=0.7)
        ax.set_title(title, loc="left", fontsize=9, weight="bold")
        ax.set(xlabel="predicted less printed power, sd", ylabel="left out")
        ax.label_outer()
        ax.legend(loc="lower center", ncols=2)
    return figure


def riding(runs: Runs) -> Figure:
    """Speed on the flat and slope climbed, fixed gear and freewheel, with the scatter of the muscles drawn."""
    figure, axes = _grid(1, 3, (7.2, 3.0), sharey=False)
    for ax, (title, values_of) in zip(axes.flat, RIDING.items(), strict=True):
        for row, (group, transmission) in enumerate(product(RIDER_GROUPS, TRANSMISSIONS)):
            rides = [ride for ride in runs.rides if (ride.group, ride.transmission) == (group, transmission)]
            values = [np.array(values_of(ride), float) for ride in rides]  # None becomes NaN
            places = np.arange(len(rides)) + 0.18 * (row - 1.5)
            colour, label = MOMENTS[RIDER_GROUPS.index(group)], f"{group.upper()}, {transmission}"
            for place, (_, *drawn) in zip(places, values, strict=True):
                ax.plot(np.full(len(drawn), place), drawn, ".", color=colour, ms=2, alpha=0.5)
            face = colour if transmission == "fixed" else "white"
            ax.plot(places, [best for best, *_ in values], "o", color=colour, mfc=face, ms=5, label=label)
        ax.set(xticks=range(len(rides)), xticklabels=[ride.design.name.upper() for ride in rides])
        ax.set_title(title, loc="left", fontsize=9, weight="bold")
        ax.axhline(0, color="black", lw=0.7)
    legend_of_all(figure, axes.flat, loc="outside lower center", ncols=4)
    return figure


# Title -> values of a Riding, the best known first.
RIDING: dict[str, Callable[[Riding], list[float | None]]] = {
    "speed on the flat, km/h": lambda ride: [trace.mean_speed and trace.mean_speed / KMH for trace in ride.flat],
    "start angles, % of a turn": lambda ride: [100 * starts.share for starts in ride.starts],
    "slope climbed, %": lambda ride: [starts.slope and 100 * starts.slope for starts in ride.starts],
}

FIGURES: dict[str, Callable[[Runs], Figure]] = {
    "figure-01-moments-over-crank": moments_over_crank,
    "figure-04-power-of-the-trt": power_of_the_trt,
    "figure-05-moments-over-joint-angle": moments_over_joint_angle,
    "figure-10-design-space": design_space,
    "figure-11-truncated-maps": truncated_maps,
    "figure-12-power-of-r2-and-d1": power_of_r2_and_d1,
    "figure-13-d1-to-scale": d1_to_scale,
    "smoothness-with-masses": smoothness,
    "scores": scores,
    "who-can-ride": lambda runs: population_figure([*runs.people.values()]),
    "riding": riding,
    "two-numbers": lambda runs: answer_figure(runs.answers),
    "error-budget": lambda runs: budget_figure(runs.budgets),
}


def _grid(
    rows: int, columns: int, size: tuple[float, float], sharey: Any = True, height_ratios: Sequence[int] | None = None
) -> tuple[Figure, Any]:
    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, sharey=sharey, height_ratios=height_ratios)


def _label(ax: Axes, title: str, x: str, y: str) -> None:
    ax.set_title(title, loc="left", fontsize=9, weight="bold")
    ax.set(xlabel=x, ylabel=y)
    ax.axhline(0, color="black", lw=0.7, zorder=1)
    ax.label_outer()


def _turn(ax: Axes, title: str, y: str = "crank power, W") -> None:
    turn_axis(ax)
    _label(ax, title, CRANK_LABEL, y)


def _band(ax: Axes, x: Any, curve: tuple[Any, Any], colour: str, label: str, style: str = "-") -> None:
    mean, deviation = curve
    ax.plot(x, mean, style, color=COLOURS[colour], label=label)
    ax.fill_between(x, mean - deviation, mean + deviation, color=COLOURS[colour], alpha=0.15, lw=0)


def _maps(ax: Axes, posterior: Posterior, ranges: Iterable[tuple[str, tuple[float, float]]]) -> None:
    """Moment over joint angle within the given ranges (rad), with the jumps that close them."""
    for joint, (low, high) in ranges:
        angle = np.linspace(low, high, 150)
        branches = []
        for (name, sign), style in zip(DIRECTIONS.items(), ("-", "--"), strict=True):
            curve = posterior.curve(joint, PAPER_TRICYCLE.source_angle(joint, angle, sign))
            _band(ax, np.degrees(angle), curve, joint, f"{joint}, {name}", style)
            branches.append(curve[0])
        for end in (0, -1):
            jump = [branch[end] for branch in branches]
            ax.plot([np.degrees(angle[end])] * 2, jump, ":", color=COLOURS[joint], lw=1)


def _before_and_after(axes: Any, known: Known) -> Iterator[tuple[Axes, str, str, Posterior]]:
    """Each of the first 2 x 2 axes with group, basis in words and posterior: a row for each basis."""
    for row, (title, recovered) in zip(axes[:2], known.by_basis.items(), strict=True):
        for ax, (group, posterior) in zip(row, recovered.posteriors.items(), strict=True):
            yield ax, group, title, posterior


def _powers(axes: Any, runs: Runs, name: str) -> None:
    """Quasi-static power of knee, hip and, with its sd, both; of the curves that ship MuJoCo's too, with residuals."""
    for ax, group, title, posterior in _before_and_after(axes, runs.known):
        static = runs.static[name, group]
        rows = instant_power_weights(static.motion, static.cadence, PAPER_TRICYCLE)
        for joint, start in zip(JOINTS, (0, TERMS), strict=True):
            part = slice(start, start + TERMS)
            curve = over_turn(static.crank_angle, rows[:, part] @ posterior.mean[part])
            ax.plot(*curve, color=COLOURS[joint], label=f"{joint}, quasi-static")
        angle, *both = over_turn(static.crank_angle, *posterior.predict_all(rows))
        _band(ax, angle, (both[0], both[1]), "quasi-static", "both, quasi-static")
        mean_power, deviation = posterior.predict(static.power_weights)
        _turn(ax, f"{name.upper()}, {group.upper()}, {title}: {mean_power:.1f} ± {deviation:.1f} W")
    for ax, residual, group in zip(*axes[1:], RIDER_GROUPS, strict=True):
        _simulated(ax, residual, runs.dynamic[name, group, 1])
        _turn(residual, "", "residual, W")


def _simulated(ax: Axes, residual: Axes, case: Case) -> None:
    """MuJoCo's power with next to no masses (dots) and with all, and what each misses of the exact curve."""
    massless, massive = case.massless, case.simulation
    dots = over_turn(massless.crank_angle, massless.power, points=40)
    ax.plot(*dots, ".", color=COLOURS["mujoco"], ms=4, label="MuJoCo, nearly massless")
    curve = over_turn(massive.crank_angle, massive.power)
    ax.plot(*curve, color=COLOURS["mujoco"], lw=0.9, ls=(0, (4, 2)), label="MuJoCo, with segment masses")
    for run, scale, colour, label in (
        (massless, 0.0, "quasi-static", "nearly massless, less quasi-static"),
        (massive, 1.0, "reference", "with masses, less exact inverse dynamics"),
    ):
        missed = run.power - case.reference_power(run, scale)
        residual.plot(*over_turn(run.crank_angle, missed), color=COLOURS[colour], lw=1, label=label)

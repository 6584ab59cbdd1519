"""Charts that figures, pages and reports share: a linkage in its plane, crank power over the turn, a figure as SVG."""

import io
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.arrays import FloatArray
from fes_mj.crosscheck import Case
from fes_mj.design import BODIES, Design
from fes_mj.kinematics import FULL_TURN, positions, solve
from fes_mj.segments import foot_points
from fes_mj.style import COLOURS, CRANK_LABEL, LINKS, X_LABEL

PLOTTED = 720  # points of a curve at most


@contextmanager
def any_letters() -> Iterator[None]:
    """Draw without a word about letters that the font lacks; a picture shows boxes for them."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        yield


def svg_text(figure: Figure) -> str:
    """The figure as an <svg> element; the same figure gives the same text."""
    stream = io.StringIO()
    with any_letters():
        figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    return text[text.index("<svg") :]


def turn_axis(axes: Axes, title: str = "") -> None:
    """Crank angle over a whole turn against crank power, and a line at zero."""
    axes.set(xlim=(0, 360), xticks=range(0, 361, 60), xlabel=CRANK_LABEL, ylabel="crank power, W")
    axes.axhline(0, color="black", lw=0.8)
    axes.set_title(title, loc="left")


def over_turn(crank_angle: FloatArray, *curves: FloatArray, points: int = PLOTTED) -> list[FloatArray]:
    """Crank angles (rad, one whole turn in any order) as 0 to 360 deg, about so many of them, and curves over them.

    The first point stands again at 360 deg, so that a turn closes.
    """
    angle = np.degrees(crank_angle) % 360
    order = np.argsort(angle)
    order = order[:: max(1, len(order) // points)]
    closed = np.append(order, order[0])
    return [np.append(angle[order], angle[order[0]] + 360), *(curve[closed] for curve in curves)]


def plot_power(axes: Axes, case: Case, names: Sequence[str] = ("reference", "mujoco", "quasi-static")) -> None:
    """Crank power of a case's first turn: exact inverse dynamics, MuJoCo, quasi-static."""
    run = case.simulation
    turn = slice(len(run.crank_angle) // run.turns)
    curves: dict[str, tuple[str, Any, dict[str, Any]]] = {
        "reference": ("exact inverse dynamics", case.reference_power, {"lw": 4, "alpha": 0.45}),
        "mujoco": ("MuJoCo, with masses and weight", lambda: run.power, {}),
        "quasi-static": ("quasi-static, no masses", lambda: case.reference_power(mass_scale=0.0), {"ls": (0, (5, 2))}),
    }
    for name in names:
        label, power, look = curves[name]
        axes.plot(*over_turn(run.crank_angle[turn], power()[turn]), color=COLOURS[name], label=label, **look)
    turn_axis(axes)


def draw_linkage(axes: Axes, design: Design, crank_angle: float, paths: Sequence[str] = ("pedal", "knee")) -> None:
    """Leg and linkage to scale at a crank angle (rad), and the paths of joints over the turn; riders face right."""
    turn = positions(design, np.append(FULL_TURN, 2 * np.pi))
    for name in (name for name in paths if name in turn):
        axes.plot(turn[name].real, turn[name].imag, color="0.65", lw=0.8, ls=(0, (4, 2)))
    pose = solve(design, np.array([crank_angle]))
    at = {name: complex(np.ravel(jet.value)[0]) for name, jet in pose.points.items()}
    ankle, heel, toe = (at["knee"] + point * complex(pose.direction("shank")[0]) for point in foot_points(design))
    axes.plot(*_xy(heel, toe), color="0.3", lw=3, solid_capstyle="round", zorder=1)
    linkage = design.linkage
    for body in linkage.architecture.bodies:
        origin, tip = (at[name] for name in BODIES[body])
        ends = (origin, ankle, tip) if body == "shank" else (origin, tip)
        axes.plot(*_xy(*ends), color=LINKS[body], lw=4, solid_capstyle="round", label=body, zorder=2)
    if linkage.architecture.pedal_body == "coupler":
        axes.fill(*_xy(at["rocker_joint"], at["pedal"], at["crank_pin"]), color=LINKS["coupler"], alpha=0.35, lw=0)
    elif linkage.architecture.pedal_body == "rocker":
        axes.plot(*_xy(at["rocker_joint"], at["pedal"]), color=LINKS["rocker"], lw=4, zorder=2)
    for name, point in at.items():
        fixed = name in ("hip", "crank_centre", "rocker_pivot")
        axes.plot(point.real, point.imag, "ks" if fixed else "ko", ms=6 if fixed else 4, zorder=3)
    axes.set(xlabel=X_LABEL, ylabel="y, m", aspect="equal")
    axes.xaxis.set_inverted(True)


def _xy(*points: complex) -> tuple[list[float], list[float]]:
    return [point.real for point in points], [point.imag for point in points]

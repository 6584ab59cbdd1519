"""Charts that figures, pages and reports share: a linkage in its plane, crank power over the turn, a figure as SVG."""

import io
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import FloatArray
from fes_mj.common.style import COLOURS, CRANK_LABEL, INK, LINKS, STYLE, X_LABEL, literal
from fes_mj.common.writing import replacing
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.kinematics import FULL_TURN, positions, solve
from fes_mj.linkage.shapes import back_to_front

PLOTTED = 720  # points of a curve at most
# Of pages: text stays readable at the width of a phone
PAGE_WIDTH, PAGE_HEIGHT = 6.4, 3.6  # inches
READABLE: dict[Any, Any] = STYLE | {"font.size": 12, "legend.fontsize": 11}


@contextmanager
def any_letters() -> Iterator[None]:
    """Draw without a word about letters that the font lacks; a picture shows boxes for them."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        yield


def write_figure(path: Path, draw: Callable[..., Figure], *content: Any) -> None:
    """Write what `draw` makes of the content, in the one look, as the suffix of `path` says; without a date."""
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(path.suffix.lower())
    with mpl.rc_context(STYLE), any_letters(), replacing(path) as temporary:
        draw(*content).savefig(temporary, dpi=150, metadata=dated)


def svg_text(figure: Figure) -> str:
    """The figure as an <svg> element; the same figure gives the same text."""
    stream = io.StringIO()
    with any_letters():
        figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    return text[text.index("<svg") :]


def page_axes(title: str = "", rows: Sequence[int] = (1,)) -> tuple[Figure, list[Axes]]:
    """Plots of a page below each other, of relative heights `rows`, as wide as a phone shows them; under READABLE."""
    figure = Figure(figsize=(PAGE_WIDTH, PAGE_HEIGHT * sum(rows) / rows[0]), layout="constrained")
    axes = list(figure.subplots(len(rows), squeeze=False, sharex=True, height_ratios=rows)[:, 0])
    axes[0].set_title(literal(title), loc="left", fontsize=12)
    return figure, axes


def page_svg(figure: Figure, axes: Axes) -> str:
    """The plot with its legend above, where it hides no curve."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3 if sum(map(len, labels)) < 50 else 2)
    return svg_text(figure)


def legend_of_all(figure: Figure, axes: Iterable[Axes], **look: Any) -> None:
    """A legend of the figure with all that these axes show, each once."""
    entries: dict[str, Any] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    figure.legend([*entries.values()], [*entries], **look)


def turn_axis(axes: Axes) -> None:
    """Crank angle over a whole turn against crank power, and a line at zero."""
    axes.set(xlim=(0, 360), xticks=range(0, 361, 60), xlabel=CRANK_LABEL, ylabel="crank power, W")
    axes.axhline(0, color="black", lw=0.8)
    axes.label_outer()


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


def plot_residual(axes: Axes, case: Case) -> None:
    """What MuJoCo's crank power misses of the exact inverse dynamics over a case's first turn."""
    run = case.simulation
    turn = slice(len(run.crank_angle) // run.turns)
    missed = 1e3 * (run.power - case.reference_power())[turn]
    axes.plot(*over_turn(run.crank_angle[turn], missed), color=COLOURS["mujoco"])
    turn_axis(axes)
    axes.set_ylabel("MuJoCo less\nexact, mW")


def draw_linkage(axes: Axes, design: Design, crank_angle: float, paths: Sequence[str] = ("pedal", "knee")) -> None:
    """Rider, linkage and frame to scale at a crank angle (rad), and the paths of joints; riders face right."""
    turn = positions(design, np.append(FULL_TURN, 2 * np.pi))
    pose = solve(design, np.array([crank_angle]))
    at = {name: complex(np.ravel(jet.value)[0]) for name, jet in pose.points.items()}
    for bar in back_to_front(design):
        origin, direction = (at[BODIES[bar.body][0]], complex(pose.direction(bar.body)[0])) if bar.body else (0j, 1.0)
        outline = bar.outline(origin, direction)
        label = bar.body if bar.part in LINKS and bar.body not in axes.get_legend_handles_labels()[1] else None
        axes.fill(outline.real, outline.imag, color=bar.colour, lw=0, label=label)
    for name in (name for name in paths if name in turn):
        axes.plot(turn[name].real, turn[name].imag, color=INK, lw=0.8, ls=(0, (4, 2)))
    for name, point in at.items():
        fixed = name in ("hip", "crank_centre", "rocker_pivot")
        look: dict[str, Any] = {"color": COLOURS.get(name, INK), "mec": "white", "mew": 0.5}
        axes.plot(point.real, point.imag, "s" if fixed else "o", ms=6 if fixed else 5, zorder=3, **look)
    axes.set(xlabel=X_LABEL, ylabel="y, m", aspect="equal")
    axes.xaxis.set_inverted(True)

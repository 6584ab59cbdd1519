"""A page on one found design: numbers, motion, power, constraints, front; HTML with everything inside."""

from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.style import COLOURS, INK, MOMENTS, SERIES
from fes_mj.linkage.design_file import design_toml
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.optimization.optimize import Optimum
from fes_mj.optimization.pareto import FLUCTUATION, Front
from fes_mj.optimization.winner import Winner
from fes_mj.viewing.pages import page

POSE = np.radians(200.0)  # crank angle at which leg and linkage are spread out


def page_html(winner: Winner, optimum: Optimum, origin: str) -> str:
    """The page. origin: how the design was found, and on a second line the command that finds it again.

    Raises MissingPartError without the extra "report".
    """
    front = optimum.front
    return page(
        Path(__file__).with_name("page.html.j2"),
        winner=winner,
        doubts=winner.doubts(optimum),
        origin=origin.splitlines(),
        constraints=optimum.limit_rows,
        space=optimum.problem.limits.space,
        figures=_figures(winner),
        front=front,
        front_figures=_front_figures(front, optimum.x) if front else (),
        toml=design_toml(winner.design, origin),
    )


def _figures(winner: Winner) -> list[str]:
    """The linkage with the paths of pedal and knee, and crank power over a turn, as SVG."""
    import matplotlib as mpl

    from fes_mj.viewing.charts import READABLE, draw_linkage, over_turn, page_axes, page_svg, plot_power

    with mpl.rc_context(READABLE):
        drawing, (linkage,) = page_axes()
        draw_linkage(linkage, winner.design, POSE)
        curves, (power,) = page_axes()
        plot_power(power, winner.case, ("mujoco", "quasi-static"))
        other = winner.compared_with
        curve, label = over_turn(other.crank_angle, other.power), f"{other.design.name}, quasi-static"
        power.plot(*curve, "--", color=COLOURS["comparison"], lw=1, label=label)
        return [page_svg(drawing, linkage), page_svg(curves, power)]


def _front_figures(front: Front, chosen: FloatArray) -> list[str]:
    """The powers of both groups against each other and, where smoothness was an objective, over it; as SVG."""
    import matplotlib as mpl

    from fes_mj.viewing.charts import READABLE, page_axes, page_svg

    star: dict[str, Any] = {"marker": "*", "ms": 14, "mfc": "none", "color": INK, "ls": "none"}
    best, smooth = int(np.argmin(np.abs(front.x - chosen).sum(axis=1))), front.fluctuation
    with mpl.rc_context(READABLE):
        figure, (axes,) = page_axes()
        dots = axes.scatter(front.power[:, 0], front.power[:, 1], c=SERIES[0] if smooth is None else smooth, s=18)
        axes.plot(*front.power[best], **star, label="this design")
        axes.set(xlabel=f"mean crank power {RIDER_GROUPS[0]}, W", ylabel=f"{RIDER_GROUPS[1]}, W")
        if smooth is None:
            return [page_svg(figure, axes)]
        figure.colorbar(dots, label=FLUCTUATION)
        over, (below,) = page_axes()
        for group, power, colour in zip(RIDER_GROUPS, front.power.T, MOMENTS, strict=False):
            below.plot(smooth, power, ".", color=colour, label=group)
            below.plot(smooth[best], power[best], **star)
        below.set(xlabel=f"{FLUCTUATION}, two legs, {RIDER_GROUPS[0]}", ylabel="mean crank power, W")
        return [page_svg(figure, axes), page_svg(over, below)]

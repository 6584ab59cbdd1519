"""A page on one found design: numbers, motion, power, constraints; HTML with everything inside."""

from pathlib import Path

import numpy as np

from fes_mj.design_file import design_toml
from fes_mj.optimization.outcome import Outcome
from fes_mj.optimization.winner import Winner
from fes_mj.statics import quasi_static
from fes_mj.style import COLOURS, STYLE
from fes_mj.viewing.pages import page


def page_html(winner: Winner, outcome: Outcome, origin: str) -> str:
    """The page. origin: how the design was found, and on a second line the command that finds it again.

    Raises MissingPartError without the extra "report".
    """
    from markupsafe import Markup

    return page(
        Path(__file__).with_name("page.html.j2"),
        winner=winner,
        origin=origin.splitlines(),
        rows=winner.rows,
        constraints=outcome.limit_rows,
        space=outcome.problem.limits.space,
        figure=Markup(_figure(winner)),
        toml=design_toml(winner.design, origin),
    )


def _figure(winner: Winner) -> str:
    """The linkage with the paths of pedal and knee, and crank power over a turn, as SVG."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    from fes_mj.viewing.charts import draw_linkage, plot_power, svg_text

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10, 4), layout="constrained")
        linkage, power = figure.subplots(1, 2)
        draw_linkage(linkage, winner.design, 0.0)
        linkage.legend(fontsize="small")
        plot_power(power, winner.case, ("mujoco", "quasi-static"))
        other = quasi_static(winner.compared_with, winner.case.moments, points=360)
        label = f"{winner.compared_with.name}, quasi-static"
        power.plot(np.arange(360), other.power, "--", color=COLOURS["comparison"], lw=1, label=label)
        power.legend(fontsize="small")
        return svg_text(figure)

"""A page of the report on one found design: numbers, motion, power, constraints; HTML with everything inside."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.crosscheck import reference_power
from fes_mj.design import BODIES
from fes_mj.design_file import design_toml
from fes_mj.errors import import_extra
from fes_mj.kinematics import FULL_TURN, positions
from fes_mj.optimization.winner import Winner
from fes_mj.statics import quasi_static

_TEMPLATE = Path(__file__).parent / "page.html.j2"


def require_packages() -> None:
    """Raise MissingPartError unless the packages of the extra "report" are there."""
    for package in ("jinja2", "matplotlib"):
        import_extra(package, "report")


def page_html(winner: Winner, told: str, rows: Sequence[Any], constraints: Sequence[Any], space: str) -> str:
    """The page. told: how the design was found. rows, constraints: cells of tables, as text."""
    require_packages()
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8")).render(
        winner=winner,
        told=told,
        rows=rows,
        constraints=constraints,
        space=space,
        figure=Markup(_figure(winner)),
        toml=design_toml(winner.design),
    )


def _figure(winner: Winner) -> str:
    """The linkage with the paths of pedal and knee, and crank power over a turn, as SVG."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4), layout="constrained")
    linkage, power = figure.subplots(1, 2)
    _draw(linkage, winner)
    run = winner.check.simulation
    turn = np.argsort(np.mod(run.crank_angle, 2 * np.pi))
    degrees = np.degrees(np.mod(run.crank_angle, 2 * np.pi))[turn]
    power.plot(degrees, run.power[turn], lw=0.8, label="simulated, with masses")
    power.plot(degrees, reference_power(run, 0.0)[turn], label="quasi-static")
    rival = quasi_static(winner.rival, winner.check.static.moments, points=360)
    power.plot(np.arange(360), rival.power, "--", lw=0.8, label=f"{winner.rival.name}, quasi-static")
    power.set(xlabel="crank angle, deg", ylabel="crank power of one leg, W", xlim=(0, 360))
    power.legend(fontsize="small")
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()[text.getvalue().index("<svg") :]


def _draw(axes: Any, winner: Winner) -> None:
    design = winner.design
    path, start = positions(design, FULL_TURN), positions(design, np.zeros(1))
    for body in design.linkage.architecture.bodies:
        ends = np.array([np.ravel(start[point])[0] for point in BODIES[body]])
        axes.plot(ends.real, ends.imag, "o-", label=body)
    carrier = BODIES[design.linkage.architecture.pedal_body][0]
    arm = np.array([np.ravel(start[point])[0] for point in (carrier, "pedal")])
    axes.plot(arm.real, arm.imag, "k-", lw=1)
    for point in ("pedal", "knee"):
        axes.plot(path[point].real, path[point].imag, "k:", lw=0.8)
    axes.set(xlabel="x, m (the rider faces left)", ylabel="y, m", aspect="equal")
    axes.legend(fontsize="small")

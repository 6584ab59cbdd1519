"""The report's figures, as SVG that scales with the page."""

import matplotlib as mpl
import numpy as np

from fes_mj.verification.case import VerificationCase
from fes_mj.verification.problems import Chain
from fes_mj.verification.refinement import Refinement
from fes_mj.viewing.charts import READABLE, page_axes, page_svg, plot_power, plot_residual


@mpl.rc_context(READABLE)
def power_curve(case: VerificationCase) -> str:
    """Simulated crank power over the turn beside its massive and its quasi-static reference; below, what it misses."""
    figure, (axes, missed) = page_axes(case.name, rows=(3, 1))
    plot_power(axes, case)
    plot_residual(missed, case)
    return page_svg(figure, axes)


@mpl.rc_context(READABLE)
def refinement_curve(name: str, refinement: Refinement) -> str:
    """Errors of one run over the time step."""
    steps = refinement.steps
    figure, (axes,) = page_axes(name)
    axes.set(xlabel="time step, ms", ylabel="relative error, or gap in m")
    timestep = [1e3 * level.timestep for level in steps]
    for field, label in {
        "gap": f"loop gap, order {refinement.gap_order:.2f}",
        "power_rms": f"crank power, W rms, order {refinement.power_order:.2f}",
        "lost": "energy lost",
        "work_error": "work per turn, against statics",
    }.items():
        axes.plot(timestep, [abs(getattr(level, field)) for level in steps], "o-", label=label)
    axes.set_xscale("log", base=2)
    axes.set_xticks(timestep, [f"{step:.3f}" for step in timestep])
    axes.set_yscale("log")
    return page_svg(figure, axes)


@mpl.rc_context(READABLE)
def chain_curve(chains: list[Chain]) -> str:
    """Energy drift of the chain A02 over time, by settings."""
    figure, (axes,) = page_axes()
    axes.set(xlabel="time, s", ylabel="change of energy so far, J", yscale="log")
    for chain in chains:
        step = slice(1, None, max(1, len(chain.time) // 500))
        worst = np.maximum.accumulate(np.abs(chain.energy))
        axes.plot(chain.time[step], worst[step], label=chain.settings.name)
    return page_svg(figure, axes)

"""The figure of the error budget: who is to blame, and how probable each gain is."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.style import PARTS
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.paper.error_budget import GAINS, Budgets, ratios
from fes_mj.paper.printed import SIX_BARS

_RATIOS = np.linspace(0, 3, 301)
_TICKS = (0.5, 1.0, *GAINS, 2.5)


def budget_figure(budgets: Budgets) -> Figure:
    """Shares of the variance as stacked bars; below, the probability that the power per the TRT's is above a ratio."""
    figure = Figure(figsize=(7.2, 7.0), layout="constrained")
    axes: Any = figure.subplots(2, 2, sharey="row")
    for (bars, curves), group in zip(axes.T, GROUPS, strict=True):
        _bars(bars, budgets, group)
        _curves(curves, budgets, group)
        for ax, title in ((bars, "everything drawn"), (curves, "power per TRT's")):
            ax.set_title(f"{group.upper()}, {title}", loc="left", fontsize=9, weight="bold")
    for (first, last), label in zip(axes, ("share of the variance, %", "probability of more, %"), strict=True):
        first.set_ylabel(label)
        last.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), reverse=last is axes[0, 1])
    return figure


def _bars(ax: Axes, budgets: Budgets, group: str) -> None:
    """First order of each unknown; what is left is what they do together."""
    designs = [name for name, other in budgets if other == group]
    bottom = np.zeros(len(designs))
    blame = [budgets[name, group].shares for name in designs]
    parts = {unknown: np.array([max(0.0, shares[unknown].first) for shares in blame]) for unknown in blame[0]}
    parts["several together"] = np.maximum(0.0, 1 - sum(parts.values()))
    for (unknown, part), colour in zip(parts.items(), PARTS, strict=False):
        ax.bar([name.upper() for name in designs], 100 * part, bottom=bottom, color=colour, label=unknown, width=0.7)
        bottom += 100 * part
    ax.grid(axis="x", visible=False)


def _curves(ax: Axes, budgets: Budgets, group: str) -> None:
    """Of every six-bar."""
    for name, colour in zip(SIX_BARS, PARTS, strict=False):
        ratio = np.sort(np.nan_to_num(ratios(budgets, name, group), nan=-np.inf))  # beats nothing
        above = 100 * (1 - np.searchsorted(ratio, _RATIOS, side="right") / ratio.size)
        ax.plot(_RATIOS, above, color=colour, label=name.upper())
    ax.set(xlabel="ratio", xlim=(0.2, 2.8), ylim=(0, 103), xticks=_TICKS)
    ax.set_xticklabels([f"{tick:g}" for tick in _TICKS], fontsize=7)
    for gain in GAINS:
        ax.axvline(gain, color="black", lw=0.7, ls=":")

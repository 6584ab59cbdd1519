"""The figures of what is not known: both numbers of each design; who is to blame, and how probable each gain is."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.budget.answer import Answer
from fes_mj.common.style import BY_DESIGN, COLOURS, FAINT, PART_COLOURS
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.error_budget import GAINS, Budgets, ratios

_RATIOS = np.linspace(0, 3, 301)
_BOTH = ("as the paper assumes", "for a rider: muscles, best timing")
_TICKS = (0.5, 1.0, *GAINS, 2.5)


def budget_figure(budgets: Budgets) -> Figure:
    """Shares of the variance as stacked bars; below, the probability that the power per the TRT's is above a ratio."""
    figure = Figure(figsize=(7.2, 7.0), layout="constrained")
    axes: Any = figure.subplots(2, 2, sharey="row")
    for (bars, curves), group in zip(axes.T, RIDER_GROUPS, strict=True):
        _bars(bars, budgets, group)
        _curves(curves, budgets, group)
        for ax, title in ((bars, "everything drawn"), (curves, "power per TRT's")):
            ax.set_title(f"{group.upper()}, {title}", loc="left", fontsize=9, weight="bold")
    for (first, last), label in zip(axes, ("share of the variance, %", "probability of more, %"), strict=True):
        first.set_ylabel(label)
        last.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), reverse=last is axes[0, 1])
    return figure


def answer_figure(answers: Mapping[tuple[str, str], Answer]) -> Figure:
    """Both powers of every six-bar per the TRT's, with their intervals, a panel a group."""
    figure = Figure(figsize=(7.2, 2.9), layout="constrained")
    axes: Any = figure.subplots(1, len(RIDER_GROUPS), sharey=True)
    for ax, group in zip(axes, RIDER_GROUPS, strict=True):
        per_trt = [answers[name, group].per(answers["trt", group]) for name in SIX_BARS]
        for place, (label, colour) in enumerate(zip(_BOTH, (COLOURS["quasi-static"], COLOURS["mujoco"]), strict=True)):
            value, low, high = np.array([both[place] for both in per_trt], float).T
            rows = np.arange(len(SIX_BARS)) + 0.14 * (2 * place - 1)
            ax.errorbar(value, rows, xerr=(value - low, high - value), fmt="o", color=colour, label=label, capsize=3)
        ax.axvline(1, color=FAINT, lw=1)
        ax.set(xlabel="power per the TRT's", xlim=(0, 2.5), yticks=range(len(SIX_BARS)), ylim=(3.5, -0.5))
        ax.set_yticklabels([name.upper() for name in SIX_BARS])
        ax.set_title(f"riders {group.upper()}", loc="left", fontsize=9, weight="bold")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _bars(ax: Axes, budgets: Budgets, group: str) -> None:
    """First order of each unknown; what is left is what they do together."""
    designs = [name for name, other in budgets if other == group]
    bottom = np.zeros(len(designs))
    blame = [budgets[name, group].shares for name in designs]
    parts = {unknown: np.array([max(0.0, shares[unknown].first) for shares in blame]) for unknown in blame[0]}
    parts["several together"] = np.maximum(0.0, 1 - sum(parts.values()))
    for (unknown, part), colour in zip(parts.items(), PART_COLOURS, strict=False):
        ax.bar([name.upper() for name in designs], 100 * part, bottom=bottom, color=colour, label=unknown, width=0.7)
        bottom += 100 * part
    ax.grid(axis="x", visible=False)


def _curves(ax: Axes, budgets: Budgets, group: str) -> None:
    """Of every six-bar."""
    for name in SIX_BARS:
        ratio = np.sort(np.nan_to_num(ratios(budgets, name, group), nan=-np.inf))  # beats nothing
        above = 100 * (1 - np.searchsorted(ratio, _RATIOS, side="right") / ratio.size)
        ax.plot(_RATIOS, above, color=BY_DESIGN[name], label=name.upper())
    ax.set(xlabel="ratio", xlim=(0.2, 2.8), ylim=(0, 103), xticks=_TICKS)
    ax.set_xticklabels([f"{tick:g}" for tick in _TICKS], fontsize=8)
    for gain in GAINS:
        ax.axvline(gain, color="black", lw=0.7, ls=":")

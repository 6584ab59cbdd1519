"""The report: one HTML file with everything inside, which needs no network."""

import base64
import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np

from fes_mj.budget.answer import answer, riders_of
from fes_mj.common.checks import Check, definitions
from fes_mj.common.provenance import provenance
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.faults import Detection
from fes_mj.verification.problems import Chain, compare_chains
from fes_mj.verification.references import differences
from fes_mj.verification.refinement import Refinement
from fes_mj.viewing.charts import READABLE, page_axes, page_svg, plot_power, plot_residual
from fes_mj.viewing.pages import page


def report_html(
    checks: Sequence[Check],
    detections: Sequence[Detection],
    cases: Sequence[VerificationCase],
    video: Path | None = None,
) -> str:
    """Verdict and table of runs, checks, figures, faults, details, provenance; `video` (.mp4) is embedded.

    Raises MissingPartError without the packages of the extra "report".
    """
    chains = compare_chains()
    names = dict.fromkeys(check.name for check in checks)
    worst = [max((check for check in checks if check.name == name), key=lambda check: check.factor) for name in names]
    return page(
        Path(__file__).with_name("report.html.j2"),
        filters={"short": short, "fixed": fixed, "sentence": capitalised},
        ok=all(check.ok for check in checks) and all(detection.caught for detection in detections),
        checks=checks,
        failed=[check for check in checks if not check.ok],
        worst=[(definitions()[check.name], check) for check in worst],
        detections=detections,
        missed=[detection for detection in detections if not detection.caught],
        cases=cases,
        for_a_rider=for_a_rider,
        differences=differences,
        power_curves=[power_curve(case) for case in cases],
        refinement_curves=[refinement_curve(case.name, case.refinement) for case in cases if case.refined],
        chains=chains,
        chain_curve=chain_curve(chains),
        video=base64.b64encode(video.read_bytes()).decode() if video else None,
        provenance=provenance(),
    )


def for_a_rider(case: VerificationCase) -> tuple[str, str]:
    """Power of the drive's riders, W, and per the equally timed TRT's; of own moments no muscles are known."""
    own_cadence = case.cadence == case.design.linkage.cadence
    both = answer(case.design, riders=riders_of(case.drive), cadence=None if own_cadence else case.cadence)
    power, ratio = both.rider_power, both.rider_ratio
    return power.text(1) if power else "not known", ratio.text(2) if ratio else "not known"


def short(value: float, unit: str = "") -> str:
    """Two digits and the unit; infinity as such."""
    return "∞" if value == math.inf else f"{value:.2g} {unit}".strip()


def fixed(value: float, digits: int) -> str:
    """A number with so many decimals, if there is one."""
    return "not refined" if math.isnan(value) else f"{value:.{digits}f}"


def capitalised(text: str) -> str:
    """With a capital at its begin; units and names stay as they are."""
    return text[:1].upper() + text[1:]


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

"""Do the stated errors of the recovered moments hold, and how much do they rest on the choice of the prior?"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights
from fes_mj.paper.captions import captioned
from fes_mj.paper.evidence import Evidence, of_group
from fes_mj.paper.known import Known, rms, scores
from fes_mj.paper.reconstruction import Hyperparameters, Posterior, System, condition, most_likely
from fes_mj.paper.statements import allowed_share


def left_out_table(known: Known) -> Table:
    """Printed powers predicted without themselves, by the numbers alone and with the text."""
    rows = []
    for left in known.predictions:
        said, (numbers, text) = left.row.value, left.scores
        percent = 100 * (left.numbers[0] / said - 1)
        names = (left.row.group, left.row.design.upper(), left.title)
        rows.append((*names, said, *left.numbers, percent, numbers, *left.text, text))
    return captioned("left_out", rows)


def calibration_table(known: Known) -> Table:
    """Root mean square of the scores, by group and over both."""
    rows = []
    for title, groups in (*((group, (group,)) for group in GROUPS), ("both", GROUPS)):
        of_groups = np.array([left.scores for left in known.predictions if left.row.group in groups])
        rows.append((title, len(of_groups), *rms(of_groups).tolist()))
    return captioned("calibration", rows)


def sensitivity_table(known: Known) -> Table:
    """The prior chosen otherwise: likelihood, scores, what the text allows, and D1's gain over the TRT.

    The last case takes its errors from the powers within the rounding of Table 2.
    """
    chosen = known.hyperparameters
    data = {group: of_group(known.evidence, group) for group in GROUPS}
    priors = {"chosen": chosen}
    priors |= {f"length {length:g}": replace(chosen, length=length) for length in (0.3, 0.5, 0.8, 1.6)}
    priors |= {f"amplitude {factor:g} x": replace(chosen, amplitude=factor * chosen.amplitude) for factor in (0.5, 2.0)}
    priors |= {f"six-bars' hip off by {d:g} N m": replace(chosen, discrepancy=d) for d in (1.0, 3.0)}
    cases = [(title, data, dict.fromkeys(GROUPS, prior)) for title, prior in priors.items()]
    apart = {group: most_likely([System.of(rows)]) for group, rows in data.items()}
    cases.append(("a prior for each group", data, apart))
    rounded = {group: [_rounded(row, known.rounding) for row in rows] for group, rows in data.items()}
    common = most_likely([System.of(rows) for rows in rounded.values()])
    cases.append(("six-bars' errors by their rounding", rounded, dict.fromkeys(GROUPS, common)))
    return captioned("sensitivity", [_case(*case) for case in cases], group=GROUPS)


def _rounded(row: Evidence, rounding: dict[tuple[str, str], FloatArray]) -> Evidence:
    """A six-bar's power with the error that its rounding makes, and that of reading the curves, which the TRT has."""
    change = rounding.get((row.design, row.group))
    return row if change is None else replace(row, error=math.hypot(0.1, rms(change)))


def _case(title: str, data: dict[str, list[Evidence]], priors: dict[str, Hyperparameters]) -> tuple[Any, ...]:
    """One row of the table: evidence and prior by group."""
    pairs = [(group, data[group], prior) for group, prior in priors.items()]
    shape = [
        " and ".join(dict.fromkeys(f"{getattr(prior, name):.3g}" for prior in priors.values()))
        for name in ("length", "amplitude")
    ]
    likelihood = sum(System.of(rows).log_likelihood(prior) for _, rows, prior in pairs)
    misses = [float(rms(scores(rows, prior))) for _, rows, prior in pairs]
    shares = [100 * allowed_share(rows, group, prior) for group, rows, prior in pairs]
    return (title, *shape, likelihood, *misses, *shares, *(_gain(condition(rows, prior)) for _, rows, prior in pairs))


def _gain(posterior: Posterior) -> str:
    """D1's power per the TRT's with its standard deviation, to first order."""
    designs = (load_design(name) for name in ("d1", "trt"))
    d1, trt = (power_weights(solve(design), design.linkage.cadence, PAPER_TRICYCLE) for design in designs)
    ratio = d1 @ posterior.mean / (trt @ posterior.mean)
    return f"{ratio:.2f} +- {posterior.predict(d1 - ratio * trt)[1] / (trt @ posterior.mean):.2f}"

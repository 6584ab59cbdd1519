"""How far the recovered moments can be trusted: residuals, predictions of what is left out, the choice of the prior.

Beside what the text says, and what Table 2's rounding leaves open.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.linkage.design_file import load_design
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import Rows, table
from fes_mj.paper.evidence import Evidence, functional, of_group, of_joint
from fes_mj.paper.known import Known, predictive_scores, rms, weights_of
from fes_mj.paper.reconstruction import EvidenceSystem, Hyperparameters, Posterior, condition, most_likely
from fes_mj.paper.statements import allowed_share, load_statements


@table("evidence")
def evidence_table(known: Known) -> Rows:
    """Every row: value, what the curves give without and with the text, and what they would give without the row."""
    for row in known.evidence:
        weights, value, error = functional(row), row.value, row.error
        fitted = known.numbers.posteriors[row.group].predict(weights)
        others = [other for other in of_group(known.evidence, row.group) if other is not row]
        left_out = condition(others, known.hyperparameters).predict(weights)
        residual, miss = (fitted[0] - value) / error, (left_out[0] - value) / np.hypot(left_out[1], error)
        with_text = with_sd(*known.text.posteriors[row.group].predict(weights))
        yield row.name, with_sd(value, error), with_sd(*fitted), residual, with_sd(*left_out), miss, with_text, row.unit


@table("statement")
def statement_table(known: Known) -> Rows:
    """What the text says of the figures beside curves of the numbers alone, and those that fulfil all of it."""
    for group in RIDER_GROUPS:
        for statement in load_statements(group):
            values = [statement.value(recovered.curves[group]) for recovered in (known.numbers, known.text)]
            numbers, text = (with_sd(float(value.mean()), float(value.std())) for value in values)
            holds = 100 * float(np.mean(statement.holds(known.numbers.curves[group])))
            yield group, statement.name, statement.bounds, numbers, holds, text


@table("knee")
def knee_table(known: Known) -> Rows:
    """Section 7.2's two knee moments, which are evidence of one group, in both."""
    for name, direction, printed in (("extending", 1.0, 20.0), ("flexing", -1.0, -1.0)):
        weights = of_joint("knee", fourier(PAPER_TRICYCLE.source_angle("knee", np.radians(73.0), direction)))
        for group in RIDER_GROUPS:
            cells = (with_sd(*recovered.posteriors[group].predict(weights), 1) for recovered in known.by_basis.values())
            yield name, group, printed, *cells, "used" if group == "p1p2" else "not used"


@table("rounding")
def rounding_table(known: Known) -> Rows:
    """Spread of each six-bar's power over the rounding of its dimensions."""
    for (name, group), change in known.rounding.items():
        yield name.upper(), group, float(rms(change)), float(change.mean()), len(change)


@table("left_out")
def left_out_table(known: Known) -> Rows:
    """Printed powers predicted without themselves, by the numbers alone and with the text."""
    for out in known.predictions:
        printed, (numbers, text) = out.row.value, out.scores
        percent = 100 * (out.numbers[0] / printed - 1)
        names = (out.row.group, out.row.design.upper(), out.title)
        yield *names, printed, *out.numbers, percent, numbers, *out.text, text


@table("calibration")
def calibration_table(known: Known) -> Rows:
    """Root mean square of the scores, by group and over both."""
    for title, groups in (*((group, (group,)) for group in RIDER_GROUPS), ("both", RIDER_GROUPS)):
        of_groups = np.array([out.scores for out in known.predictions if out.row.group in groups])
        yield title, len(of_groups), *rms(of_groups).tolist()


@table("sensitivity", group=RIDER_GROUPS)
def sensitivity_table(known: Known) -> Rows:
    """The prior chosen otherwise: likelihood, scores, what the text allows, and D1's gain over the TRT.

    The last case takes its errors from the powers within the rounding of Table 2.
    """
    chosen = known.hyperparameters
    data = {group: of_group(known.evidence, group) for group in RIDER_GROUPS}
    priors = {"chosen": chosen}
    priors |= {f"length {length:g}": replace(chosen, length=length) for length in (0.3, 0.5, 0.8, 1.6)}
    priors |= {f"amplitude {factor:g} x": replace(chosen, amplitude=factor * chosen.amplitude) for factor in (0.5, 2.0)}
    priors |= {f"six-bars' hip off by {d:g} N m": replace(chosen, discrepancy=d) for d in (1.0, 3.0)}
    cases = [(title, data, dict.fromkeys(RIDER_GROUPS, prior)) for title, prior in priors.items()]
    apart = {group: most_likely([EvidenceSystem.of(rows)]) for group, rows in data.items()}
    cases.append(("a prior for each group", data, apart))
    errors = {key: math.hypot(0.1, rms(change)) for key, change in known.rounding.items()}  # and that of reading curves
    rounded = {
        group: [replace(row, error=errors.get((row.design, group), row.error)) for row in rows]
        for group, rows in data.items()
    }
    common = most_likely([EvidenceSystem.of(rows) for rows in rounded.values()])
    cases.append(("six-bars' errors by their rounding", rounded, dict.fromkeys(RIDER_GROUPS, common)))
    return [_case(*case) for case in cases]


def _case(title: str, data: dict[str, list[Evidence]], priors: dict[str, Hyperparameters]) -> tuple[Any, ...]:
    """One row of the table: evidence and prior by group."""
    pairs = [(group, data[group], prior) for group, prior in priors.items()]
    shape = [
        " and ".join(dict.fromkeys(f"{getattr(prior, name):.3g}" for prior in priors.values()))
        for name in ("length", "amplitude")
    ]
    likelihood = sum(EvidenceSystem.of(rows).log_likelihood(prior) for _, rows, prior in pairs)
    misses = [float(rms(predictive_scores(rows, prior))) for _, rows, prior in pairs]
    shares = [100 * allowed_share(rows, group, prior) for group, rows, prior in pairs]
    return (title, *shape, likelihood, *misses, *shares, *(_gain(condition(rows, prior)) for _, rows, prior in pairs))


def _gain(posterior: Posterior) -> str:
    """D1's power per the TRT's with its standard deviation, to first order."""
    d1, trt = (weights_of(load_design(name)) for name in ("d1", "trt"))
    ratio = d1 @ posterior.mean / (trt @ posterior.mean)
    return with_sd(float(ratio), posterior.predict(d1 - ratio * trt)[1] / float(trt @ posterior.mean))

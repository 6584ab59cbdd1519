"""How far the recovered moments can be trusted: residuals, what the text says, what Table 2's rounding leaves open."""

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import captioned
from fes_mj.paper.evidence import functional, of_group
from fes_mj.paper.known import Known, rms
from fes_mj.paper.reconstruction import condition
from fes_mj.paper.statements import load_statements


def evidence_table(known: Known) -> Table:
    """Every row: value, what the curves give without and with the text, and what they would give without the row."""
    rows = []
    for row in known.evidence:
        weights, value, error = functional(row)
        fitted = known.numbers.posteriors[row.group].predict(weights)
        others = [other for other in of_group(known.evidence, row.group) if other is not row]
        left_out = condition(others, known.hyperparameters).predict(weights)
        rows.append(
            (
                row.name,
                with_sd(value, error),
                with_sd(*fitted),
                (fitted[0] - value) / error,
                with_sd(*left_out),
                (left_out[0] - value) / np.hypot(left_out[1], error),
                with_sd(*known.text.posteriors[row.group].predict(weights)),
                row.unit,
            )
        )
    return captioned("evidence", rows)


def statement_table(known: Known) -> Table:
    """What the text says of the figures beside curves of the numbers alone, and those that fulfil all of it."""
    rows, numbers, text = [], known.numbers.curves, known.text.curves
    for group in GROUPS:
        for statement in load_statements(group):
            values = [statement.value(curves[group]) for curves in (numbers, text)]
            cells = [with_sd(float(value.mean()), float(value.std())) for value in values]
            holds = 100 * float(np.mean(statement.holds(numbers[group])))
            rows.append((group, statement.name, statement.bounds, cells[0], holds, cells[1]))
    return captioned("statement", rows)


def knee_table(known: Known) -> Table:
    """Section 7.2's two knee moments, which are evidence of one group, in both."""
    rows = []
    for direction, said in ((1.0, 20.0), (-1.0, -1.0)):
        moment = fourier(PAPER_TRICYCLE.source_angle("knee", np.radians(73.0), direction))
        weights = np.concatenate([moment, 0 * moment])
        name = "extending" if direction > 0 else "flexing"
        for group in GROUPS:
            cells = (with_sd(*recovered.posteriors[group].predict(weights), 1) for recovered in known.by_basis.values())
            rows.append((name, group, said, *cells, "used" if group == "p1p2" else "not used"))
    return captioned("knee", rows)


def rounding_table(known: Known) -> Table:
    """Spread of each six-bar's power over the rounding of its dimensions."""
    rows = [
        (name.upper(), group, float(rms(change)), float(change.mean()), len(change))
        for (name, group), change in known.rounding.items()
    ]
    return captioned("rounding", rows)

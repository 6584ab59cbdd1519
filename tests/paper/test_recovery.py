"""Tables on what is known of the moments, before and after the text."""

import pytest

from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.known import Known, known
from fes_mj.paper.recovery import (
    calibration_table,
    evidence_table,
    knee_table,
    left_out_table,
    sensitivity_table,
    statement_table,
)


@pytest.fixture(scope="module")
def facts() -> Known:
    return known(load_evidence())


@pytest.mark.long
def test_the_text_leaves_no_evidence_behind(facts: Known) -> None:
    """Every number is recovered within two of its own errors, with the text as without."""
    for row, said in zip(evidence_table(facts).records(), facts.evidence, strict=True):
        assert abs(row["residual, errors"]) < 2, said.name
        assert abs(float(row["with the text"].split()[0]) - said.value) < 2 * said.error, said.name


@pytest.mark.long
def test_what_ships_fulfils_what_was_said(facts: Known) -> None:
    for row in statement_table(facts).records():
        assert 0 < row["holds, % of curves"] <= 100
        if row["allowed"] == "at most 1":
            assert row["with the text"] == "1.00 +- 0.00"


@pytest.mark.long
def test_tables_of_calibration_agree(facts: Known) -> None:
    chosen = sensitivity_table(facts).records()[0]
    by_group = {row["group"]: row for row in calibration_table(facts).records()}
    for group in RIDER_GROUPS:
        assert chosen[f"rms of scores, {group}"] == pytest.approx(by_group[group]["rms, numbers alone"], rel=1e-6)
    assert by_group["both"]["scores"] == len(left_out_table(facts).rows) == 12
    assert {row["evidence"] for row in knee_table(facts).records() if row["group"] == "p1p3"} == {"not used"}

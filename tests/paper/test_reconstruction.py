"""The recovered moments: what is shipped is what the evidence gives, and evidence that contradicts itself is named."""

import math
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA
from fes_mj.moments.files import sampled_coefficients
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.evidence import functional, load_evidence, of_group
from fes_mj.paper.reconstruction import (
    EvidenceSystem,
    Hyperparameters,
    Posterior,
    choose_hyperparameters,
    condition,
    left_out_misses,
    reconstruct,
)
from fes_mj.paper.statements import allowed_curves


@pytest.fixture(scope="module")
def posteriors() -> dict[str, Posterior]:
    return reconstruct(load_evidence())[1]


@pytest.fixture(scope="module")
def chosen() -> Hyperparameters:
    return choose_hyperparameters(load_evidence())


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_what_ships_is_what_evidence_and_text_give(group: str, chosen: Hyperparameters) -> None:
    """The tool's curves again. Rounding may carry one curve in a thousand over a bound of the text, not ten."""
    evidence = load_evidence()
    curves, _ = allowed_curves(of_group(evidence, group), group, chosen, 1000)
    shipped = sampled_coefficients(group)
    assert sum(np.abs(shipped - curve).max(axis=1).min() < 1e-3 for curve in curves) >= 990


def test_the_likelihood_has_one_maximum_inside_its_bounds(chosen: Hyperparameters) -> None:
    """On a grid beyond the bound of the length no prior is more likely."""
    evidence = load_evidence()
    systems = [EvidenceSystem.of(of_group(evidence, group)) for group in RIDER_GROUPS]
    best = sum(system.log_likelihood(chosen) for system in systems)
    for length in np.geomspace(0.2, 2.0, 25):
        for amplitude in np.geomspace(1, 40, 25):
            other = Hyperparameters(float(length), float(amplitude))
            assert sum(system.log_likelihood(other) for system in systems) < best + 1e-3


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("value = 31.29", "value = 90.0", "p1p2 power in D1"),
        ("value = 16.2\n", "value = 61.0\n", "p1p3 power in TRT"),
        ("value = 20.0", "value = 400.0", "p1p2 knee extending at 73 deg"),
    ],
)
def test_evidence_that_contradicts_itself_is_named(old: str, new: str, name: str, tmp_path: Path) -> None:
    path, text = tmp_path / "evidence.toml", (DATA / "evidence.toml").read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=rf"evidence '{name}' .* standard dev"):
        reconstruct(load_evidence(path))


def test_the_quick_way_to_leave_rows_out_is_the_long_one() -> None:
    """Closed form against conditioning on the other rows, and never below the residual."""
    evidence = load_evidence()
    chosen = choose_hyperparameters(evidence)
    for group in RIDER_GROUPS:
        rows = [row for row in evidence if row.group == group]
        posterior = condition(rows, chosen)
        for row, miss in zip(rows, left_out_misses(rows, chosen), strict=True):
            weights, value, error = functional(row), row.value, row.error
            mean, deviation = condition([other for other in rows if other is not row], chosen).predict(weights)
            assert miss == pytest.approx((value - mean) / math.hypot(deviation, error), rel=1e-6, abs=1e-9)
            assert abs(miss) >= abs(value - posterior.predict(weights)[0]) / error - 1e-9


def test_a_row_left_out_is_predicted_less_surely() -> None:
    evidence = load_evidence()
    chosen, posteriors = reconstruct(evidence)
    for row in evidence:
        weights = functional(row)
        others = [other for other in evidence if other.group == row.group and other is not row]
        _, fitted = posteriors[row.group].predict(weights)
        _, left_out = condition(others, chosen).predict(weights)
        assert left_out >= fitted, row.name


def test_what_was_used_comes_back(posteriors: dict[str, Posterior]) -> None:
    (row,) = (row for row in load_evidence() if row.name == "p1p2 knee extending at 73 deg")
    weights, value, error = functional(row), row.value, row.error
    recovered, _ = posteriors[row.group].predict(weights)
    assert value == 20
    assert abs(recovered - value) < error

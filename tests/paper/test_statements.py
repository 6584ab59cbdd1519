"""What the text says of the figures: quantities of known curves, and curves that fulfil it."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.moments.files import moments_of, sampled_coefficients
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper import statements
from fes_mj.paper.evidence import load_evidence, of_group
from fes_mj.paper.reconstruction import choose_hyperparameters, condition, drawn_curves
from fes_mj.paper.statements import QUANTITIES, Statement, allowed_curves, load_statements
from fes_mj.statics.turn import quasi_static

TURN = np.radians(np.arange(0.0, 360.0, 2.0))


def quantity(name: str, power: np.ndarray) -> float:
    return float(QUANTITIES[name](power[None, :])[0])


def test_quantities_of_known_powers() -> None:
    assert quantity("peaks", 1 + np.cos(TURN - 0.3)) == 1
    assert quantity("peaks", 1 + np.cos(2 * TURN)) == 2
    small = 0.9 * np.exp(-(((TURN - np.pi) / 0.3) ** 2))
    assert quantity("peaks", 1 + np.cos(TURN) + small) == 1  # 0.9 beside 2 is not above half of it
    assert quantity("lowest", 1 + 3 * np.cos(TURN)) == pytest.approx(-0.5, abs=1e-3)
    assert quantity("idle", np.sin(TURN)) == pytest.approx(0.5, abs=0.02)
    # top dead centre is at 22.4 deg, the bottom one half a turn on
    first = np.abs(TURN - math.radians(115)) < math.radians(85)
    assert quantity("lowest_second_half", np.where(first, -1.0, 2.0)) == 1
    assert quantity("lowest_second_half", np.where(first, 2.0, -1.0)) == -0.5


def test_power_of_a_statement_is_the_solvers() -> None:
    curves = sampled_coefficients("p1p3")[:3]
    for name in ("trt", "d1", "r2"):
        ours = Statement("p1p3", "", name, "lowest", "").value(curves)
        for curve, value in zip(curves, ours, strict=True):
            power = quasi_static(fes_mj.load_design(name), moments_of(curve, "drawn"), points=180).power
            assert value == pytest.approx(power.min() / power.max(), abs=1e-3)


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_every_curve_that_ships_fulfils_the_text(group: str) -> None:
    """But for what rounding its coefficients to 1e-4 N m moves across a bound."""
    curves = sampled_coefficients(group)
    for statement in load_statements(group):
        assert np.mean(statement.holds(curves)) > 0.99, statement.name


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_drawn_curves_have_the_posteriors_mean_and_covariance(group: str) -> None:
    """Against the closed form, in standard errors of 20,000 draws; five of them for 98 means at once."""
    evidence, count = load_evidence(), 20_000
    rows, prior = of_group(evidence, group), choose_hyperparameters(evidence)
    posterior, curves = condition(rows, prior), drawn_curves(rows, prior, np.random.default_rng(7), count)
    deviation = np.sqrt(np.diag(posterior.covariance))
    assert np.all(np.abs(curves.mean(axis=0) - posterior.mean) < 5 * deviation / math.sqrt(count))
    features = np.concatenate([fourier(np.radians(np.arange(0, 360, 45)))] * 2, axis=1)
    assert (curves @ features.T).std(axis=0) == pytest.approx(
        posterior.predict_all(features)[1], rel=5 / math.sqrt(2 * count)
    )


def test_text_that_contradicts_the_numbers_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """D1 with a lowest power above its highest."""
    evidence = load_evidence()
    impossible = [Statement("p1p2", "", "d1", "lowest", "", at_least=1.1)]
    monkeypatch.setattr(statements, "load_statements", lambda group: impossible)
    monkeypatch.setattr(statements, "_MOST", 20_000)
    with pytest.raises(InputError, match=r"0 of 20000 curves.* p1p2"):
        allowed_curves(of_group(evidence, "p1p2"), "p1p2", choose_hyperparameters(evidence), 1)

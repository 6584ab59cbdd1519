"""Predictions of printed powers that were left out: closed form against conditioning, and their errors against 1."""

import numpy as np
import pytest

from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.evidence import functional, load_evidence, of_group
from fes_mj.paper.known import LeftOut, left_out, predictive_scores, rms
from fes_mj.paper.reconstruction import Hyperparameters, choose_hyperparameters, condition


@pytest.fixture(scope="module")
def predictions() -> list[LeftOut]:
    evidence = load_evidence()
    return left_out(evidence, choose_hyperparameters(evidence))


@pytest.mark.long
def test_scores_in_closed_form_are_those_of_conditioning(predictions: list[LeftOut]) -> None:
    evidence = load_evidence()
    for group in RIDER_GROUPS:
        quick = predictive_scores(of_group(evidence, group), choose_hyperparameters(evidence))
        long = [out.scores[0] for out in predictions if out.row.group == group]
        assert quick == pytest.approx(long, rel=1e-6, abs=1e-9)


@pytest.mark.long
def test_leaving_the_trt_out_leaves_its_twin_out_too(predictions: list[LeftOut]) -> None:
    """Without both, the TRT is predicted less surely than with the 15 W item."""
    for group in RIDER_GROUPS:
        alone, both = (out for out in predictions if out.row.group == group and out.row.design == "trt")
        assert both.title == "itself and the 15 W item"
        for one, other in zip((alone.numbers, alone.text), (both.numbers, both.text), strict=True):
            assert other[1] > 2 * one[1]


@pytest.mark.long
def test_stated_errors_hold(predictions: list[LeftOut]) -> None:
    """With the right errors the rms is 1, within the 0.2 that 12 scores leave, and the 0.3 of a group's six."""
    both = rms(np.array([out.scores for out in predictions]))
    assert np.all((both > 0.8) & (both < 1.2))
    for group in RIDER_GROUPS:
        assert np.all(rms(np.array([out.scores for out in predictions if out.row.group == group])) < 1.3)


def test_a_discrepancy_makes_six_bars_less_sure_and_leaves_the_trt() -> None:
    """With it a six-bar says less of the curves, in closed form as by 98 coefficients of its own."""
    rows, chosen = of_group(load_evidence(), "p1p2"), Hyperparameters(1.0, 15.0)
    apart = Hyperparameters(1.0, 15.0, discrepancy=5.0)
    for row in rows:
        weights, error = functional(row), row.error
        sure, unsure = (condition([row], prior).predict(weights)[1] for prior in (chosen, apart))
        if row.quantity == "power" and row.design != "trt":
            noise = error**2 + np.sum(weights[49:] ** 2 * apart.discrepancy_variance()[49:])
            prior = np.sum(weights**2 * chosen.prior_variance())
            assert unsure**2 == pytest.approx(prior * noise / (prior + noise))
            assert unsure > sure
        else:
            assert unsure == pytest.approx(sure)

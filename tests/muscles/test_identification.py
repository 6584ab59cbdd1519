import numpy as np
import pytest

from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.fourier import fourier
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.muscles.identification import Candidates, identify_riders, moment_coefficients
from fes_mj.muscles.posterior import WeighedRiders
from fes_mj.muscles.power import muscle_turn
from fes_mj.muscles.prior import prior_draws, priors, quantile
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.timing import Windows
from tools.fit_muscles import measured

POWER_IN_TRT = 0  # row of the evidence


def test_coefficients_are_those_of_the_curve():
    angle = np.arange(120) * (2 * np.pi / 120)
    knee = 3 + 2 * np.cos(angle - 1) + np.sin(7 * angle)
    both = moment_coefficients(PerJoint(knee, -knee))
    assert fourier(angle) @ both[:49] == pytest.approx(knee)
    assert both[49:] == pytest.approx(-both[:49])


def test_values_of_a_rider_are_those_of_its_turn(riders):
    """The power that a measurement gives is that of the muscles, less the loss; passive moments do no work."""
    seen = Candidates.of(riders, measured("p1p2"))
    strengths = np.stack([riders.values[f"{g}_strength"] for g in ("quadriceps", "hamstrings", "gluteus")], axis=1)
    on, width = np.moveaxis(riders.windows(), -1, 0)[..., None]
    windows = Windows(on, width).shifted(np.degrees(PAPER_TRICYCLE.top_dead_centre))
    turn = muscle_turn(riders, PAPER_TRICYCLE.design, PAPER_TRICYCLE.cadence, windows)
    power = np.einsum("mg,mg->m", seen.by_strength[:, POWER_IN_TRT], strengths)
    assert power == pytest.approx(turn.power_mean[:, 0], rel=5e-3, abs=0.05)
    assert seen.explained[:, POWER_IN_TRT] == pytest.approx(-riders.values["residual_loss_W"], abs=1e-6)


def test_strengths_are_those_of_gaussian_conditioning(riders):
    """Of one rider, many draws, beside weighing a dense grid of strengths by hand."""
    one, count = riders.taken([0]), 4000
    seen = Candidates.of(one, measured("p1p3"))
    values = seen.simulated(0, np.random.default_rng(3))
    many = Candidates(
        Riders("many", {k: np.repeat(v, count) for k, v in one.values.items()}, np.zeros(count)),
        *(np.repeat(part, count, axis=0) for part in (seen.by_strength, seen.explained, seen.covariance)),
    )
    posterior, marginal = many.posterior(values, np.random.default_rng(4).standard_normal((4, count, 3)))
    drawn_strengths = np.stack([posterior.values[name] for name in list(priors())[:3]], axis=1)[np.isfinite(marginal)]
    axes = np.meshgrid(*[np.linspace(0.0, 1.6, 81)] * 3, indexing="ij")
    grid = np.stack([axis.ravel() for axis in axes], axis=1)
    mean, deviation = np.array([priors()[name]["normal"] for name in list(priors())[:3]]).T
    apart = values - seen.explained[0] - grid @ seen.by_strength[0].T
    log = -np.einsum("nr,nr->n", apart, np.linalg.solve(seen.covariance[0], apart.T).T) / 2
    log -= np.sum(((grid - mean) / deviation) ** 2, axis=1) / 2
    weight = np.exp(log - log.max())
    expected = np.average(grid, axis=0, weights=weight)
    error = drawn_strengths.std(axis=0) / np.sqrt(len(drawn_strengths))
    assert np.all(np.abs(drawn_strengths.mean(axis=0) - expected) < 4 * error + 0.01)  # the grid's step is 0.02


def test_members_come_as_often_as_they_weigh(riders):
    posterior = WeighedRiders(riders, np.log([1e-300, 1e-300, 3, 1e-300, 1e-300, 1, 1e-300, 1e-300]))
    assert sorted(posterior.members(8).likelihood) == [2.0] * 6 + [5.0] * 2
    assert posterior.effective == pytest.approx(1.6)


def test_riders_that_explain_the_evidence_give_its_powers():
    numbers = measured("p1p3")
    posterior = identify_riders(numbers, np.random.default_rng(1), 400)
    members = posterior.members(50)
    seen = Candidates.of(members, numbers)
    strengths = np.stack([members.values[name] for name in list(priors())[:3]], axis=1)
    missed = numbers.values - seen.explained - np.einsum("nrg,ng->nr", seen.by_strength, strengths)
    mahalanobis = np.einsum("nr,nr->n", missed, np.linalg.solve(seen.covariance, missed[..., None])[..., 0])
    assert np.median(mahalanobis) < len(numbers.values) + 8  # of as many numbers, within two deviations


@pytest.mark.parametrize("group", ["p1p2", "p1p3"])
def test_shipped_ensembles_have_200_members_within_their_priors(group):
    members = load_riders(group)
    assert len(members) == 200
    assert list(members.values) == list(priors())
    for name, values in members.values.items():
        low, high = (quantile(name, np.array(end)) for end in (-9.0, 9.0))
        assert values.min() >= low
        assert name.endswith("strength") or values.max() <= high
    assert members.most_probable.likelihood == [members.likelihood.max()]


def test_prior_quantiles_are_the_stated_ones():
    scores = np.array([-9.0, 0.0, 9.0])
    assert quantile("rise_s", scores) == pytest.approx([0.03, 0.06, 0.12])
    assert quantile("max_speed", scores) == pytest.approx([5, 8.5, 12])
    assert quantile("gluteus_strength", scores[1:2]) == pytest.approx(0.39 * 0.67449, rel=1e-4)
    assert quantile("passive_included", scores) == pytest.approx([0, 1, 1])
    assert set(prior_draws(3, np.random.default_rng(0))) == set(priors())

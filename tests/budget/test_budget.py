"""The error budget: sums that are known, what is exact, and the same numbers in every process."""

import os
import subprocess
import sys
from dataclasses import replace
from statistics import NormalDist

import numpy as np
import pytest

import fes_mj
from fes_mj.budget.budget import Spread, budget_summary, error_budget, powers, sobol_shares, together
from fes_mj.budget.power import UncertainPower
from fes_mj.budget.unknowns import EXTRAPOLATION, MASSES, MOMENTS, RIDER, budget_priors
from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import MissingPartError
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.turn import QuasiStatic, quasi_static

ALL = np.arange(1000)


def static(name: str, moments: JointMoments) -> QuasiStatic:
    return quasi_static(fes_mj.load_design(name), moments)


@pytest.fixture(scope="module")
def outside() -> QuasiStatic:
    """A TRT whose hip leaves the range of the moments."""
    trt = fes_mj.load_design("trt")
    return quasi_static(trt.with_linkage(seat_angle=np.radians(55)), fes_mj.load_moments())


def test_moments_and_extrapolation_are_the_known_standard_deviation(
    moments: JointMoments, outside: QuasiStatic
) -> None:
    for result in (static("d1", moments), static("r2", moments), outside):
        budget = error_budget(result)
        assert budget is not None
        by = budget.by
        assert np.hypot(by[MOMENTS], by[EXTRAPOLATION]) == pytest.approx(result.power_sd, rel=1e-12)
    assert by[EXTRAPOLATION] > 0.1


def test_drawn_moments_agree_with_their_covariance(design: fes_mj.Design, moments: JointMoments) -> None:
    """The thousand curves that ship have this covariance, so that there is no sampling error."""
    result = quasi_static(design, moments)
    spread = Spread.of(UncertainPower(result, 1000).at({MOMENTS: ALL}))
    budget = error_budget(result, draws=8)
    assert budget is not None
    assert spread.sd == pytest.approx(budget.by[MOMENTS], rel=0.02)
    assert spread.mean == pytest.approx(result.power_mean, abs=0.02)


def test_drawn_drifts_agree_with_the_known_error_beyond_the_range(outside: QuasiStatic) -> None:
    spread = Spread.of(UncertainPower(outside, 1000).at({EXTRAPOLATION: ALL}))
    assert spread.sd == pytest.approx(outside.extrapolation.sd, rel=0.07)  # three errors of 1000 draws


def test_what_is_linear_and_independent_adds_in_squares(outside: QuasiStatic) -> None:
    power, rows = UncertainPower(outside, 1000), together((MOMENTS, EXTRAPOLATION), 1000)
    alone = [Spread.of(power.at({name: ALL})).sd for name in rows]
    assert Spread.of(power.at(rows)).sd == pytest.approx(np.hypot(*alone), rel=0.05)


def test_together_every_realisation_comes_up_equally_often() -> None:
    rows = together(("one", "two"), 50, 3)
    assert all(np.bincount(numbers).tolist() == [3] * 50 for numbers in rows.values())
    assert not np.array_equal(rows["one"], rows["two"])


def test_the_worse_a_thing_is_known_the_larger_its_contribution(monkeypatch: pytest.MonkeyPatch) -> None:
    result, budgets = static("r1", fes_mj.load_moments()), []
    for value in (0, 0.005, 0.02):
        monkeypatch.setitem(budget_priors()[RIDER], "length_sd_m", value)
        budget = error_budget(result, draws=100)
        assert budget is not None
        budgets.append(budget)
    alone = [budget.by[RIDER] for budget in budgets]
    assert alone[0] == pytest.approx(0, abs=1e-12)
    assert 0 < alone[1] < alone[2]
    assert {budget.by[MASSES] for budget in budgets} == {0.0}


def test_probability_of_a_gain_is_the_normal_one_where_it_is_one() -> None:
    """P(A > g B) of Gaussian moments, in which both powers are linear; 4000 draws, three errors of a share."""
    moments = replace(fes_mj.load_moments("p1p3"), name="own")
    one, other = (static(name, moments) for name in ("d1", "trt"))
    rows = {MOMENTS: np.arange(4000)}
    a, b = (UncertainPower(leg, 4000).at(rows) for leg in (one, other))
    for gain in (1.77, 1.8, 1.82):
        weights = one.power_weights - gain * other.power_weights
        assert moments.covariance is not None
        score = (one.power_mean - gain * other.power_mean) / np.sqrt(weights @ moments.covariance @ weights)
        exact = NormalDist().cdf(float(score))
        assert 0.1 < exact < 0.9
        assert np.mean(a > gain * b) == pytest.approx(exact, abs=3 * np.sqrt(exact * (1 - exact) / 4000))


def test_legs_with_moments_of_their_own_are_independent_in_their_moments_alone() -> None:
    moments = replace(fes_mj.load_moments(), name="own")
    one = static("r1", moments)
    single, double = error_budget(one), error_budget(one, one)
    assert single is not None
    assert double is not None
    assert single.by[MOMENTS] is not None
    assert double.by[MOMENTS] == pytest.approx(single.by[MOMENTS] / np.sqrt(2))
    assert double.by[RIDER] == pytest.approx(single.by[RIDER])
    both = powers([UncertainPower(one, 1000)] * 2, {MOMENTS: ALL})
    assert both.std() == pytest.approx(one.power_sd / np.sqrt(2), rel=0.1)  # type: ignore[operator]


def test_what_cannot_be_told_is_null(smooth_moments: JointMoments) -> None:
    assert error_budget(static("r1", smooth_moments)) is None
    assert budget_summary(None) == {"power_sd_total_W": None, "power_sd_by": None}


def test_too_few_that_turn_have_no_spread() -> None:
    assert Spread.of(np.array([1.0, 3.0, np.nan])) == (2.0, pytest.approx(np.sqrt(2)), 1)
    assert np.isnan(Spread.of(np.array([1.0, np.nan]))[:2]).all()


@pytest.mark.process
@pytest.mark.parametrize("name", ["p1p2", "own"])
def test_the_same_to_the_last_bit_in_every_process(name: str) -> None:
    """Whatever the number of threads, for shipped curves and for Gaussian ones."""
    program = (
        "import fes_mj; from dataclasses import replace; from fes_mj.budget.budget import error_budget\n"
        f"moments = replace(fes_mj.load_moments(), name={name!r})\n"
        "print(error_budget(fes_mj.quasi_static(fes_mj.load_design('d1'), moments), draws=64))"
    )
    said = {
        subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads, "PYTHONHASHSEED": threads},
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        for threads in ("1", "2")
    }
    assert len(said) == 1
    assert "ErrorBudget" in said.pop()


COUNT = 500
NAMES = ("one", "two", "three")


def realisations() -> dict[str, FloatArray]:
    """Even from -1 to 1, in any order: the shares must find the order that helps them."""
    random = np.random.default_rng(4)
    return {name: random.permutation(np.linspace(-1, 1, COUNT)) for name in NAMES}


def test_shares_of_a_sum_are_the_squares_of_its_factors() -> None:
    drawn, factors = realisations(), {"one": 3.0, "two": 2.0, "three": 1.0}

    def power(rows: dict[str, IntArray]) -> FloatArray:
        return np.asarray(10 + sum(factors[name] * drawn[name][numbers] for name, numbers in rows.items()))

    result, whole = sobol_shares(power, NAMES, COUNT), sum(factor**2 for factor in factors.values())
    for name, factor in factors.items():
        assert result[name].first == pytest.approx(factor**2 / whole, abs=0.01)
        assert result[name].total == pytest.approx(factor**2 / whole, abs=0.01)
        assert result[name].first_error < 0.1


def test_shares_of_a_sum_and_a_product() -> None:
    """1 + x + y z: y and z explain nothing alone, and together (1/9) / (1/3 + 1/9) = a quarter of the variance."""
    drawn = realisations()

    def power(rows: dict[str, IntArray]) -> FloatArray:
        x, y, z = (drawn[name][rows[name]] if name in rows else 0.0 for name in NAMES)
        return np.asarray(1 + x + y * z + np.zeros(len(next(iter(rows.values())))))

    result = sobol_shares(power, NAMES, COUNT)
    assert [result[name].first for name in NAMES] == pytest.approx([0.75, 0, 0], abs=0.03)
    assert [result[name].total for name in NAMES] == pytest.approx([0.75, 0.25, 0.25], abs=0.03)


def test_shares_are_the_same_every_time_and_without_the_linkages_that_do_not_turn() -> None:
    drawn = realisations()

    def power(rows: dict[str, IntArray]) -> FloatArray:
        total = np.asarray(sum(drawn[name][numbers] for name, numbers in rows.items()))
        return np.where(total > 2.5, np.nan, total)

    result = sobol_shares(power, NAMES, COUNT, 256)
    assert result == sobol_shares(power, NAMES, COUNT, 256)
    assert all(0.2 < share.first < 0.45 for share in result.values())


def test_without_salib_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SALib", None)
    with pytest.raises(MissingPartError, match=r"pip install 'fes-mj\[paper\]'"):
        sobol_shares(lambda rows: np.zeros(3), NAMES, 3)

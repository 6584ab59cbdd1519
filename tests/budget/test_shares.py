"""Shares of variance on models whose shares are known in closed form."""

import sys

import numpy as np
import pytest

from fes_mj.budget.budget import shares
from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import MissingPartError

COUNT = 500
NAMES = ("one", "two", "three")


def realisations() -> dict[str, FloatArray]:
    """Even from -1 to 1, in any order: the shares must find the order that helps them."""
    random = np.random.default_rng(4)
    return {name: random.permutation(np.linspace(-1, 1, COUNT)) for name in NAMES}


def test_of_a_sum_they_are_the_squares_of_its_factors() -> None:
    drawn, factors = realisations(), {"one": 3.0, "two": 2.0, "three": 1.0}

    def power(rows: dict[str, IntArray]) -> FloatArray:
        return np.asarray(10 + sum(factors[name] * drawn[name][numbers] for name, numbers in rows.items()))

    result, whole = shares(power, NAMES, COUNT), sum(factor**2 for factor in factors.values())
    for name, factor in factors.items():
        assert result[name].first == pytest.approx(factor**2 / whole, abs=0.01)
        assert result[name].total == pytest.approx(factor**2 / whole, abs=0.01)
        assert result[name].first_error < 0.1


def test_of_a_sum_and_a_product() -> None:
    """1 + x + y z: y and z explain nothing alone, and together (1/9) / (1/3 + 1/9) = a quarter of the variance."""
    drawn = realisations()

    def power(rows: dict[str, IntArray]) -> FloatArray:
        x, y, z = (drawn[name][rows[name]] if name in rows else 0.0 for name in NAMES)
        return np.asarray(1 + x + y * z + np.zeros(len(next(iter(rows.values())))))

    result = shares(power, NAMES, COUNT)
    assert [result[name].first for name in NAMES] == pytest.approx([0.75, 0, 0], abs=0.03)
    assert [result[name].total for name in NAMES] == pytest.approx([0.75, 0.25, 0.25], abs=0.03)


def test_the_same_every_time_and_without_the_linkages_that_do_not_turn() -> None:
    drawn = realisations()

    def power(rows: dict[str, IntArray]) -> FloatArray:
        total = np.asarray(sum(drawn[name][numbers] for name, numbers in rows.items()))
        return np.where(total > 2.5, np.nan, total)

    result = shares(power, NAMES, COUNT, 256)
    assert result == shares(power, NAMES, COUNT, 256)
    assert all(0.2 < share.first < 0.45 for share in result.values())


def test_without_salib_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SALib", None)
    with pytest.raises(MissingPartError, match=r"pip install 'fes-mj\[paper\]'"):
        shares(lambda rows: np.zeros(3), NAMES, 3)

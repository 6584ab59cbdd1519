"""Samples within tolerances against one design at a time."""

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.tolerance import to_manufacturing, to_rider
from fes_mj.statics.turn import quasi_static
from tests.optimization.conftest import TABLE


def test_tolerance_against_one_design_at_a_time() -> None:
    """R2's links barely close: its share of turning samples, against the assembly condition itself."""
    from fes_mj.linkage.turning import turning
    from fes_mj.linkage.variables import lengths, with_lengths

    design = fes_mj.load_design("r2")
    sampled = to_manufacturing(design, TABLE, np.random.default_rng(0))
    random, count, powers = np.random.default_rng(1), 0, []
    for _ in range(400):
        built = with_lengths(design, lengths(design) + random.uniform(-0.001, 0.001, 9))
        try:
            turning(built)
        except fes_mj.AssemblyError:
            continue
        count += 1
        powers.append(quasi_static(built, fes_mj.load_moments("p1p2"), points=360).power_mean)
    share = count / 400
    assert 0.2 < share < 0.98
    # four standard deviations of a share of 400
    assert sampled.turning == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / 400))
    assert sampled.power_low == 0.0
    assert max(powers) > sampled.power_median > 0


def test_tolerance_of_a_forgiving_design() -> None:
    design, random = fes_mj.load_design("d1"), np.random.default_rng(0)
    built, ridden = to_manufacturing(design, TABLE, random), to_rider(design, TABLE, random)
    assert built.turning == 1.0
    own = quasi_static(design, fes_mj.load_moments("p1p2")).power_mean
    assert own - 1 < built.power_low < built.power_median < own + 1
    assert ridden.power_low < built.power_low

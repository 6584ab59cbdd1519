"""Who does the work, on moments with known answers."""

import numpy as np
import pytest

from fes_mj.moments.files import sampled_coefficients
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.paper.evidence import functional, load_evidence
from fes_mj.paper.work_shares import shares, work


def test_a_constant_knee_moment_does_no_net_work() -> None:
    """What the extensors do while the knee extends they take back while it flexes; nobody else works."""
    curves = np.zeros((1, 98))
    curves[0, 0] = 10.0
    done = work(curves, 0.515)
    low, high = PAPER_TRICYCLE.ranges.knee
    assert done["knee extensors"].net == pytest.approx(0, abs=1e-6)
    # 10 N m over the knee's range, per 2 pi of crank angle; legs of 52 cm have the tricycle's own range
    assert work(curves, 0.52)["knee extensors"].concentric == pytest.approx(10 * (high - low) / (2 * np.pi), rel=1e-4)
    for idle in ("knee flexors", "hip extensors", "hip flexors"):
        assert done[idle].concentric == done[idle].eccentric == 0


def test_all_muscles_together_do_the_work_of_the_leg() -> None:
    curves = sampled_coefficients("p1p2")[:5]
    (row,) = (row for row in load_evidence() if row.name == "p1p2 15 W with own legs")
    net = sum(of_muscles.net for of_muscles in work(curves, row.leg_m).values())
    assert PAPER_TRICYCLE.cadence * net == pytest.approx(curves @ functional(row))


def test_shares_add_up() -> None:
    curves = sampled_coefficients("p1p3")[:5]
    muscles = ("knee extensors", "knee flexors", "hip extensors", "hip flexors")
    net, concentric = zip(*(shares(curves, 0.542, name) for name in muscles), strict=True)
    assert np.sum(net, axis=0) == pytest.approx(100)
    assert np.sum(concentric, axis=0) == pytest.approx(100)
    eccentric = shares(curves, 0.542, "eccentric")
    # all net work is concentric and eccentric: e / (c + e) and e / c
    assert eccentric[0] == pytest.approx(100 * eccentric[1] / (100 + eccentric[1]))

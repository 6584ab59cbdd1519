"""What is said of a winner, against the commands and methods that say the same of any design."""

import numpy as np
import pytest

import fes_mj
from fes_mj.crosscheck.turn_output import turn_summary
from fes_mj.linkage.kinematics import solve
from fes_mj.optimization.ripple import RippleLimit
from fes_mj.optimization.winner import Winner, assess

MOMENTS = fes_mj.load_moments("p1p2")


@pytest.fixture(scope="module", params=["r2", "d1"])
def winner(request: pytest.FixtureRequest) -> Winner:
    return assess(fes_mj.load_design(request.param), fes_mj.load_design("trt"), MOMENTS)


def test_smoothness_is_that_of_the_exact_dynamics(winner: Winner) -> None:
    """Not MuJoCo's: inverse dynamics at the same crank angles, within what the case's own check allows many times."""
    exact, said = winner.case.reference_power(), winner.smoothness
    assert said["power_lowest_W"] == pytest.approx(exact.min(), abs=0.5)
    assert said["power_highest_W"] == pytest.approx(exact.max(), abs=0.5)
    assert said["power_peak_to_peak_W"] == pytest.approx(turn_summary(winner.case)["power_peak_to_peak_W"], rel=1e-12)
    population = RippleLimit(1.0, MOMENTS).ripple(winner.design)[0]
    assert said["speed_ripple"] == pytest.approx(population, rel=0.01)  # of 120 angles, see test_ripple


def test_reversals_are_changes_of_sign_of_the_joint_speed(winner: Winner) -> None:
    motion = solve(winner.design, np.radians(np.arange(0.0, 360.0, 0.05)))
    for count, angle in zip(winner.reversals, motion.joint_angle, strict=True):
        direction = np.sign(np.roll(angle, -1) - angle)
        assert count == np.sum(direction != np.roll(direction, 1))


def test_the_table_says_all_of_it(winner: Winner) -> None:
    rows, said = dict(winner.rows), winner.smoothness
    low, high = (said[f"power_{end}_W"] for end in ("lowest", "highest"))
    assert rows["simulated power of one leg, lowest to highest, W"] == f"{low:+.0f} to {high:+.0f}"
    assert rows["the same, peak to peak, W"] == f"{high - low:.0f}"
    assert rows["ripple of the crank speed, two legs, fixed gear, %"] == f"{100 * winner.ripple:.1f}"
    assert rows["reversals of knee and hip in a turn"] == f"{winner.reversals.knee}, {winner.reversals.hip}"

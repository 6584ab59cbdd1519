"""What is said of a winner: against commands and methods that say the same of any design, one design at a time, and
the quadratic form in the covariance of the moments.
"""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.kinematics import solve
from fes_mj.optimization.evenness import RippleLimit
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.winner import Winner, assess, gain, to_manufacturing, to_rider
from fes_mj.statics.cycles import cycles
from fes_mj.statics.turn import difference_sd, quasi_static
from fes_mj.statics.work_table import uncertain_table
from tests.optimization.conftest import TABLE, problem_of

MOMENTS = fes_mj.load_moments("p1p2")


@pytest.fixture(scope="module", params=["r2", "d1"])
def winner(request: pytest.FixtureRequest) -> Winner:
    return assess(fes_mj.load_design(request.param), fes_mj.load_design("trt"), MOMENTS)


def test_smoothness_is_that_of_the_exact_dynamics(winner: Winner) -> None:
    """Not MuJoCo's: inverse dynamics at the same crank angles, within what the case's own check allows many times."""
    exact, said = winner.case.reference_power(), winner.smoothness
    assert said["simulated_power_lowest_W"] == pytest.approx(exact.min(), abs=0.5)
    assert said["simulated_power_highest_W"] == pytest.approx(exact.max(), abs=0.5)
    assert said["simulated_power_peak_to_peak_W"] == pytest.approx(
        winner.case.summary()["simulated_power_peak_to_peak_W"], rel=1e-12
    )
    population = RippleLimit(1.0, MOMENTS).ripple(winner.design)[0]
    assert said["speed_ripple"] == pytest.approx(population, rel=0.01)  # of 120 angles, see test_ripple


def test_reversals_are_changes_of_sign_of_the_joint_speed(winner: Winner) -> None:
    motion = solve(winner.design, np.radians(np.arange(0.0, 360.0, 0.05)))
    for count, angle in zip(winner.reversals, motion.joint_angle, strict=True):
        direction = np.sign(np.roll(angle, -1) - angle)
        assert count == np.sum(direction != np.roll(direction, 1))


def test_the_table_says_all_of_it(winner: Winner) -> None:
    rows, said = dict(winner.rows), winner.smoothness
    low, high = (said[f"simulated_power_{end}_W"] for end in ("lowest", "highest"))
    assert rows["simulated power of one leg, lowest to highest, W"] == f"{low:+.0f} to {high:+.0f}"
    assert rows["the same, peak to peak, W"] == f"{high - low:.0f}"
    assert rows["ripple of the crank speed, two legs, fixed gear, %"] == f"{100 * winner.ripple:.1f}"
    assert rows["reversals of knee and hip in a turn"] == f"{winner.reversals.knee}, {winner.reversals.hip}"


GROUPS = ("p1p2", "p1p3")


def powers(design: fes_mj.Design, group: str) -> np.ndarray:
    """Mean power and its deviations, W, by the table."""
    table = uncertain_table(fes_mj.load_moments(group))
    return cycles(design, table).work[0] * design.linkage.cadence / (2 * np.pi)


@pytest.mark.parametrize("group", GROUPS)
def test_mean_and_deviation_are_those_of_statics(design: fes_mj.Design, group: str) -> None:
    static, power = fes_mj.quasi_static(design, fes_mj.load_moments(group)), powers(design, group)
    assert power[0] == pytest.approx(static.power_mean, rel=1e-4)
    assert np.linalg.norm(power[1:]) == pytest.approx(static.power_sd, rel=1e-3)


@pytest.mark.parametrize("group", GROUPS)
def test_the_error_of_a_gain_knows_that_powers_are_correlated(group: str) -> None:
    better, worse = (fes_mj.quasi_static(fes_mj.load_design(name), fes_mj.load_moments(group)) for name in ("d2", "d1"))
    own = gain(powers(better.design, group), powers(worse.design, group))
    assert own.mean == pytest.approx(better.power_mean - worse.power_mean, rel=1e-3)
    assert own.deviation == pytest.approx(difference_sd(better, worse), rel=1e-2)
    uncorrelated = np.hypot(better.power_sd, worse.power_sd)
    assert abs(own.deviation - uncorrelated) > 0.01 * own.deviation


def test_a_gain_over_oneself_is_certain() -> None:
    power = np.array([30.0, 0.4, -0.2])
    assert gain(power, power) == (0.0, 0.0)


def test_own_moments_have_no_known_error(smooth_moments: fes_mj.JointMoments) -> None:
    with pytest.raises(InputError, match="smooth: "):
        uncertain_table(smooth_moments)


def test_caution_trades_gain_for_certainty() -> None:
    pytest.importorskip("cma")
    table, base = uncertain_table(fes_mj.load_moments("p1p3")), problem_of("d2", grashof_min=0.005)
    gains = []
    for caution in (0.0, 2.0):
        own = fes_mj.load_design("d2")
        baseline = cycles(own, table).work[0] * own.linkage.cadence / (2 * np.pi)
        problem = Problem(own, table, base.limits, base.joint_speed, MomentDrive(None, caution, baseline))
        x = run_searches(problem, "cma-es", budget=4500, seed=4)[0].x
        gains.append(gain(problem.evaluate(x[None]).power[0], baseline))
    assert gains[1].deviation < gains[0].deviation
    assert gains[1].mean > 2 * gains[1].deviation


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
        if count <= 20:
            powers.append(quasi_static(built, MOMENTS, points=360).power_mean)
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

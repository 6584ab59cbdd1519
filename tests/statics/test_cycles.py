"""The work of a turn from its reversals, against the quasi-static solver and an integral of its own."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import component, lengths, replaced, with_lengths
from fes_mj.statics.cycles import cycles, joint_speeds, reversals
from fes_mj.statics.turn import QuasiStatic, quasi_static
from fes_mj.statics.work_table import WorkTable, uncertain_table

FINE = 36_000
LEGS = 0.03  # m


def varied(design: fes_mj.Design, count: int, seed: int = 0) -> fes_mj.Design:
    """A batch around a design, six-bar lengths by up to 1 cm and legs by up to 3 cm; some cannot turn."""
    random = np.random.default_rng(seed)
    drawn = lengths(design)[:, None, None] + random.uniform(-0.01, 0.01, (9, count, 1))
    return replaced(with_lengths(design, drawn), {"thigh": 0.52 + random.uniform(-LEGS, LEGS, (count, 1))})


def test_work_is_that_of_the_quasi_static_solver(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    exact = quasi_static(design, moments, points=FINE)
    turn = cycles(design, WorkTable.of(moments))
    assert turn.work[0, 0] == pytest.approx(exact.work_per_turn, rel=2e-5)
    assert np.degrees(turn.joints.knee.low[0]) == pytest.approx(np.degrees(exact.joint_angle.knee.min()), abs=1e-3)
    assert np.degrees(turn.joints.hip.high[0]) == pytest.approx(np.degrees(exact.joint_angle.hip.max()), abs=1e-3)


def test_work_of_moments_nobody_fitted(design: fes_mj.Design, smooth_moments: fes_mj.JointMoments) -> None:
    exact = quasi_static(design, smooth_moments, points=FINE)
    error = cycles(design, WorkTable.of(smooth_moments)).work[0, 0] - exact.work_per_turn
    # relative to what flows in and out, which the net work is a small difference of
    flow = np.abs(exact.crank_moment).mean() * 2 * np.pi
    assert abs(error) < 1e-4 * flow


@pytest.mark.parametrize("name", ["seat_angle", "gear_ratio", "mass", "R6", "R1x"])
@pytest.mark.parametrize("count", [3, 150])
def test_any_single_variable_makes_a_batch(name: str, count: int) -> None:
    design, table = fes_mj.load_design("d1"), uncertain_table(fes_mj.load_moments())
    values = component(design, name) + np.linspace(0, 0.01, count)
    together = cycles(replaced(design, {name: values[:, None]}), table)
    for row in (0, count - 1):
        alone = cycles(replaced(design, {name: float(values[row])}), table)
        assert together.work[row] == pytest.approx(alone.work[0], rel=1e-12)
        assert together.outside[0][row] == pytest.approx(alone.outside[0][0])
    assert together.turns.shape == together.turning.reach.shape == together.outside_sd.shape == (count,)


def solved(design: fes_mj.Design, moments: fes_mj.JointMoments) -> QuasiStatic | InputError:
    """The result of the quasi-static solver, or why there is none."""
    try:
        return quasi_static(design, moments)
    except InputError as error:
        return error


@pytest.mark.parametrize("name", ["trt", "r1", "d2"])
def test_random_designs_in_a_batch_fare_as_alone(name: str, moments: fes_mj.JointMoments) -> None:
    """What is refused and why, mean power, its standard deviation and the share outside the moments' range."""
    random, design, count = np.random.default_rng(1), fes_mj.load_design(name), 25
    ranges = {"thigh": (0.40, 0.60), "shank": (0.40, 0.60), "seat_angle": (0, 60)}
    values = {key: random.uniform(*ends, (count, 1)) for key, ends in ranges.items()}
    together, fates = cycles(replaced(design, values), uncertain_table(moments)), set()
    for row in range(count):
        alone = replaced(design, {key: float(column[row, 0]) for key, column in values.items()})
        reasons = [obstacle.reason for obstacle in together.turning.obstacles if obstacle.hindered[row]]
        outside = [joint for joint, which in together.outside[1].items() if which[row]]
        assert bool(reasons) != together.turns[row]
        result = solved(alone, moments)
        if isinstance(result, AssemblyError):
            assert f"{design.name}: {reasons[0].partition(' through')[0]}" in str(result)
            fates.add("cannot turn")
        elif isinstance(result, InputError):
            assert all(f"the {joint} moves from" in str(result) for joint in outside)
            assert outside
            fates.add("never inside")
        else:
            assert not reasons + outside
            per_work = result.cadence / (2 * np.pi)
            power, *deviations = together.work[row] * per_work
            assert power == pytest.approx(result.power_mean, rel=2e-4, abs=2e-3)
            assert together.outside[0][row] == pytest.approx(result.extrapolation.share, abs=4e-3)
            assert together.outside_sd[row] * per_work == pytest.approx(result.extrapolation.sd, rel=2e-3, abs=5e-3)
            deviation = np.hypot(np.linalg.norm(deviations), together.outside_sd[row] * per_work)
            assert deviation == pytest.approx(result.power_sd, rel=2e-3)
            fates.add("outside" if result.extrapolation.share else "inside")
    assert fates >= {"cannot turn", "never inside", "outside"}


@pytest.mark.parametrize("name", ["trt", "d1", "d2"])
def test_a_seat_angle_a_turn_away_is_the_same_seat(name: str) -> None:
    design, table = fes_mj.load_design(name), uncertain_table(fes_mj.load_moments())
    seat = design.linkage.seat_angle - np.radians(8)
    one, other = (cycles(design.with_linkage(seat_angle=angle), table) for angle in (seat, seat - 2 * np.pi))
    assert one.outside[0][0] > 0
    assert one.outside[0] == pytest.approx(other.outside[0], abs=1e-9)
    assert one.outside_sd == pytest.approx(other.outside_sd, rel=1e-9)
    assert one.work == pytest.approx(other.work, abs=1e-9)


def test_travel_is_the_integral_of_the_absolute_rate(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, FINE, endpoint=False))
    speeds = joint_speeds(design, WorkTable.of(moments))
    for joint, rate in (("knee", motion.joint_rate.knee), ("hip", motion.joint_rate.hip)):
        exact = np.degrees(np.abs(rate).mean()) * design.linkage.cadence
        assert speeds[joint] == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("name", ["d1", "r2"])
def test_a_batch_is_its_designs_one_by_one(name: str, moments: fes_mj.JointMoments) -> None:
    batch, table = varied(fes_mj.load_design(name), 200), WorkTable.of(moments)
    together = cycles(batch, table)
    reaching = together.turning.reach > 0
    assert 0 < reaching.sum() < 200
    for row in np.flatnonzero(reaching)[:20]:
        alone = cycles(batch.single(int(row)), table)
        assert together.work[row, 0] == pytest.approx(alone.work[0, 0], rel=1e-12)
        assert together.joints.hip.low[row] == pytest.approx(alone.joints.hip.low[0], rel=1e-12)
    for row in np.flatnonzero(~reaching)[:20]:
        assert np.isnan(together.work[row]).all()
        assert np.isnan(together.joints.knee.travel[row])
        with pytest.raises(fes_mj.AssemblyError):
            turning(batch.single(int(row)))


def test_sets_of_moments_side_by_side_are_the_sets_alone() -> None:
    design, both = fes_mj.load_design("d2"), [fes_mj.load_moments(group) for group in ("p1p2", "p1p3")]
    together = cycles(design, WorkTable.of(*both)).work[0]
    assert together == pytest.approx([cycles(design, WorkTable.of(moments)).work[0, 0] for moments in both], rel=1e-14)


def test_work_does_not_depend_on_how_often_a_joint_reverses() -> None:
    """Two strokes a turn do twice the work of one: the table is per stroke."""
    table = WorkTable.of(fes_mj.load_moments("p1p2"))
    angle = np.linspace(0, 2 * np.pi, 240, endpoint=False)
    once = np.radians(95 + 20 * np.cos(angle))[None]
    twice = np.radians(95 + 20 * np.cos(2 * angle))[None]
    work = []
    for motion in (once, twice):
        _, turned, sign = reversals(motion)
        work.append(float(table.work("knee", turned, sign, np.array([len(turned)]))[0, 0]))
        assert len(turned) == 2 * len(work)
    assert work[1] == pytest.approx(2 * work[0], rel=1e-9)
    assert work[0] > 1.0


def test_reversals_lie_between_the_samples() -> None:
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    rows, turned, sign = reversals(np.stack([np.cos(angle - shift) for shift in (0.0, 0.011, 0.03, 2.0)]))
    assert np.bincount(rows).tolist() == [2, 2, 2, 2]
    assert turned == pytest.approx(sign, abs=2e-6)

"""The machine-code loop against the Python one: the same run, bit for bit."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import UnstableError
from fes_mj.simulation.bench import BenchOptions, simulate
from fes_mj.simulation.compiled import compiled_loop
from fes_mj.simulation.stepping import feedback_loop

pytest.importorskip("numba")


@pytest.mark.parametrize(("name", "legs"), [("trt", 1), ("r2", 1), ("d1", 2)])
def test_the_same_run(name: str, legs: int, smooth_moments: fes_mj.JointMoments) -> None:
    design = fes_mj.load_design(name)
    slow, fast = (
        simulate(design, smooth_moments, legs=legs, options=BenchOptions(make_loop=maker))
        for maker in (feedback_loop, compiled_loop)
    )
    assert np.array_equal(slow.crank_moment, fast.crank_moment)
    for mine, other in ((slow.joint_moment, fast.joint_moment), (slow.loop_force, fast.loop_force)):
        assert all(np.array_equal(mine[name], other[name]) for name in mine)
    assert slow.energy == fast.energy


def test_another_map_is_another_run() -> None:
    """The compiled loop takes its tables as they come: nothing of an earlier map stays behind."""
    design = fes_mj.load_design("d1")
    powers = [
        simulate(design, fes_mj.load_moments(group), options=BenchOptions(make_loop=compiled_loop)).power_mean
        for group in ("p1p2", "p1p3", "p1p2")
    ]
    assert powers[0] == powers[2]
    assert powers[1] == pytest.approx(fes_mj.quasi_static(design, fes_mj.load_moments("p1p3")).power_mean, rel=5e-4)


def test_a_run_that_breaks_down_says_so(smooth_moments: fes_mj.JointMoments) -> None:
    huge = fes_mj.JointMoments("huge", smooth_moments.crank_angle, 1e13 * smooth_moments.knee, smooth_moments.hip)
    with pytest.raises(UnstableError, match=r"d1: .*unstable"):
        simulate(fes_mj.load_design("d1"), huge, options=BenchOptions(make_loop=compiled_loop))

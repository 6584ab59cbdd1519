"""The machine-code loop against the Python one: the same run, bit for bit."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.errors import UnstableError
from fes_mj.joints import JOINTS
from fes_mj.simulation.bench import simulate
from fes_mj.simulation.compiled import compiled_loop
from fes_mj.simulation.stepping import feedback_loop
from fes_mj.torque_map import TorqueMap, scalar_map

pytest.importorskip("numba")


@pytest.mark.parametrize(("name", "legs"), [("trt", 1), ("r2", 1), ("d1", 2)])
def test_the_same_run(name: str, legs: int, smooth_moments: fes_mj.JointMoments) -> None:
    design = fes_mj.load_design(name)
    slow, fast = (
        simulate(design, smooth_moments, legs=legs, make_loop=maker) for maker in (feedback_loop, compiled_loop)
    )
    assert np.array_equal(slow.crank_moment, fast.crank_moment)
    for mine, other in ((slow.joint_moment, fast.joint_moment), (slow.loop_force, fast.loop_force)):
        assert all(np.array_equal(mine[name], other[name]) for name in mine)
    assert slow.energy == fast.energy


def test_another_map_is_another_run() -> None:
    """The compiled loop takes its tables as they come: nothing of an earlier map stays behind."""
    design = fes_mj.load_design("d1")
    powers = [
        simulate(design, fes_mj.load_moments(group), make_loop=compiled_loop).power_mean
        for group in ("p1p2", "p1p3", "p1p2")
    ]
    assert powers[0] == powers[2]
    assert powers[1] == pytest.approx(fes_mj.quasi_static(design, fes_mj.load_moments("p1p3")).power_mean, rel=5e-4)


def test_a_run_that_breaks_down_says_so(smooth_moments: fes_mj.JointMoments) -> None:
    huge = fes_mj.JointMoments("huge", smooth_moments.crank_angle, 1e13 * smooth_moments.knee, smooth_moments.hip)
    with pytest.raises(UnstableError, match="d1: the simulation became unstable"):
        simulate(fes_mj.load_design("d1"), huge, make_loop=compiled_loop)


@pytest.mark.parametrize("joint", JOINTS)
def test_the_map_of_floats_is_the_map_of_arrays(joint: str, moments: fes_mj.JointMoments) -> None:
    torque_map = TorqueMap(moments)
    scalar = scalar_map(joint, lambda value: math.acos(min(1.0, max(-1.0, value))))
    angles, table = np.linspace(1.0, 2.4, 201), torque_map.table[joint]
    for rate in (-1.0, 0.0, 1.0):
        expected = torque_map.moment(joint, angles, rate)
        assert [scalar(torque_map.parameters(joint), table, angle, rate) for angle in angles] == pytest.approx(
            list(expected), abs=1e-9
        )

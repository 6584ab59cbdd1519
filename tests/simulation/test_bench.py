"""A measured run: whole turns, energies, and the forces in its loops."""

import numpy as np
import pytest

import fes_mj
from fes_mj.simulation.stepping import FORCE_EVERY


def test_measured_turns_are_whole(smooth_moments: fes_mj.JointMoments) -> None:
    run = fes_mj.simulate(fes_mj.load_design("r1"), smooth_moments, turns=2)
    assert run.crank_angle[-1] - run.crank_angle[0] == pytest.approx(4 * np.pi, rel=1e-3)
    steps = len(run.crank_angle) // 2
    assert run.power[:steps].mean() == pytest.approx(run.power[steps:].mean(), rel=1e-6)


def test_energy_terms_come_back_after_whole_turns(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    energy = fes_mj.simulate(design, moments).energy
    assert abs(energy.kinetic) < 1e-3 * energy.joint_work
    assert abs(energy.potential) < 1e-3 * energy.joint_work
    assert energy.crank_work == pytest.approx(energy.joint_work, rel=1e-3)


def test_constraint_forces_are_the_reactions_of_the_massive_equilibrium(
    design: fes_mj.Design, smooth_moments: fes_mj.JointMoments
) -> None:
    """MuJoCo's constraint force at each cut joint against free-body equilibrium with d'Alembert loads.

    Without the steps at which a joint turns round: there the map jumps, and which side a step falls on is rounding.
    """
    from fes_mj.linkage.inertia import body_loads
    from fes_mj.linkage.kinematics import solve
    from fes_mj.statics.equilibrium import equilibrium

    run = fes_mj.simulate(design, smooth_moments)
    motion = solve(design, run.crank_angle)
    _, reactions = equilibrium(motion, run.torque.along(motion, run.cadence), body_loads(motion, run.cadence))
    turning = np.zeros(run.crank_angle.shape, bool)
    for rate in (motion.joint_rate.knee, motion.joint_rate.hip):
        turning |= np.convolve(np.abs(np.diff(np.sign(rate), append=0)) > 0, np.ones(7), "same") > 0
    assert turning.mean() < 0.02
    for loop, force in run.loop_force.items():
        size = np.abs(reactions[loop])[::FORCE_EVERY]
        assert np.sqrt(np.mean((np.abs(force) - size)[~turning[::FORCE_EVERY]] ** 2)) < 0.01 * size.max(), loop


@pytest.mark.parametrize("legs", [0, 3])
def test_a_rider_has_one_leg_or_two(legs: int, smooth_moments: fes_mj.JointMoments) -> None:
    design = fes_mj.load_design("d1")
    with pytest.raises(fes_mj.InputError, match=f"legs is {legs}"):
        fes_mj.simulate(design, smooth_moments, legs=legs)
    with pytest.raises(fes_mj.InputError, match="legs"):
        fes_mj.build_mjcf(design, legs=legs)

"""Joint forces against equilibrium of single bodies."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.inertia import GRAVITY, body_loads
from fes_mj.linkage.riders import leg_mass_after_injury
from fes_mj.statics.joint_forces import JointForces, peaks
from fes_mj.statics.turn import quasi_static


def test_a_massless_leg_hands_one_force_on_from_pedal_to_hip(
    design: fes_mj.Design, moments: fes_mj.JointMoments
) -> None:
    """And Newton's second law holds for shank and thigh with their masses."""
    joint_forces = JointForces(quasi_static(design, moments))
    forces = joint_forces.static.reactions
    for joint in ("knee", "hip"):
        assert np.abs(forces[joint]) == pytest.approx(np.abs(forces["pedal"]), abs=1e-9)
    massive, inertia = joint_forces.with_masses, body_loads(joint_forces.static.motion, joint_forces.static.cadence)
    assert massive["knee"] - massive["pedal"] == pytest.approx(-inertia["shank"].force, abs=1e-8)
    assert massive["hip"] - massive["knee"] == pytest.approx(-inertia["thigh"].force, abs=1e-8)


def test_shear_and_compression_are_parts_of_the_knee_force(design: fes_mj.Design) -> None:
    joint_forces = JointForces(quasi_static(design, fes_mj.load_moments("p1p2")))
    weight = design.rider.mass * GRAVITY
    for forces in (joint_forces.static.reactions, joint_forces.with_masses):
        assert max(joint_forces.knee(forces)) <= peaks(forces)["knee"] / weight
    # along the femur a force that pushes the shank away from the hip presses; across it none does
    along = joint_forces.static.motion.direction("thigh")
    assert joint_forces.knee({"knee": 2 * weight * along}) == pytest.approx((0, 2))
    assert joint_forces.knee({"knee": -2 * weight * along}) == pytest.approx((0, 0))
    assert joint_forces.knee({"knee": 2j * weight * along}) == pytest.approx((2, 0))


def test_lighter_legs_have_an_error_and_full_ones_none() -> None:
    """Forces are linear in the masses; the error is what the peaks of legs one deviation lighter and heavier span."""
    design, moments = fes_mj.load_design("r2"), fes_mj.load_moments("p1p2")
    factor, deviation = leg_mass_after_injury()
    assert JointForces(quasi_static(design, moments)).leg_mass_sd is None
    less, middle, more = (
        JointForces(quasi_static(design.with_rider(leg_mass_factor=factor + sign * deviation), moments))
        for sign in (-1, 0, 1)
    )
    for joint, force in middle.with_masses.items():
        assert force == pytest.approx((less.with_masses[joint] + more.with_masses[joint]) / 2, abs=1e-6)
    spans = {joint: (peak - peaks(less.with_masses)[joint]) / 2 for joint, peak in peaks(more.with_masses).items()}
    assert middle.leg_mass_sd == pytest.approx({joint: abs(span) for joint, span in spans.items()})

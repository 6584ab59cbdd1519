import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.pull import pull

ANGLE = np.linspace(0, 2 * np.pi, 360, endpoint=False)


@pytest.mark.parametrize("name", DESIGNS)
def test_fibres_do_the_work_that_joints_do(name, riders):
    design = load_design(name)
    motion = kinematics.solve(design, ANGLE)
    pulled = pull(riders, motion, design.linkage.cadence)
    joints = sum(pulled.moment[joint] * motion.joint_rate[joint] for joint in ("knee", "hip")) * design.linkage.cadence
    assert joints == pytest.approx(pulled.power, rel=1e-13, abs=1e-12 * np.abs(pulled.power).max())


def test_speed_is_the_change_of_length(riders):
    design, step, offset = load_design("d1"), 1e-6, np.radians(riders["hip_offset_deg"])
    pulled = pull(riders, kinematics.solve(design, ANGLE), 10.0)
    before, after = (
        pulled.anatomy.lengths.at(Flexion.along(kinematics.solve(design, ANGLE + shift), offset)).value
        for shift in (-step, step)
    )
    assert pulled.speed == pytest.approx(10.0 * (after - before) / (2 * step), abs=1e-7)


def test_batch_is_each_of_its_designs(riders):
    design = load_design("d1")
    cranks = design.linkage.crank * np.array([[0.98], [1.0]])
    batch = pull(riders, kinematics.solve(design.with_linkage(crank=cranks), ANGLE), np.array([[8.0], [10.0]]))
    alone = pull(riders, kinematics.solve(design, ANGLE), 10.0)
    assert batch.power[:, :, 1:] == pytest.approx(alone.power, rel=1e-12, abs=1e-9)


def test_rectus_is_recruited_apart_and_groups_are_sums(riders):
    design = load_design("trt")
    pulled = pull(riders, kinematics.solve(design, ANGLE), design.linkage.cadence)
    rectus = pulled.anatomy.rectus
    vasti = (pulled.anatomy.group == MUSCLE_GROUPS.index("quadriceps")) & ~rectus
    both = pulled.force * pulled.speed * pulled.scale
    assert pulled.power[0] == pytest.approx(-(both[vasti].sum(axis=0) + both[rectus][0]))
    relative = riders.strength(pulled.anatomy)[rectus][0] / riders.strength(pulled.anatomy)[vasti][0]
    assert relative == pytest.approx(riders["rectus_recruitment"])

import numpy as np
import pytest

from fes_mj.common.reading import read_toml
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.passive import PASSIVE_FILE, passive_moments, published


@pytest.mark.parametrize("name", DESIGNS)
def test_a_closed_turn_costs_nothing(name):
    motion = kinematics.solve(load_design(name))
    moments, rates = passive_moments(Flexion.along(motion)), motion.joint_rate
    knee, hip = (2 * np.pi * float(np.mean(moments[joint] * rates[joint])) for joint in ("knee", "hip"))
    assert knee + hip == pytest.approx(0, abs=1e-12)  # J
    # what one joint gives the other takes; in a CRT the leg goes back the way it came
    assert (abs(knee) > 1e-2) == (not name.startswith("r"))


def test_published_curves_would_give_the_tricycle_work():
    # J a turn, muscles.md of the design: 1.4, which the potential mends
    motion = kinematics.solve(load_design("trt"))
    flexion = Flexion.along(motion)
    moments = published(*np.degrees(flexion))
    work = sum(-2 * np.pi * np.mean(moments[joint] * motion.joint_rate[joint]) for joint in ("knee", "hip"))
    assert work == pytest.approx(1.4, abs=0.05)


def test_distance_from_the_published_curves_is_the_stated_one():
    hip, knee = np.meshgrid(np.arange(30.0, 121), np.arange(10.0, 126))
    moments, said = passive_moments(Flexion(np.radians(hip), np.radians(knee))), published(hip, knee)
    distance = [float(np.abs(moments[joint] + said[joint]).max()) for joint in ("knee", "hip")]
    assert distance == pytest.approx(
        read_toml(PASSIVE_FILE, "passive moments").content["largest_distance_Nm"], abs=0.005
    )


def test_joints_are_pushed_back_from_their_ends():
    ends = passive_moments(Flexion(np.radians([115.0, 70.0]), np.radians([60.0, 122.0])))
    assert ends.hip[0] > 10  # N m of extension, at a hip bent that far
    assert ends.knee[1] > 0

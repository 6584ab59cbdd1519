from dataclasses import replace

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Rider
from fes_mj.linkage.riders import boot_height
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.contraction import tension
from fes_mj.muscles.geometry import Flexion

LEG = Flexion(*np.radians(np.meshgrid(np.arange(55.0, 101.0, 5), np.arange(55.0, 116.0, 5))))
EXTENSORS = {"vas_int": "knee", "vas_lat": "knee", "vas_med": "knee", "rect_fem": "knee"} | dict.fromkeys(
    ("semimem", "semiten", "bifemlh", "glut_max2", "glut_max3"), "hip"
)


def test_muscles_pass_the_joints_that_anatomy_says():
    muscles = anatomy()
    values = muscles.lengths.at(LEG)
    for row, name in enumerate(muscles.names):
        about = {joint for joint, arms in (("hip", values.by_hip), ("knee", values.by_knee)) if arms[row].any()}
        two = name in ("rect_fem", "semimem", "semiten", "bifemlh")
        assert about == ({"hip", "knee"} if two else {"hip"} if name.startswith("glut") else {"knee"})
    for name, joint in EXTENSORS.items():
        assert (getattr(values, f"by_{joint}")[muscles.names.index(name)] > 0).all()
    assert (values.by_knee[muscles.group == MUSCLE_GROUPS.index("hamstrings")] < 0).all()
    assert [name for name, rectus in zip(muscles.names, muscles.rectus, strict=True) if rectus] == ["rect_fem"]


def test_vasti_pull_hardest_where_stimulated_quadriceps_do():
    # isometric, stimulated, paralysed: largest at 130 to 140 deg of knee angle (Schmoll 2021,
    # doi:10.1186/s12984-021-00805-7), of healthy riders at 150 (Angeli, Gfoehler, Karg)
    muscles, angle = anatomy(), np.arange(80.0, 166.0)
    values = muscles.lengths.at(Flexion(np.radians(70.0), np.radians(180 - angle)))
    part = (muscles.optimal[:, None], muscles.slack[:, None], muscles.pennation[:, None], 10.0)
    force, _ = tension(values.value, np.zeros_like(values.value), *part)
    vasti = [name.startswith("vas") for name in muscles.names]
    moment = np.sum((muscles.force[:, None] * force * values.by_knee)[vasti], axis=0)
    assert 115 <= angle[moment.argmax()] <= 150
    assert moment[angle == 120] > 1.5 * moment[angle == 80]


def test_rider_of_the_adults_size_is_not_scaled_and_thighs_alone_stretch_two_joint_muscles_less():
    muscles = anatomy()
    adult = Rider(thigh=muscles.thigh, shank=muscles.shank + boot_height())
    assert muscles.length_scale(adult) == pytest.approx(1.0)
    longer = muscles.length_scale(replace(adult, thigh=1.1 * muscles.thigh))[:, 0, 0]
    vastus, rectus = (longer[muscles.names.index(name)] for name in ("vas_lat", "rect_fem"))
    assert vastus == pytest.approx(1.1)
    assert rectus == pytest.approx((1.1 * muscles.thigh + muscles.shank) / (muscles.thigh + muscles.shank))


def test_angles_outside_the_lengths_are_refused():
    with pytest.raises(InputError, match=r"low: the hip .* 130.0 deg.* 20 to 120"):
        anatomy().require_range("low", Flexion(np.radians([60.0, 130.0]), np.radians([60.0, 100.0])))


def test_arms_that_change_their_sign_are_named():
    assert anatomy().changed_arms(Flexion(np.radians([60.0, 95.0]), np.radians([58.0, 111.0]))) == []
    changed = anatomy().changed_arms(Flexion(np.radians([60.0, 110.0]), np.radians([58.0, 124.0])))
    assert changed == ["glut_max1 at the hip", "bifemlh at the knee"]

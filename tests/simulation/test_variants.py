"""The variants as a set: what each changes, what they refuse, and that a free motion keeps its energy."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import get_args

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.cli.export import _Variant
from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.drive import DRIVE_POINTS, drive
from fes_mj.moments.torque_map import torque_map
from fes_mj.simulation.variants import VARIANTS, variant_model, variant_options
from fes_mj.statics.turn import quasi_static
from studies.energy import ENERGY_LIMIT, GAP_LIMIT, LOOSE, lossless, move_freely

DISCRETE, EULER, FAST, RK4 = (
    getattr(mujoco.mjtIntegrator, f"mjINT_{name}") for name in ("DISCRETE", "EULER", "IMPLICITFAST", "RK4")
)


def model(*variants: str, name: str = "d1") -> mujoco.MjModel:
    design = fes_mj.load_design(name)
    drive = fes_mj.load_muscles() if "muscles" in variants else fes_mj.load_moments()
    return variant_model(design, drive, design.linkage.cadence, variant_options(variants)).compile()


def test_the_names_of_the_command_are_those_of_the_table() -> None:
    assert get_args(_Variant) == tuple(VARIANTS)


@pytest.mark.parametrize(
    ("variants", "motors", "freedoms", "integrator"),
    [
        ((), 3, 5, DISCRETE),
        (("sites",), 3, 5, DISCRETE),
        (("bodies",), 3, 5, DISCRETE),
        (("two-legs",), 5, 9, DISCRETE),
        (("compatible",), 2, 5, EULER),
        (("passive",), 0, 5, RK4),
        (("passive", "compatible"), 0, 5, RK4),
        (("free",), 2, 5, RK4),
        (("free", "compatible", "two-legs"), 4, 9, RK4),
        (("brake",), 2, 5, FAST),
        (("passive", "brake"), 0, 5, FAST),
        (("ride",), 4, 10, FAST),
        (("ride", "fixed-gear", "compatible"), 4, 10, FAST),
        (("passive", "ride"), 0, 10, FAST),
        (("muscles",), 12, 5, DISCRETE),
        (("muscles", "two-legs", "compatible", "bodies"), 22, 9, EULER),
    ],
)
def test_what_drives_and_what_integrates(
    variants: tuple[str, ...], motors: int, freedoms: int, integrator: int
) -> None:
    built = model(*variants)
    assert (built.nu, built.nv, built.opt.integrator) == (motors, freedoms, integrator)
    assert built.actuator_ctrllimited.all()  # an action space of size zero is of no use
    assert (np.diff(built.actuator_ctrlrange) > 0).all()


def test_only_bodies_anchors_at_bodies() -> None:
    kinds = {name: model(name).eq_objtype for name in VARIANTS if name != "fixed-gear"}
    body = mujoco.mjtObj.mjOBJ_BODY
    assert {name for name, objects in kinds.items() if (objects == body).any()} == {"bodies"}
    assert (kinds["bodies"] == body).all()


@pytest.mark.parametrize("group", ["p1p2", "p1p3"])
def test_the_range_of_a_motor_holds_every_moment_of_the_map(group: str) -> None:
    """With room to spare, and not ten times as much."""
    design, moments = fes_mj.load_design("d1"), fes_mj.load_moments(group)
    built = variant_model(design, moments, design.linkage.cadence, {}).compile()
    for joint in JOINTS:
        low, high = built.actuator(joint).ctrlrange
        largest = np.abs(torque_map(moments).table[joint]).max()
        assert low == -high
        assert 1.4 * largest < high < 4 * largest
    assert built.actuator("crank_servo").ctrlrange == pytest.approx([0, 2 * design.linkage.cadence])


def test_moments_of_its_own_give_each_leg_its_range() -> None:
    design, weak = fes_mj.load_design("d1"), fes_mj.load_moments()
    strong = fes_mj.JointMoments("strong", weak.crank_angle, 3 * weak.knee, 3 * weak.hip)
    built = variant_model(design, replace(strong, left=weak), 6.0, variant_options(["free", "two-legs"])).compile()
    assert built.actuator("right_knee").ctrlrange[1] > 2.5 * built.actuator("left_knee").ctrlrange[1]


@pytest.mark.parametrize(
    ("variants", "said"),
    [
        (["sites", "bodies"], "sites and bodies"),
        (["two-legs", "free", "ride"], "free and ride"),
        (["brake", "free"], "brake and free"),
        (["ride", "brake"], "ride and brake"),
        (["muscles", "passive"], "muscles and passive"),
        (["ride", "muscles"], "ride and muscles"),
        (["brake", "muscles"], "brake and muscles"),
        (["free", "muscles"], "free and muscles"),
        (["fixed-gear"], "give it with ride"),
        (["fixed-gear", "brake"], "give it with ride"),
        (["mjx"], "'mjx'"),
    ],
)
def test_what_makes_no_sense_is_refused(variants: list[str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        variant_options(variants)


@pytest.mark.parametrize(("drive", "variants"), [(fes_mj.load_muscles(), ()), (fes_mj.load_moments(), ("muscles",))])
def test_muscles_and_their_variant_belong_together(
    drive: fes_mj.Muscles | fes_mj.JointMoments, variants: tuple[str, ...]
) -> None:
    with pytest.raises(InputError, match=r"variant muscles .*load_muscles"):
        variant_model(fes_mj.load_design("d1"), drive, 6.0, variant_options(variants))


def test_a_brake_needs_power_to_take() -> None:
    weak = fes_mj.load_moments()
    pulling = fes_mj.JointMoments("pulling", weak.crank_angle, -weak.knee, -weak.hip)
    with pytest.raises(InputError, match=r"pulling: .*-.* W at 60 rpm"):
        variant_model(fes_mj.load_design("d1"), pulling, 2 * math.pi, {"crank": "brake"})


@pytest.mark.parametrize("name", ["trt", *(pytest.param(name, marks=pytest.mark.long) for name in ("r2", "d1"))])
def test_the_brake_lets_the_muscles_keep_the_cadence(name: str) -> None:
    """Moments replayed by crank angle: once it is steady, the work per turn of statics goes into the brake.

    Its moment is b w, so that work is 2 pi b times the mean of w over the angle, which is the mean of w^2 per mean of w
    over time. A start at another speed fades within inertia per b, 4 to 8 s.
    """
    design, moments = fes_mj.load_design(name), fes_mj.load_moments()
    built, cadence, commands = (
        model("brake", "two-legs", name=name),
        design.linkage.cadence,
        drive(design, moments),
    )
    data = mujoco.MjData(built)
    mujoco.mj_resetDataKeyframe(built, data, 0)
    crank, speeds, turns = data.joint("crank"), [], 10 if name == "trt" else 30
    drives = [
        (built.actuator(leg + joint).id, commands[joint], lag)
        for leg, lag in (("right_", 0.0), ("left_", math.pi))
        for joint in JOINTS
    ]
    while crank.qpos[0] < 2 * math.pi * turns:
        for actuator, command, lag in drives:
            data.ctrl[actuator] = command[
                round((float(crank.qpos[0]) - lag) / (2 * math.pi) * DRIVE_POINTS) % DRIVE_POINTS
            ]
        mujoco.mj_step(built, data)
        if crank.qpos[0] > 2 * math.pi * (turns - 5):
            speeds.append(float(crank.qvel[0]))
    over_angle = float(np.mean(np.square(speeds)) / np.mean(speeds))
    assert over_angle == pytest.approx(cadence, rel=0.005)
    work = 2 * math.pi * built.dof_damping[built.joint("crank").dofadr[0]] * over_angle
    assert work == pytest.approx(2 * quasi_static(design, moments).work_per_turn, rel=0.005)


def test_free_and_compatible_move_as_passive_does() -> None:
    """Bit for bit: idle motors weigh nothing, and what MuJoCo 3.7 needs is what it gets anyway."""
    ends = []
    for variants in (("passive",), ("free",), ("passive", "compatible"), ("free", "compatible", "sites")):
        built = lossless("d2", variants)
        data = mujoco.MjData(built)
        mujoco.mj_resetDataKeyframe(built, data, 0)
        mujoco.mj_step(built, data, nstep=2000)
        ends.append(data.qpos.tobytes())
    assert len(set(ends)) == 1


QUICK = [("trt", ("passive", "two-legs")), ("r2", ("passive", "ride", "fixed-gear")), ("d1", ("passive", "brake"))]
ALL = [(name, variants) for name in DESIGNS for variants in (*LOOSE, ("passive", "bodies"), ("passive", "compatible"))]


@pytest.mark.parametrize(
    ("name", "variants"),
    [
        pytest.param(*case, marks=() if case in QUICK else pytest.mark.long, id="+".join([case[0], *case[1]]))
        for case in ALL
    ],
)
def test_a_free_motion_keeps_energy_and_loops(name: str, variants: tuple[str, ...]) -> None:
    motion = move_freely(lossless(name, variants))
    assert motion.drift <= ENERGY_LIMIT, motion
    assert motion.gap <= GAP_LIMIT, motion


def test_the_measurement_would_notice_another_integrator() -> None:
    """D2 gains more than its start energy with Euler; two seconds suffice."""
    built = lossless("d2", ("passive", "compatible"))
    built.opt.integrator, built.opt.timestep = EULER, 2.2e-4
    assert not move_freely(built, 2.0).ok

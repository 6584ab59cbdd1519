"""The exported files: the model reloads bit for bit, variants, scene, table."""

from __future__ import annotations

import csv
import itertools
import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from fes_mj import load_design, load_moments
from fes_mj.common.checks import definitions
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.turning import FROM_TOP
from fes_mj.moments.torque_map import torque_map
from fes_mj.simulation.bench import joint_drives, simulate
from fes_mj.simulation.export import mjcf_text, scene_text, sidecar_text
from fes_mj.simulation.mjcf import ModelOptions, build_mjcf
from fes_mj.simulation.stepping import PRE_ROLL, Sensors, drive_addresses
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.simulation.variants import variant_model, variant_options
from fes_mj.statics.turn import quasi_static

COMBINATIONS = [
    combination
    for count in range(4)
    for combination in itertools.combinations(["bodies", "passive", "two-legs", "compatible"], count)
] + [
    (*crank, *others)
    for crank in [("free",), ("brake",), ("ride",), ("ride", "fixed-gear")]
    for others in [(), ("bodies", "passive"), ("two-legs", "compatible"), ("bodies", "passive", "compatible")]
]


def compiled_bytes(model: mujoco.MjModel) -> NDArray[np.uint8]:
    """The whole compiled model, as MuJoCo would write it to a binary file."""
    buffer = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return buffer


@pytest.mark.parametrize("cadence", [None, pytest.param(2 * math.pi, marks=pytest.mark.long)])
@pytest.mark.parametrize(
    "name", ["trt", "r1", "d1", *(pytest.param(name, marks=pytest.mark.long) for name in ("r2", "d2"))]
)
@pytest.mark.parametrize("variants", COMBINATIONS, ids="+".join)
def test_reloads_bit_for_bit(name: str, variants: tuple[str, ...], cadence: float | None) -> None:
    design, moments, options = load_design(name), load_moments(), variant_options(variants)
    spec = variant_model(design, moments, cadence or design.linkage.cadence, options)
    written = spec.compile()
    assert np.array_equal(compiled_bytes(written), compiled_bytes(mujoco.MjModel.from_xml_string(mjcf_text(spec))))


@pytest.mark.parametrize("others", [(), ("bodies",), ("compatible",)], ids="+".join)
@pytest.mark.parametrize("name", DESIGNS)
def test_the_ride_rolls_out_in_a_plain_loop(name: str, others: tuple[str, ...]) -> None:
    """A thousand steps of mj_step on the file alone: finite, forwards, and its loops hold."""
    design = load_design(name)
    spec = variant_model(design, load_moments(), design.linkage.cadence, variant_options(["ride", *others]))
    model = mujoco.MjModel.from_xml_string(mjcf_text(spec))
    assert np.array_equal(compiled_bytes(spec.compile()), compiled_bytes(model))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    gaps = [model.sensor(i).name for i in range(model.nsensor) if model.sensor(i).name.endswith("_gap")]
    assert len(gaps) == 2 * (1 if design.linkage.kind == "trt" else 2)
    largest = 0.0
    for _ in range(1000):
        mujoco.mj_step(model, data)
        largest = max(largest, *(float(np.linalg.norm(data.sensor(gap).data)) for gap in gaps))
    assert np.isfinite(data.qpos).all()
    assert 0.1 < data.joint("road").qpos[0] < 0.5  # a fifth of a second from 1.6 m/s, against gravity's swing
    assert largest < 1e-4


@pytest.mark.parametrize("name", DESIGNS)
def test_the_compatible_variant_gives_the_power_of_statics(name: str) -> None:
    """Euler and a flywheel in the place of `discrete` and a servo: same limits as the cross-check."""
    design, moments = load_design(name), load_moments()
    model = build_mjcf(design, options=ModelOptions(compatible=True)).compile()
    data, recorded = mujoco.MjData(model), []
    mujoco.mj_resetDataKeyframe(model, data, 0)
    drives = [(*drive_addresses(model, joint), torque_map(moments).feedback(joint)) for joint in JOINTS]
    for _ in range(PRE_ROLL + steps_per_turn(design, design.linkage.cadence)):  # as another tool would step
        for motor, position, speed, moment in drives:
            data.ctrl[motor] = moment(float(data.qpos[position]), float(data.qvel[speed]))
        mujoco.mj_step(model, data)
        recorded.append(data.sensordata.copy())
    rows = Sensors(model, np.array(recorded[PRE_ROLL:]))
    crank_speed = rows["crank_speed"]
    power = rows.crank_moment() * crank_speed
    assert power.mean() == pytest.approx(
        quasi_static(design, moments).power_mean, rel=definitions()["mean_power"].limit
    )
    assert np.abs(crank_speed / design.linkage.cadence - 1).max() < definitions()["cadence_ripple"].limit
    gaps = [rows.vector(f"{model.equality(i).name}_gap") for i in range(model.neq)]
    assert np.linalg.norm(gaps, axis=2).max() < definitions()["loop_gap"].limit


# What a comment says -> a combination it belongs to, and one it does not.
COMMENTS = {
    "bears the stiff servo": ((), ("free",)),
    "Runge-Kutta": (("free",), ("compatible",)),
    "one evaluation": (("brake",), ("free",)),
    "holds the cadence where": (("compatible",), ("brake", "compatible")),
    "the brake takes": (("brake",), ("ride",)),
    "Metres ridden": (("ride",), ("two-legs",)),
    "Road less crank": (("ride",), ("ride", "fixed-gear")),
    "Holds the cadence (rad/s)": ((), ("compatible",)),
    "Net joint moments": (("free",), ("passive",)),
}


@pytest.mark.parametrize("said", COMMENTS)
def test_a_comment_stands_where_it_belongs(said: str) -> None:
    design, moments = load_design("d1"), load_moments()
    texts = [
        mjcf_text(variant_model(design, moments, design.linkage.cadence, variant_options(variants)))
        for variants in COMMENTS[said]
    ]
    assert [text.count(said) for text in texts] == [1, 0]


@pytest.mark.parametrize("name", DESIGNS)
def test_every_comment_stands_in_the_file_and_no_number_is_shortened(name: str) -> None:
    text = mjcf_text(build_mjcf(load_design(name)))
    assert text.count("<!--") == 12  # the heading and what a model with a servo has
    compatible = build_mjcf(load_design(name), options=ModelOptions(compatible=True))
    assert mjcf_text(compatible).count("<!--") == 11  # no discrete, no servo
    assert f'timestep="{float(build_mjcf(load_design(name)).option.timestep)!r}"' in text


@pytest.mark.parametrize("name", DESIGNS)
def test_the_scene_shows_the_whole_turn_above_its_floor(name: str, tmp_path: Path) -> None:
    design = load_design(name)
    (tmp_path / "model.xml").write_text(mjcf_text(build_mjcf(design)))
    (tmp_path / "scene.xml").write_text(scene_text(design, "model.xml"))
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert {model.camera(i).name for i in range(model.ncam)} == {"side", "oblique"}
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    joints = [model.joint(i).name for i in range(model.njnt)]
    steps = steps_per_turn(design, design.linkage.cadence)
    lowest, shown = math.inf, True
    for step in range(steps):
        mujoco.mj_step(model, data)
        if step % 40 == 0:
            corners = data.geom("boot").xpos + data.geom("boot").xmat.reshape(3, 3)[:, 2] * [[-0.09], [0.09]]
            lowest = min(lowest, corners[:, 2].min())
            points = [*corners, *(data.joint(joint).xanchor for joint in joints)]
            shown &= all(_in_picture(model, data, camera, np.array(points)) for camera in ("side", "oblique"))
    assert data.joint("crank").qpos[0] == pytest.approx(2 * np.pi, rel=1e-3)
    assert shown
    assert lowest - 0.05 > model.geom("floor").pos[2]


def _in_picture(model: mujoco.MjModel, data: mujoco.MjData, camera: str, points: NDArray[np.float64]) -> bool:
    """Whether all points lie in a picture of 4:3."""
    view, half = data.camera(camera), math.tan(math.radians(model.camera(camera).fovy[0]) / 2)
    seen = (points - view.xpos) @ view.xmat.reshape(3, 3)  # right, up, backwards
    x, y = seen[:, 0] / -seen[:, 2], seen[:, 1] / -seen[:, 2]
    return bool((np.abs(y) < half).all() and (np.abs(x) < half * 4 / 3).all() and (seen[:, 2] < 0).all())


@pytest.mark.parametrize("legs", [1, 2])
def test_the_table_holds_what_the_simulation_measures(legs: int) -> None:
    """Sidecar against the run of the same model, an independent way to the same numbers."""
    design, moments = load_design("r2"), load_moments()
    rows = [*csv.reader(sidecar_text(design, moments, legs=legs).splitlines())]
    table = dict(zip(rows[0], np.array(rows[1:], float).T, strict=True))
    measured = simulate(design, moments, legs=legs)
    assert set(table) == {"crank_angle_deg", FROM_TOP, "crank_Nm", "quasi_static_crank_Nm"} | {
        f"{joint}_{unit}" for joint in joint_drives(measured.legs) for unit in ("deg", "Nm")
    }
    turn = np.degrees(measured.crank_angle)

    def at(column: str) -> NDArray[np.float64]:
        return np.interp(turn, table["crank_angle_deg"], table[column], period=360)

    for joint in joint_drives(measured.legs):
        assert at(f"{joint}_deg") == pytest.approx(np.degrees(measured.joint_angle[joint]), abs=0.01)
    assert np.sqrt(np.mean((at("crank_Nm") - measured.crank_moment) ** 2)) < 0.05
    assert table["crank_Nm"].mean() == pytest.approx(table["quasi_static_crank_Nm"].mean(), rel=1e-3)
    power = legs * quasi_static(design, moments).power_mean
    assert table["quasi_static_crank_Nm"].mean() * measured.cadence == pytest.approx(power, rel=1e-3)

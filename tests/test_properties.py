"""What must hold for any linkage that turns round and any periodic moments, not only for the catalogue."""

import math
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from fes_mj import load_design, load_moments, quasi_static
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design, Linkage
from fes_mj.linkage.design_file import design_toml
from fes_mj.linkage.inertia import body_loads
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.joint_moments import COLUMNS, JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.statics.equilibrium import crank_moment, equilibrium, virtual_work
from fes_mj.verification.geometry import closure_error, wrong_branch
from fes_mj.verification.references import differences, exact_curves
from tests.linkages import between, designs, periodic_moments

ANGLES = np.linspace(0, 2 * np.pi, 90, endpoint=False)


@given(designs())
def test_random_linkages_close_on_the_right_branch(design: Design) -> None:
    motion = kinematics.solve(design, ANGLES)
    assert closure_error(motion) < 1e-13
    assert wrong_branch(motion) == 0


@given(designs(), periodic_moments())
def test_statics_are_virtual_work(design: Design, moments: JointMoments) -> None:
    motion = kinematics.solve(design, ANGLES)
    joint_moment = torque_map(moments).along(motion, 8.0)
    for loads in (None, body_loads(motion, 8.0)):
        work = virtual_work(motion, joint_moment, loads)
        assert equilibrium(motion, joint_moment, loads)[0] == pytest.approx(work, rel=1e-9, abs=1e-9)


@given(designs(), periodic_moments(), between(2, 12))
@settings(max_examples=20)
def test_mujoco_agrees_on_masses_frames_and_gravity(design: Design, moments: JointMoments, cadence: float) -> None:
    curves = exact_curves(Case(design, moments, cadence), ANGLES)["massive"]
    scale = np.abs(curves["inverse dynamics"]).max()
    assert max(differences(curves).values()) < 1e-10 * max(1.0, scale)


@given(designs(), periodic_moments(), between(0.5, 2))
def test_the_size_of_the_whole_does_not_change_the_crank_moment(
    design: Design, moments: JointMoments, factor: float
) -> None:
    linkage, rider = design.linkage, design.rider
    lengths = ("ground", "crank", "foot", "pivot_to_crank", "pedal_arm", "coupler", "rocker")
    larger = design.with_linkage(**{name: factor * getattr(linkage, name) for name in lengths})
    larger = larger.with_rider(thigh=factor * rider.thigh, shank=factor * rider.shank)
    assert _moment(larger, moments) == pytest.approx(_moment(design, moments), rel=1e-8, abs=1e-8)


@given(designs(), periodic_moments(), between(-1, 1))
def test_turning_the_tricycle_changes_nothing(design: Design, moments: JointMoments, angle: float) -> None:
    linkage, turn = design.linkage, complex(math.cos(angle), math.sin(angle))
    turned = design.with_linkage(
        ground=turn * linkage.ground,
        pivot_to_crank=turn * linkage.pivot_to_crank,
        seat_angle=linkage.seat_angle + angle,
    )
    assert _moment(turned, moments, ANGLES + angle) == pytest.approx(_moment(design, moments), rel=1e-8, abs=1e-8)


@given(designs())
def test_the_mirror_image_closes_on_the_other_branch(design: Design) -> None:
    """A dyad seen in the mirror is the dyad closed from its other end."""
    points = kinematics.positions(design, ANGLES)
    mirrored = kinematics.close_dyad(
        np.conj(points["hip"]) + 0 * points["pedal"], np.conj(points["pedal"]), design.rider.thigh, design.knee_to_pedal
    )
    assert mirrored == pytest.approx(np.conj(points["knee"]), abs=1e-12)


@given(designs(("crt", "cdt")))
def test_the_mirror_image_of_a_rocker_has_the_other_branch(design: Design) -> None:
    linkage = design.linkage
    mirrored = replace(
        linkage,
        ground=linkage.ground.conjugate(),
        pivot_to_crank=linkage.pivot_to_crank.conjugate(),
        coupler_angle=-linkage.coupler_angle,
        branch="left" if linkage.branch == "right" else "right",
    )
    points = kinematics.positions(replace(design, linkage=mirrored), -ANGLES)
    original = kinematics.positions(design, ANGLES)
    for name in ("rocker_joint", "pedal"):
        assert points[name] == pytest.approx(np.conj(original[name]), abs=1e-12)


@given(designs(), periodic_moments(), between(1, 12))
def test_masses_do_not_feel_which_way_the_crank_turns(design: Design, moments: JointMoments, cadence: float) -> None:
    forwards, backwards = (
        crank_moment(kinematics.solve(design, ANGLES), torque_map(moments), speed) for speed in (cadence, -cadence)
    )
    assert forwards == pytest.approx(backwards, rel=1e-12)


@given(designs(), periodic_moments(), periodic_moments(), between(-3, 3))
def test_the_crank_moment_is_linear_in_the_joint_moments(
    design: Design, one: JointMoments, other: JointMoments, factor: float
) -> None:
    both = replace(one, knee=one.knee + factor * other.knee, hip=one.hip + factor * other.hip)
    expected = _moment(design, one) + factor * _moment(design, other)
    assert _moment(design, both) == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(designs(), periodic_moments(), between(0.1, 1))
def test_power_is_linear_in_the_gear_ratio(design: Design, moments: JointMoments, factor: float) -> None:
    linkage = design.linkage
    faster = design.with_linkage(gear_ratio=factor * linkage.gear_ratio)
    slow, fast = (quasi_static(geared, moments, points=90) for geared in (design, faster))
    assert fast.power_mean == pytest.approx(factor * slow.power_mean, rel=1e-12)
    assert fast.work_per_turn == pytest.approx(slow.work_per_turn, rel=1e-12)


@given(st.lists(designs(("cdt",)), min_size=2, max_size=4))
@settings(max_examples=20)
def test_a_batch_is_its_designs(singles: list[Design]) -> None:
    """One call on a batch gives what one call a design gives."""
    fields = [name for name in Linkage.__dataclass_fields__ if name not in ("kind", "branch")]
    singles = [design for design in singles if design.linkage.branch == singles[0].linkage.branch]
    column = {name: np.array([getattr(design.linkage, name) for design in singles])[:, None] for name in fields}
    legs = {name: np.array([getattr(design.rider, name) for design in singles])[:, None] for name in ("thigh", "shank")}
    batch = replace(
        singles[0],
        linkage=Linkage("cdt", **column, branch=singles[0].linkage.branch),
        rider=replace(singles[0].rider, **legs),
    )
    together = kinematics.solve(batch, ANGLES)
    for row, design in enumerate(singles):
        alone = kinematics.solve(design, ANGLES)
        assert together.joint_angle.knee[row] == pytest.approx(alone.joint_angle.knee, abs=1e-13)
        assert together.joint_rate.hip[row] == pytest.approx(alone.joint_rate.hip, abs=1e-11)


@given(designs())
@settings(max_examples=30)
def test_a_design_file_reads_back_to_the_last_bit(tmp_path_factory: pytest.TempPathFactory, design: Design) -> None:
    path = tmp_path_factory.mktemp("design") / "random.toml"
    # gamma is written for a CDT only: nothing else has it
    kept = design.linkage.coupler_angle if design.linkage.kind == "cdt" else Linkage.coupler_angle
    design = design.with_linkage(coupler_angle=kept)
    path.write_text(design_toml(design, "a random linkage"))
    again = load_design(path)
    assert design_toml(again) == design_toml(design)
    assert again.rider == design.rider
    angles = {"seat_angle": design.linkage.seat_angle, "coupler_angle": design.linkage.coupler_angle}
    assert replace(again.linkage, **angles) == design.linkage
    for name, angle in angles.items():
        assert abs(getattr(again.linkage, name) - angle) <= math.ulp(angle)


@given(periodic_moments(), st.randoms(use_true_random=False))
@settings(max_examples=20)
def test_a_moments_file_reads_back(
    tmp_path_factory: pytest.TempPathFactory, moments: JointMoments, random: Random
) -> None:
    path = tmp_path_factory.mktemp("moments") / "random.csv"
    rows = [f"{float(np.degrees(a))!r},{float(k)!r},{float(h)!r}" for a, k, h in _rows(moments)]
    random.shuffle(rows)
    path.write_text("\n".join([",".join(COLUMNS), *rows]) + "\n")
    curves, again = (samples.at(np.linspace(0, 2 * np.pi, 100)) for samples in (moments, load_moments(path)))
    scale = max(np.abs(moment).max() for moment in curves)
    for joint in JOINTS:
        assert again[joint] == pytest.approx(curves[joint], abs=1e-9 * scale)


@given(designs(), periodic_moments())
@settings(max_examples=20)
def test_dynamics_agree_with_statics(design: Design, moments: JointMoments) -> None:
    """At an unhurried 60 rpm: random linkages have parts that are faster than any designer would allow."""
    result = Case(design, moments, cadence=2 * math.pi)
    values = {check.name: check for check in result.checks}
    gross = np.abs(result.static.power).mean()  # the net power of random moments may be next to nothing
    assert abs(result.simulation.power_mean - result.static.power_mean) < 1e-3 * gross
    assert values["loop_gap"].ok
    assert values["cadence_ripple"].ok


def _moment(design: Design, moments: JointMoments, angles: np.ndarray = ANGLES) -> np.ndarray:
    """Quasi-static crank moment, N m."""
    motion = kinematics.solve(design, angles)
    return equilibrium(motion, torque_map(moments).along(motion, design.linkage.cadence))[0]


def _rows(moments: JointMoments) -> list[tuple[float, float, float]]:
    return list(zip(moments.crank_angle, moments.knee, moments.hip, strict=True))

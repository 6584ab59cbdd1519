"""Closing, joint ranges and transmission, against other ways to the same numbers."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from fes_mj.common.errors import AssemblyError
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import (
    DYADS,
    LEAST_CLEARANCE,
    clearances,
    degrees_from_top,
    grashof_margin,
    joint_ranges,
    require_assembly,
    top_dead_centre,
    transmission_angles,
)
from fes_mj.linkage.design import Design, Linkage, Rider
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import FULL_TURN, joint_angles, positions
from fes_mj.moments.files import load_moments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics.cycles import WorkTable, cycles
from tests.linkages import designs


def test_what_cannot_close_is_named_with_its_crank_angle() -> None:
    """R2 of the printed CRT R2: longest reach 0.53 m, needed 0.5301 m when the crank points away from the pivot."""
    printed = Design("r2", Linkage("crt", -0.62 + 0.32j, 0.04, 0.08, -0.49 + 0.01j, 0.15, 0.44, 0.09))
    with pytest.raises(
        AssemblyError, match=r"r2: rocker and coupler cannot close at crank angle 178.8 deg.*0\.5301 m.*0\.102 mm lack"
    ):
        require_assembly(printed)
    far = Design("far", Linkage("trt", -1.0 - 0.4j, 0.15, 0.069))
    with pytest.raises(AssemblyError, match=r"far: thigh and shank cannot close at crank angle 20[12]\.\d deg"):
        require_assembly(far)


def test_transmission_angle_of_the_trt() -> None:
    """By the law of cosines at the two ends."""
    motion = kinematics.solve(PAPER_TRICYCLE.design)
    frame, crank = abs(PAPER_TRICYCLE.design.linkage.crank_centre), PAPER_TRICYCLE.design.linkage.crank
    thigh, shank = PAPER_TRICYCLE.design.rider.thigh, float(PAPER_TRICYCLE.design.knee_to_pedal)

    def at_knee(span: float) -> float:
        angle = math.degrees(math.acos((thigh**2 + shank**2 - span**2) / (2 * thigh * shank)))
        return min(angle, 180 - angle)

    assert transmission_angles(motion)["knee"] == pytest.approx(
        min(at_knee(frame - crank), at_knee(frame + crank)), abs=0.01
    )


def test_joint_ranges_are_those_of_the_closed_form() -> None:
    """An extreme is missed by half a step at most, over which the angle turns round with its largest curvature."""
    design, half_step = PAPER_TRICYCLE.design, np.pi / len(FULL_TURN)
    curvature = max(np.abs(rotation[1]).max() for rotation in kinematics.solve(design).joint_rotation)
    exact = np.degrees([*PAPER_TRICYCLE.ranges.knee, *PAPER_TRICYCLE.ranges.hip])
    assert joint_ranges(design) == pytest.approx(exact, rel=0, abs=np.degrees(curvature * half_step**2 / 2))


def test_grashofs_inequality_tells_which_cranks_turn() -> None:
    """They do where rocker and coupler reach both positions of the crank in line with the frame."""
    random = np.random.default_rng(0)
    frame, coupler, rocker = random.uniform(0.2, 0.6, (3, 1000, 1))
    crank = random.uniform(0.01, 0.2, (1000, 1))
    linkage = Linkage("cdt", 0j, crank, 0.0, pivot_to_crank=frame * 1j, coupler=coupler, rocker=rocker)
    turns = (np.abs(rocker - coupler) < frame - crank) & (frame + crank < rocker + coupler)
    assert 0 < turns.sum() < 1000
    assert np.array_equal(grashof_margin(Design("batch", linkage)) > 0, turns.ravel())


@given(designs())
def test_clearances_are_those_of_a_fine_search(design: Design) -> None:
    points = kinematics.positions(design, np.linspace(0, 2 * np.pi, 200_001))
    for links, margin, span, angle in clearances(design):
        start, end, _ = DYADS[links]
        spans = np.abs(points[end] - points[start])
        one, other = (float(design.link_lengths[link]) for link in links)
        searched = min(one + other - spans.max(), spans.min() - abs(one - other))
        assert margin[0] == pytest.approx(searched, abs=1e-8 if searched < 0.02 else 1e-3)
        there = kinematics.positions(design, angle)
        assert span[0] == pytest.approx(np.abs(there[end] - there[start]).item(), abs=1e-12)


@pytest.mark.parametrize("short", [5e-7, 1e-5, 0.9e-4])
@pytest.mark.parametrize("kind", ["stretched", "folded"])
def test_what_is_too_close_to_a_dead_centre_is_refused_by_name(kind: str, short: float) -> None:
    """Rocker and coupler of D1, shortened until they lack so much, or have no more than that to spare."""
    d1 = load_design("d1")
    pivot, crank = abs(d1.linkage.pivot_to_crank), d1.linkage.crank
    for margin, said in ((-short, "mm lack"), (short, "motion is not determined; 0.1 mm are needed")):
        if kind == "stretched":
            changed = replace(d1.linkage, coupler=pivot + crank - d1.linkage.rocker + margin)
        else:
            changed = replace(d1.linkage, coupler=pivot - crank + d1.linkage.rocker - margin)
        design = replace(d1, linkage=changed)
        assert clearances(design)[0].margin[0] == pytest.approx(margin, abs=1e-12)
        with pytest.raises(AssemblyError, match=rf"d1: rocker and coupler .* deg: .*{said}"):
            require_assembly(design)


def test_a_thigh_that_turns_right_round_is_refused() -> None:
    round_the_hip = Design("around", Linkage("trt", 0.05 + 0j, 0.3, 0.0), Rider(0.3, 0.3))
    with pytest.raises(AssemblyError, match=r"around: the thigh swings through 3[0-9][0-9] deg"):
        require_assembly(round_the_hip)


def test_a_batch_turns_where_its_designs_do() -> None:
    """Legs around the shortest and longest that reach the pedal of R1 and D2, those within micrometres included."""
    random, table = np.random.default_rng(3), WorkTable.of(load_moments())
    for name in ("trt", "r1", "d2"):
        design = load_design(name)
        reach = clearances(design)[-1].margin[0]
        shorter = reach - np.concatenate([random.uniform(-0.01, 0.01, 40), LEAST_CLEARANCE + 1e-6 * np.arange(-3, 4)])
        batch = replace(design, rider=replace(design.rider, thigh=design.rider.thigh - shorter[:, None]))
        turns = [
            _turns(replace(design, rider=replace(design.rider, thigh=float(thigh))))
            for thigh in batch.rider.thigh[:, 0]
        ]
        assert cycles(batch, table).turns.tolist() == turns
        assert 10 < sum(turns) < 40


def _turns(design: Design) -> bool:
    try:
        require_assembly(design)
    except AssemblyError:
        return False
    return True


def test_top_dead_centre_is_where_the_leg_is_bent_most() -> None:
    """In closed form for the four-bar, by a fine search for the others."""
    trt = load_design("trt")
    assert top_dead_centre(trt) == pytest.approx(np.angle(-trt.linkage.crank_centre) % (2 * np.pi))
    turn = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    for name in ("r1", "r2", "d1", "d2"):
        design = load_design(name)
        top = top_dead_centre(design)
        knee, least = (joint_angles(design, positions(design, at)).knee for at in (turn, np.array([top])))
        assert abs(top - turn[knee.argmin()]) < 1e-3  # R2's minimum is flat
        assert least[0] <= knee.min() + 1e-12
        after = degrees_from_top(design, np.array([top_dead_centre(design) + 1e-9, 0.0]))
        assert after == pytest.approx([0, -np.degrees(top_dead_centre(design)) % 360], abs=1e-6)

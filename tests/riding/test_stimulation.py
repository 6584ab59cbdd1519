"""The windows against exact geometry and finite differences of the joint angles, and what is written of them."""

from __future__ import annotations

import csv
import io
import math

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.assembly import joint_ranges
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.turning import turning
from fes_mj.riding.stimulation import CORE, LEAST_SWING, MUSCLES, Window, stimulation, table_csv, windows_summary


def of(windows: list[Window], muscle: str, leg: str = "right") -> list[Window]:
    return [window for window in windows if (window.muscle, window.leg) == (muscle, leg)]


def test_the_knee_of_a_four_bar_extends_from_its_nearest_to_its_farthest_pedal() -> None:
    """Exact: the crank is then in line with the hip, so half a turn apart."""
    trt = fes_mj.load_design("trt")
    (quadriceps,), (hamstrings,) = (of(stimulation(trt), muscle) for muscle in ("quadriceps", "hamstrings"))
    inwards = float(np.angle(-trt.linkage.crank_centre)) % (2 * math.pi)
    assert quadriceps.works == pytest.approx((inwards, inwards + math.pi), abs=1e-6)
    assert quadriceps.works[0] == pytest.approx(turning(trt).top_dead_centre, abs=1e-6)
    assert hamstrings.works[0] == pytest.approx(quadriceps.works[1], abs=1e-6)
    assert hamstrings.width == pytest.approx(math.pi, abs=1e-6)


@pytest.mark.parametrize(("leg", "lag"), [("right", 0.0), ("left", math.pi)])
def test_a_moment_drives_the_crank_inside_and_brakes_it_outside(design: fes_mj.Design, leg: str, lag: float) -> None:
    """Work of a unit moment between angles 0.36 deg apart: positive inside, and outside no more than is left out."""
    ends = np.linspace(0, 2 * np.pi, 1001) - lag
    middles, joints = (ends[1:] + ends[:-1]) / 2 + lag, solve(design, ends).joint_angle
    windows = stimulation(design)
    for name, muscle in MUSCLES.items():
        work = muscle.sense * np.diff(joints[muscle.joint])
        inside, near = np.zeros((2, len(middles)), bool)
        for window in of(windows, name, leg):
            inside |= (middles - window.works[0]) % (2 * np.pi) < window.width
            for end in window.works:
                near |= np.abs((middles - end + np.pi) % (2 * np.pi) - np.pi) < 0.01
        assert (work[inside & ~near] > 0).all()
        left_out = work[~inside & ~near]
        assert left_out[left_out > 0].sum() < LEAST_SWING * work[work > 0].sum()
        assert (left_out < 0).mean() > 0.8


def test_swing_and_core(design: fes_mj.Design) -> None:
    windows, ranges = stimulation(design), np.radians(joint_ranges(design))
    # what extends comes back, but for what is left out
    extended, flexed = (sum(window.swing for window in of(windows, muscle)) for muscle in ("quadriceps", "hamstrings"))
    assert extended == pytest.approx(flexed, rel=LEAST_SWING)
    assert max(window.swing for window in of(windows, "quadriceps")) <= ranges[1] - ranges[0] + 1e-5
    assert max(window.swing for window in of(windows, "gluteus")) == pytest.approx(ranges[3] - ranges[2], rel=1e-3)
    for window in windows:
        assert window.works[0] < window.core[0] < window.core[1] < window.works[1]
        joint, behind = MUSCLES[window.muscle].joint, math.pi if window.leg == "left" else 0.0
        ends, all_along = (
            np.abs(solve(design, angles - behind).joint_rate[joint])
            for angles in (np.array(window.core), np.linspace(*window.works, 5000))
        )
        assert ends == pytest.approx(CORE * all_along.max(), rel=0.02)


def test_the_left_leg_follows_half_a_turn_later(design: fes_mj.Design) -> None:
    windows = stimulation(design)
    for muscle in MUSCLES:
        right, left = (of(windows, muscle, leg) for leg in ("right", "left"))
        starts = [sorted(window.works[0] % (2 * np.pi) for window in legs) for legs in (right, left)]
        assert starts[1] == pytest.approx(sorted((start + math.pi) % (2 * math.pi) for start in starts[0]))
        assert all(0 <= window.works[0] < 2 * np.pi for window in (*right, *left))


def test_hamstrings_help_at_the_hip_where_it_extends() -> None:
    """In the TRT the two joints' windows are all there is to overlap."""
    trt = fes_mj.load_design("trt")
    windows = stimulation(trt)
    (hamstrings,), (gluteus,) = of(windows, "hamstrings"), of(windows, "gluteus")
    overlap = gluteus.works[1] - hamstrings.works[0]
    assert hamstrings.both_joints == pytest.approx(overlap, abs=2e-3)
    assert gluteus.both_joints is None


def test_table_and_json_say_the_same() -> None:
    d1 = fes_mj.load_design("d1")
    windows = stimulation(d1)
    records, rows = windows_summary(d1, windows)["windows"], [*csv.DictReader(io.StringIO(table_csv(d1, windows)))]
    assert len(rows) == len(records) == 8  # the hip of D1 extends twice a turn
    for record, row in zip(records, rows, strict=True):
        for name in ("works", "works_from_tdc", "core"):
            pair = float(row[f"{name}_on_deg"]), float(row[f"{name}_off_deg"])
            assert pair == pytest.approx(record[f"{name}_deg"], abs=0.0051)
        assert (row["muscle"], row["leg"]) == (record["muscle"], record["leg"])

"""Predictions beside published measurements: each by an independent way, and the rule of the verdicts."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.turning import turning
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.validation import cranking, machines, roads
from fes_mj.validation.by_angle import torque_ratio_by_angle
from fes_mj.validation.published import AGREES, CANNOT_TELL, CONTRADICTS, interval_verdict, prediction, rows

RESULTS = Path(__file__).parents[2] / "results"
KEYS = {"name", "kind", "question", "quantity", "unit", "drive", "timing", "predicted_by", "riders", "said", "assumed"}


@pytest.fixture(scope="module")
def riders():
    return Riders("p1p2", prior_draws(6, np.random.default_rng(8)), np.zeros(6))


@pytest.mark.parametrize(
    ("predicted", "measured", "said"),
    [
        ((2.0, 3.0, 4.0), (1.0, math.inf), AGREES),
        ((0.5, 3.0, 4.0), (1.0, math.inf), CANNOT_TELL),
        ((1.0, 1.0, 1.0), (1.0, math.inf), CONTRADICTS),
        ((-2.0, -1.0, -0.5), (-math.inf, 0.0), AGREES),
        ((2.0, 3.0, 4.0), (2.5, 3.5), AGREES),
        ((2.0, 3.0, 4.0), (4.5, 5.0), CONTRADICTS),
        ((0.0, 3.0, 9.0), (2.5, 3.5), CANNOT_TELL),
        ((3.0, 4.0, 5.0), (1.0, 3.5), CANNOT_TELL),
    ],
)
def test_verdict(predicted, measured, said):
    assert interval_verdict(predicted, measured) == said


@pytest.mark.parametrize("row", rows(), ids=lambda row: row.name)
def test_a_row_says_all_that_a_reader_needs(row):
    measured = {"measured"} if "measured" in row.content else {"above"} & set(row.content) or {"below"}
    assert KEYS | {"source"} | measured <= set(row.content) <= KEYS | {"source", "setup", "unless"} | measured
    assert row.content["kind"] in ("measurement", "model")
    assert row.measured[0] < row.measured[1]
    assert callable(prediction(row.content["predicted_by"]))


def test_names_are_each_rows_own_and_there_are_enough_measurements():
    assert len({row.name for row in rows()}) == len(rows())
    assert sum(row.content["kind"] == "measurement" for row in rows()) >= 12


def test_isometric_torque_is_that_of_a_crank_that_hardly_turns(riders):
    """Knee moment at rest, beside the slow limit of the moment along a turn."""
    from fes_mj.muscles.pull import pull

    motion = kinematics.solve(cranking.TRICYCLE, TURN_ANGLES[::30])
    knee, hip = (180 - np.degrees(angle) for angle in motion.joint_angle)
    slow = pull(riders, motion, 1e-9).moment.knee[0, :, 0]
    assert cranking.isometric(riders, hip, knee) == pytest.approx(slow, rel=1e-6, abs=1e-6)


def test_moments_that_belong_to_angles_give_the_same_torque_at_any_cadence(riders):
    ratio = torque_ratio_by_angle(riders, {"cadence_rpm": [10, 50]})
    assert ratio == pytest.approx(np.ones_like(ratio), rel=1e-12)


def test_torque_ratio_is_that_of_powers(riders):
    setup = {"cadence_rpm": [20, 50], "windows_rpm": 50, "groups": ["quadriceps"]}
    torque = cranking.mean_torque_ratio(riders, setup)
    assert cranking.power_ratio(riders, setup) == pytest.approx(torque * 0.4)
    same = cranking.later_peak(riders, setup | {"cadence_rpm": [50, 50]})
    assert np.all(same == 0)


@pytest.mark.parametrize(("crank", "flatness"), [(0.15, 0.3), (0.24, 0.5)])
def test_the_stepper_moves_the_pedal_on_an_ellipse(crank, flatness):
    design = machines.stepper(crank, flatness, 30)
    turning(design)
    motion = kinematics.solve(design, TURN_ANGLES)
    path = motion.points["pedal"].value * np.conj(cranking.TRICYCLE.linkage.crank_centre)
    path = (path - (path.real.max() + path.real.min()) / 2) / abs(cranking.TRICYCLE.linkage.crank_centre)
    assert np.ptp(path.real) / 2 == pytest.approx(crank, rel=2e-3)
    assert np.ptp(path.imag) / 2 == pytest.approx(flatness * crank, rel=2e-2)
    assert 180 - np.degrees(motion.joint_angle.knee.max()) == pytest.approx(30, abs=0.01)


def test_at_the_speed_muscles_give_what_the_road_takes(riders):
    from fes_mj import Ride, load_moments
    from fes_mj.muscles.power import best_turn

    speeds = roads.speed(riders, {"minutes": 0}) / 3.6
    ride = Ride(cranking.TRICYCLE, load_moments())
    for number, speed in enumerate(speeds):
        power = 2 * best_turn(riders, cranking.TRICYCLE, speed / ride.travel)[0].power_mean[number, 0]
        assert power == pytest.approx((ride.load.rolling + ride.load.drag * speed**2) * speed, rel=0.05)


def test_shares_of_all_workers_are_the_whole(riders):
    setup = {"cadence_rpm": [60], "leg_m": 0.515, "windows_of": "p1p2"}
    shares = [machines._shares(riders, setup, joint, sign) for joint in ("knee", "hip") for sign in (1, -1)]
    assert sum(shares) == pytest.approx(np.full(len(riders), 100.0))
    assert np.all(machines.eccentric(riders, setup) <= 0)


def test_the_page_holds_what_is_predicted_today():
    """Cheap rows made again; the study writes them all."""
    written = {record["name"]: record for record in json.loads((RESULTS / "published.json").read_text())["rows"]}
    assert [*written] == [row.name for row in rows()]
    for row in rows():
        if row.content["predicted_by"] in ("knee_of_largest_torque", "lost_force", "hip_extensors", "eccentric"):
            assert row.predicted == pytest.approx(written[row.name]["predicted"])
            assert row.record()["verdict"] == written[row.name]["verdict"]


def test_what_contradicts_says_what_would_have_to_be_true():
    for record in json.loads((RESULTS / "published.json").read_text())["rows"]:
        assert bool(record["unless"]) == (record["verdict"] == CONTRADICTS), record["name"]

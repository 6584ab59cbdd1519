"""Settings of a stimulator: what is said of a group is what its turn gives, and no shift of the windows is better."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.turning import turning
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.fatigue import FLOOR, HALF_AN_HOUR, force_factor
from fes_mj.muscles.power import muscle_turn
from fes_mj.muscles.setting import MISTIMED, Setting
from fes_mj.muscles.settings import Settings

D1 = load_design("d1")


@pytest.fixture(scope="module")
def settings(riders):
    return Settings.solve(D1, riders, [9.0, 5.0], 9.0, 0.2)


def test_the_groups_give_the_power_together(settings):
    main = settings.main
    assert main.power.sum(axis=0) == pytest.approx(main.turn.power_mean[:, 0])
    assert main.summary()["power_two_legs_W"] == pytest.approx(2 * main.summary()["power_mean_W"])
    assert [setting.cadence for setting in settings.by_cadence] == [5.0, 9.0]


def test_what_is_lost_is_that_of_the_shifted_windows(settings, riders):
    main = settings.main
    later = muscle_turn(riders, D1, 9.0, main.windows.shifted(MISTIMED)).group_power[..., 0]
    expected = np.where(main.windows.width[:, 0, 0] > 0, (main.power - later).mean(axis=1), 0.0)
    assert main.early_late[1] == pytest.approx(expected, abs=1e-12)
    assert min(map(np.min, main.early_late)) > -1e-4


def test_effort_is_one_where_everything_is_as_in_the_measurement(settings, riders):
    """Twice the width costs twice as much; all groups as wide as measured cost what the measurement did."""
    measured = riders.windows()[..., 1].mean(axis=1)
    strengths = riders.strength(anatomy())[..., 0, 0] * anatomy().force[:, None]
    by_group = np.stack([strengths[part].sum(axis=0).mean() for part in anatomy().of_group])
    shares = measured * by_group / (measured @ by_group)
    width = settings.main.windows.width[:, 0, 0]
    assert settings.main.effort == pytest.approx(shares * width / measured)


def test_the_limit_is_kept_and_the_left_leg_is_half_a_turn_later(settings):
    rows = settings.summary()["windows"]
    assert len(rows) == 2 * 2 * len(MUSCLE_GROUPS)
    top = np.degrees(turning(D1).top_dead_centre)
    for right, left in zip(rows[::2], rows[1::2], strict=True):
        assert (right["leg"], left["leg"]) == ("right", "left")
        assert right["duty"] <= 0.2
        if right["on_deg"] is None:
            assert (left["on_deg"], right["duty"], right["power_W"]) == (None, 0, 0)
            continue
        assert (left["on_deg"] - right["on_deg"]) % 360 == pytest.approx(180)
        assert (right["off_deg"] - right["on_deg"]) % 360 == pytest.approx(360 * right["duty"])
        assert (right["on_from_tdc_deg"] + top - right["on_deg"] + 180) % 360 == pytest.approx(180)


def test_table_and_json_say_the_same(settings):
    rows, records = [*csv.DictReader(io.StringIO(settings.table_csv()))], settings.summary()["windows"]
    for row, record in zip(rows, records, strict=True):
        assert row["muscle"] == record["muscle"]
        assert float(row["cadence_rpm"]) == pytest.approx(record["cadence_rpm"], rel=1e-5)
        assert row["on_deg"] == ("" if record["on_deg"] is None else f"{record['on_deg']:.6g}")
    assert {round(float(row["cadence_rpm"]) * RPM, 3) for row in rows} == {5.0, 9.0}


def test_a_slower_crank_is_stimulated_later(riders):
    """What muscles lag takes more of a faster turn: groups that are stimulated at both lead by more."""
    slow, fast = (Setting.best(D1, riders, cadence).windows for cadence in (3.0, 9.0))
    both = ((slow.width > 0) & (fast.width > 0))[:, 0, 0]
    lead = (slow.on - fast.on)[both, 0, 0] % 360
    assert np.all((lead > 0) & (lead < 180))


def test_muscles_that_nothing_helps_are_refused(riders):
    """They shorten by a tenth of a fibre a second at most, and pull with nothing wherever they would drive."""
    slow = replace(riders, values=dict(riders.values) | {"max_speed": np.full(len(riders), 0.1)})
    with pytest.raises(InputError, match=r"^d1: .* 100 rpm"):
        Setting.best(D1, slow, 100 * RPM)


def test_half_an_hour_leaves_what_fatigue_says(settings):
    low, high = settings.main.summary()["power_two_legs_30_min_W"]
    fresh = settings.main.summary()["power_two_legs_W"]
    assert FLOOR * fresh < low < high < fresh
    factor = force_factor(settings.main.turn.activation.mean(axis=-1), HALF_AN_HOUR)
    assert high == pytest.approx(2 * np.sum(factor * settings.main.turn.group_power, axis=0).mean())

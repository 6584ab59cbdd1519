"""What the page can ask besides a turn: files in and out, runs."""

from functools import partial
from typing import Any

import mujoco
import pytest

import fes_mj
from fes_mj.common.checks import Check
from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.common.units import KMH
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.explore.answers import Answers
from fes_mj.explore.dimensions import content_of, design_of
from fes_mj.linkage.variables import replaced
from fes_mj.moments.files import moments_csv
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.riding.ride import Ride

D1 = content_of(fes_mj.load_design("d1"))


def test_the_start_knows_the_design_it_was_given() -> None:
    own = replaced(fes_mj.load_design("d1"), {"R2": 0.155})
    start = Answers(own, fes_mj.load_moments("p1p3")).start({})
    assert {*start["designs"]} == {"trt", "r1", "r2", "d1", "d2"}
    assert design_of(start["designs"][start["design"]]) == own
    assert start["chosen"] == "p1p3"


def test_save_and_load(answers: Answers) -> None:
    saved = answers.save({"design": D1 | {"name": "mine"}})
    assert saved["name"] == "mine.toml"
    assert answers.open_design(saved)["design"] == D1 | {"name": "mine"}


def test_a_damaged_file_is_refused_by_its_own_name(answers: Answers) -> None:
    with pytest.raises(InputError, match=r"^mine.toml: not valid TOML"):
        answers.open_design({"name": "mine.toml", "text": "[linkage"})
    with pytest.raises(InputError, match=r"^mine.toml: linkage.R2 is missing"):
        answers.open_design({"name": "../mine.toml", "text": answers.save({"design": D1})["text"].replace("R2 =", "#")})
    with pytest.raises(InputError, match=r"^a.csv: .*'x'"):
        answers.open_moments({"name": "a.csv", "text": "x\n1\n"})
    for question in ({}, {"name": 1, "text": "a"}, {"name": "a"}):
        with pytest.raises(InputError, match="no file"):
            answers.open_design(question)


def test_own_moments_join_the_groups(answers: Answers) -> None:
    text = moments_csv(fes_mj.load_moments("p1p3"))
    assert answers.open_moments({"name": "mine.csv", "text": text})["moments"] == ["p1p2", "p1p3", "mine"]
    under = answers.turn({"design": D1})["moments"]
    # the curves are written with nine digits
    assert under["mine"]["power_mean_W"] == pytest.approx(under["p1p3"]["power_mean_W"], abs=1e-6)
    assert under["mine"]["sd"] is None  # nothing is known of its error
    with pytest.raises(InputError, match=r"p1p2 .*group"):
        answers.open_moments({"name": "p1p2.csv", "text": text})


@pytest.mark.parametrize("legs", [1, 2])
def test_the_model_loads_in_mujoco(answers: Answers, legs: int) -> None:
    model = answers.model({"design": D1, "legs": legs})
    assert model["name"] == "d1.xml"
    loaded = mujoco.MjModel.from_xml_string(model["text"])
    assert loaded.nu == 1 + 2 * legs  # the servo of the crank, knee and hip of each leg


def test_simulate_says_what_the_command_says(answers: Answers) -> None:
    case = fes_mj.Case(fes_mj.load_design("d1"), fes_mj.load_moments())
    run = answers.simulate({"design": D1, "moments": "p1p2"})
    assert run["agrees"]
    assert f"mean power {case.simulation.power_mean:.2f} W" in run["verdict"]
    assert [row["ok"] for row in run["checks"]] == [check.ok for check in case.checks]


def test_ride_says_what_the_command_says(answers: Answers, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.explore.answers.Ride", partial(Ride, duration=4.0))
    moments = fes_mj.load_moments().at_speed(load_torque_velocity("hill"))
    case = RideCase(Ride(fes_mj.load_design("d1"), moments, duration=4.0))
    run = answers.ride({"design": D1, "moments": "p1p2"})
    assert run["agrees"] == case.agrees
    speed = case.simulation.trace.mean_speed
    assert speed is None or f"{speed / KMH:.2f} km/h at the end" in run["verdict"]
    assert [row["ok"] for row in run["checks"]] == [check.ok for check in case.checks]


def test_a_check_that_fails_is_named(answers: Answers, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.crosscheck.turn_case.check", lambda name, value, _: Check(name, value, limit=0.0))
    run = answers.simulate({"design": D1, "moments": "p1p2"})
    assert not run["agrees"]
    assert run["verdict"].startswith("Dynamic and static do not agree (mean_power")


@pytest.mark.parametrize(
    ("change", "message"),
    [({"moments": "p9"}, "moments is 'p9'"), ({"legs": 3}, "legs is 3")],
)
def test_questions_that_mean_nothing(answers: Answers, change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        answers.simulate({"design": D1, "moments": "p1p2"} | change)


def test_simulate_refuses_what_does_not_turn(answers: Answers) -> None:
    with pytest.raises(AssemblyError):
        answers.simulate({"design": D1 | {"linkage": D1["linkage"] | {"R2": 0.3}}, "moments": "p1p2"})

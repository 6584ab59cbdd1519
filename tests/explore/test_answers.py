"""What the page can ask besides a turn: files in and out, riders, and what runs are asked."""

from pathlib import Path
from typing import Any

import mujoco
import pytest

import fes_mj
from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.explore.answers import Answers
from fes_mj.explore.dimensions import content_of, design_of
from fes_mj.linkage.riders import populations
from fes_mj.linkage.variables import replaced
from fes_mj.moments.files import moments_csv
from tests.explore.conftest import question

D1 = content_of(fes_mj.load_design("d1"))


def test_the_start_knows_the_design_it_was_given() -> None:
    own = replaced(fes_mj.load_design("d1"), {"R2": 0.155})
    start = Answers(own, fes_mj.load_moments("p1p3")).start(question())
    assert {*start["designs"]} == {"trt", "r1", "r2", "d1", "d2"}
    assert design_of(start["designs"][start["design"]]) == own
    assert start["chosen"] == "p1p3"


def test_save_and_load(answers: Answers) -> None:
    saved = answers.save(question(design=D1 | {"name": "mine"}))
    assert saved["name"] == "mine.toml"
    assert answers.open_design(question(**saved))["design"] == D1 | {"name": "mine"}


def test_a_damaged_file_is_refused_by_its_own_name(answers: Answers) -> None:
    with pytest.raises(InputError, match=r"^mine.toml: not valid TOML"):
        answers.open_design(question(name="mine.toml", text="[linkage"))
    with pytest.raises(InputError, match=r"^a.csv: .*'x'"):
        answers.open_moments(question(name="a.csv", text="x\n1\n"))


def test_own_moments_join_the_groups_of_their_page(answers: Answers) -> None:
    text, mine = moments_csv(fes_mj.load_moments("p1p3")), {"page": "mine"}
    opened = answers.open_moments(question(name="p1p2.csv", text=text, **mine))
    assert (opened["name"], opened["moments"]) == ("p1p2 2", ["p1p2", "p1p3", "p1p2 2"])
    under = answers.turn(question(design=D1, **mine))["moments"]
    # the curves are written with nine digits
    assert under["p1p2 2"]["power_mean_W"] == pytest.approx(under["p1p3"]["power_mean_W"], abs=1e-6)
    assert under["p1p2 2"]["sd"] is None  # nothing is known of its error
    assert [*answers.turn(question(design=D1, page="another"))["moments"]] == ["p1p2", "p1p3"]
    assert answers.start(question(**mine))["moments"] == opened["moments"]  # after a reload


@pytest.mark.parametrize("sex", ["male", "female"])
def test_a_rider_by_percentile(answers: Answers, sex: str) -> None:
    rider = design_of(answers.change(question(design=D1, sex=sex, percentile=5))["design"]).rider
    people = next(people for people in populations().values() if people.sex == sex)
    assert rider == people.rider(5)


@pytest.mark.parametrize("legs", [1, 2])
def test_the_model_loads_in_mujoco(answers: Answers, legs: int) -> None:
    model = answers.model(question(design=D1, legs=legs))
    assert model["name"] == "d1.xml"
    loaded = mujoco.MjModel.from_xml_string(model["text"])
    assert loaded.nu == 1 + 2 * legs  # the servo of the crank, knee and hip of each leg


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("simulate", {"moments": "p9"}, "moments is 'p9'"),
        ("simulate", {"moments": {}}, r"moments is \{\}"),
        ("simulate", {"legs": 3}, "legs is 3"),
        ("simulate", {"legs": [1]}, r"legs is \[1\]"),
        ("ride", {"transmission": "chain"}, "transmission is 'chain'"),
        ("ride", {"slope": 45}, "slope is 45"),
        ("fit", {"drive": "muscles"}, "muscles do not drive this"),
        ("ride", {"drive": "legs"}, "drive is 'legs'"),
    ],
)
def test_runs_that_mean_nothing(answers: Answers, name: str, change: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        answers.run(name, question(**{"design": D1, "moments": "p1p2"} | change))


def test_runs_need_what_turns(answers: Answers) -> None:
    with pytest.raises(AssemblyError):
        answers.run("optimise", question(design=D1 | {"linkage": D1["linkage"] | {"R2": 0.3}}, moments="p1p2"))


def test_a_run_is_asked_of_the_page(answers: Answers, tmp_path: Path) -> None:
    outcome = answers.run("simulate", question(design=D1, moments="p1p3", legs=2))(tmp_path)
    case = fes_mj.Case(fes_mj.load_design("d1"), fes_mj.load_moments("p1p3"), legs=2)
    assert f"mean power {case.simulation.power_mean:.2f} W" in outcome["verdict"]

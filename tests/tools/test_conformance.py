"""Other tools read the exported models: every installed one is run, and the judge would notice if one did not."""

from __future__ import annotations

import copy
import itertools
import json
import math
from pathlib import Path
from typing import Any

import pytest

from fes_mj import load_design
from fes_mj.linkage.design_file import DESIGNS
from tools.conformance.asking import ROOT, interpreter, reference, rows
from tools.conformance.judging import Row, judge
from tools.conformance.motions import MOTIONS, jobs
from tools.conformance.readers import READERS

Asked = tuple[dict[Any, Any], dict[Any, Any]]  # jobs, MuJoCo's answers


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> Asked:
    """Of the TRT."""
    tasks = jobs([load_design("trt")], tmp_path_factory.mktemp("models"))
    return tasks, reference(tasks)


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> Asked:
    """Of all designs."""
    tasks = jobs([load_design(name) for name in DESIGNS], tmp_path_factory.mktemp("models"))
    return tasks, reference(tasks)


# MJX compiles every motion of every design, half a minute each; `make readers` asks it about all.
COMPILED = {"mjx": ("d1",)}


@pytest.mark.long
@pytest.mark.parametrize("name", READERS)
def test_reader_conforms(name: str, everything: Asked) -> None:
    if interpreter(name) is None:
        pytest.skip(f"{name} is not installed; `make readers` installs it")
    designs = COMPILED.get(name, DESIGNS)
    tasks, references = ({key: part[key] for key in part if key[0] in designs} for part in everything)
    judged_rows = rows(name, tasks, references)
    assert [row.design for row in judged_rows] == [*designs]
    assert all(row.ok for row in judged_rows), [row for row in judged_rows if not row.ok]


@pytest.mark.process
def test_mujoco_finds_the_same_in_another_process(asked: Asked) -> None:
    (row,) = rows("mujoco", *asked)
    assert row.ok
    assert not row.drops
    assert row.default_model == "loads"
    assert set(row.motions) == set(MOTIONS)
    assert all(motion.moved == (name != "motors") for name, motion in row.motions.items())


@pytest.fixture
def good(asked: Asked) -> dict[Any, Any]:
    """MuJoCo's answers, as a reader would give them."""
    return copy.deepcopy(asked[1])


def judged(name: str, answers: dict[Any, Any], asked: Asked) -> Row:
    return judge(name, "0", "trt", answers, *asked)


def test_the_judge_accepts_the_reference(good: dict[Any, Any], asked: Asked) -> None:
    assert judged("pinocchio", good, asked).ok
    assert not judged("mjx", good, asked).ok  # with dJ/dt v it would no longer be the MJX of the table
    for answer in good.values():
        if "acceleration" in answer:
            answer["acceleration"] = answer["without_velocity_term"]
    assert judged("mjx", good, asked).ok


def test_the_judge_refuses_every_fault(good: dict[Any, Any], asked: Asked) -> None:
    for part, value in {"loops": 2, "free": 2, "pedal": [0.0, 0.0]}.items():
        faulty = copy.deepcopy(good)
        for anchors in ("sites", "bodies"):
            faulty["trt", anchors, "one leg"][part] = value
        assert not judged("pinocchio", faulty, asked).ok, part
    for motion, error in itertools.product(MOTIONS, (1.0, math.nan)):
        for joint in good["trt", "sites", motion]["acceleration"]:
            faulty = copy.deepcopy(good)
            faulty["trt", "sites", motion]["acceleration"][joint] += error
            assert not judged("mujoco", faulty, asked).ok, (motion, joint, error)
    refused = {key: {"error": "ValueError: no"} for key in good}
    row = judged("pinocchio", refused, asked)
    assert not row.ok
    assert row.default_model == "ValueError: no"
    good["trt", "sites", "default"]["keeps"]["sensors"] = 0
    assert judged("pinocchio", good, asked).drops == ("sensors",)
    assert judged("pinocchio", good, asked).ok


@pytest.mark.parametrize("motion", ["one leg", "two legs", "ride"])
def test_the_judge_sees_energy_and_gaps_at_the_horizon(motion: str, good: dict[Any, Any], asked: Asked) -> None:
    """The last state faster by a tenth, or its angles larger by a thousandth; or no states at all."""
    assert judged("mujoco", good, asked).ok
    for part, factor, spoilt in ((1, 1.1, "energy"), (0, 1.001, "gap"), (0, math.nan, "all")):
        faulty = copy.deepcopy(good)
        states = faulty["trt", "sites", motion]["states"]
        states[-1][part] = [factor * value for value in states[-1][part]]
        verdict = judged("mujoco", faulty, asked).motions[motion]
        assert not verdict.ok, spoilt
    faulty = copy.deepcopy(good)
    faulty["trt", "sites", motion]["states"] = []
    assert not judged("mujoco", faulty, asked).ok


def test_the_kept_table_is_complete_and_good() -> None:
    kept = json.loads((ROOT / "results" / "readers.json").read_text())["rows"]
    assert {(row["reader"], row["design"]) for row in kept} == {
        (reader, name) for reader in READERS for name in DESIGNS
    }
    assert all(row["ok"] for row in kept)
    table = Path(ROOT / "results" / "readers.md").read_text(encoding="utf-8")
    assert table.count("| ok |") == len(kept)

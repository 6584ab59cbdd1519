"""Other tools read the exported models: every installed one is run, and the judge would notice if one did not."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from fes_mj import load_design
from fes_mj.design_file import DESIGNS
from tools.conformance import READERS, RESULTS, Row, interpreter, jobs, judge, reference, rows


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, ...]:
    """Designs, jobs and MuJoCo's answers."""
    designs = [load_design(name) for name in DESIGNS]
    tasks = jobs(designs, tmp_path_factory.mktemp("models"))
    return designs, tasks, reference(designs, tasks)


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.long) for name in READERS if name != "mujoco"])
def test_reader_conforms(name: str, asked: tuple[Any, ...]) -> None:
    if interpreter(name) is None:
        pytest.skip(f"{name} is not installed; `make readers` installs it")
    found = rows(name, *asked)
    assert [row.design for row in found] == list(DESIGNS)
    assert all(row.ok for row in found), [row for row in found if not row.ok]


def test_mujoco_finds_the_same_in_another_process(asked: tuple[Any, ...]) -> None:
    found = rows("mujoco", *asked)
    assert all(row.ok and not row.drops and row.default_model == "loads" for row in found)


@pytest.fixture
def good(asked: tuple[Any, ...]) -> list[dict[str, Any]]:
    """MuJoCo's answers on D1, as a reader would give them."""
    return copy.deepcopy(asked[2][9:12])


def judged(name: str, answers: list[dict[str, Any]], asked: tuple[Any, ...]) -> Row:
    return judge(name, "0", "d1", answers, asked[2][9:12])


def test_the_judge_accepts_the_reference(good: list[dict[str, Any]], asked: tuple[Any, ...]) -> None:
    assert judged("pinocchio", good, asked).ok
    assert not judged("mjx", good, asked).ok  # with dJ/dt v it would no longer be the MJX of the table
    good[0]["acceleration"] = good[0]["without_velocity_term"]
    assert judged("mjx", good, asked).ok


def test_the_judge_refuses_every_fault(good: list[dict[str, Any]], asked: tuple[Any, ...]) -> None:
    for key, value in {"loops": 1, "free": 2, "pedal": [0.0, 0.0]}.items():
        faulty = copy.deepcopy(good)
        for answer in faulty[:2]:
            answer[key] = value
        assert not judged("pinocchio", faulty, asked).ok, key
    faulty = copy.deepcopy(good)
    faulty[0]["acceleration"]["knee"] += 1.0
    assert not judged("pinocchio", faulty, asked).ok
    refused = [{"error": "ValueError: no"}] * 3
    row = judged("pinocchio", refused, asked)
    assert not row.ok
    assert row.default_model == "ValueError: no"
    good[2]["keeps"]["sensors"] = 0
    assert judged("pinocchio", good, asked).drops == ("sensors",)


def test_the_kept_table_is_complete_and_good() -> None:
    kept = json.loads((RESULTS / "readers.json").read_text())["rows"]
    assert {(row["reader"], row["design"]) for row in kept} == {
        (reader, name) for reader in READERS for name in DESIGNS
    }
    assert all(row["ok"] for row in kept)
    table = Path(RESULTS / "readers.md").read_text(encoding="utf-8")
    assert table.count("| ok |") == len(kept)

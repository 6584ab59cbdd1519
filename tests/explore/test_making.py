"""Whether a design can be made, as the page says it."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.common.errors import MissingPartError
from fes_mj.explore import making as module
from fes_mj.explore.making import making
from fes_mj.linkage.design import Frame

D1, P1P2 = fes_mj.load_design("d1"), fes_mj.load_moments()


def test_it_says_what_draw_says(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["draw", "d1", "-o", str(tmp_path / "d1"), "--json"]) == 0
    drawn = json.loads(capsys.readouterr().out)
    made = making(D1, P1P2)
    assert made["verdict"] == f"feet {1e3 * drawn['between_feet_m']:.0f} mm apart"
    assert made["ok"]
    assert {link: place for place, links in enumerate(made["layers"], 1) for link in links} == drawn["layers"]
    for gap in made["gaps"]:
        distance = float(gap["mm"].replace("\N{MINUS SIGN}", "-"))
        assert distance == pytest.approx(1e3 * drawn["clearance_min_m"][gap["pair"]], abs=0.051)
        assert gap["deg"] == round(drawn["clearance_crank_angle_deg"][gap["pair"]])
    near = [pair for pair, distance in drawn["clearance_min_m"].items() if distance is not None and distance < 0.1]
    assert {gap["pair"] for gap in made["gaps"]} == {*near}
    assert made["unknown"] == ["tube", "chainring", "wheel", "ground"]


def test_what_meets_is_named() -> None:
    lowest = float(np.min(fes_mj.quasi_static(D1, P1P2).motion.points["pedal"].value.imag))
    made = making(replace(D1, frame=Frame(ground_height=lowest)), P1P2)
    assert not made["ok"]
    assert made["verdict"].startswith("cannot be built so: ")
    assert "boot - ground (\N{MINUS SIGN}" in made["verdict"]


def test_why_there_is_no_such_design_to_make(monkeypatch: pytest.MonkeyPatch) -> None:
    made = making(fes_mj.load_design("r2"), P1P2)
    assert (made["ok"], made.keys()) == (False, {"ok", "verdict"})
    assert re.match(r"no pin in stock bears the \d+ N on the rocker pivot, ", made["verdict"])

    def missing(*_: object) -> None:
        raise MissingPartError("shapely is missing; pip install 'fes-mj[build]'")

    monkeypatch.setattr(module, "build", missing)
    assert making(D1, P1P2) == {"ok": False, "verdict": "shapely is missing; pip install 'fes-mj[build]'"}

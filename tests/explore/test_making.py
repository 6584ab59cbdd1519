"""Whether a design can be made, as the page says it."""

import re
from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import MissingPartError
from fes_mj.explore import making as module
from fes_mj.explore.making import making
from fes_mj.linkage.design import Frame
from fes_mj.statics.sizes import FORCE_POINTS, build

D1, P1P2 = fes_mj.load_design("d1"), fes_mj.load_moments()


def test_it_says_what_draw_finds() -> None:
    made, drawn = making(D1, P1P2), build(fes_mj.quasi_static(D1, P1P2, points=FORCE_POINTS)).stack
    assert (made["ok"], made["verdict"]) == (True, f"feet {1e3 * drawn.feet:.0f} mm apart")
    assert {link: place for place, links in enumerate(made["layers"], 1) for link in links} == drawn.layers
    shown = {gap["pair"]: (gap["mm"].replace("\N{MINUS SIGN}", "-"), gap["deg"]) for gap in made["gaps"]}
    near = [gap for gap in drawn.side.gaps if gap.distance < 0.1]
    assert shown == {gap.pair: (f"{1e3 * gap.distance:.1f}", round(np.degrees(gap.crank_angle))) for gap in near}
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

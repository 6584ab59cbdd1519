"""What the page says of a design that muscles drive."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.text import typeset
from fes_mj.explore.muscles import by_muscles
from tests.cli.conftest import answer

D1, D2 = fes_mj.load_design("d1"), fes_mj.load_design("d2")


def test_it_says_what_static_says(capsys: pytest.CaptureFixture[str]) -> None:
    _, result = answer(capsys, "static", "d2", "--drive", "muscles", "--group", "p1p3", "--curves")
    shown = by_muscles(D2, D1, "p1p3")
    assert shown["power_mean_W"] == result["power_mean_W"]
    assert shown["static"] == pytest.approx(
        result["crank_moment_Nm"] * np.array(result["cadence_rpm"] * np.pi / 30), abs=1e-3
    )
    rows = {row["name"]: (row["text"], row["unit"]) for row in shown["numbers"]}
    assert rows["muscles"] == (typeset(f"{result['power_mean_W']:.2f} +- {result['power_sd_W']:.2f}"), "W")
    for group, window in result["windows_deg"].items():
        assert rows[group] == (("{:.0f} to {:.0f}".format(*window), "deg") if window else ("never", ""))
    assert shown["compared_W"] == by_muscles(D1, D1, "p1p3")["power_mean_W"]


def test_both_legs_are_half_a_turn_apart() -> None:
    one, both = (np.array(by_muscles(D1, D1, "p1p2", legs)["static"]) for legs in (1, 2))
    assert both == pytest.approx(one + np.roll(one, 180), abs=2e-3)


def test_why_there_is_no_power() -> None:
    stuck = D1.with_linkage(crank=0.25)
    assert "cannot close" in by_muscles(stuck, D1, "p1p2")["why"]
    assert by_muscles(D1, stuck, "p1p2")["compared_W"] is None
    assert by_muscles(D1, D1, "trial") == {"why": "no muscles of trial are known, only of p1p2 and p1p3"}

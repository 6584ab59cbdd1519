"""The two numbers on the page, beside another design's, and what the page says of muscles."""

import numpy as np
import pytest

import fes_mj
from fes_mj.explore.numbers import by_muscles, numbers
from tests.cli.conftest import answer

D1, D2, P1P3 = fes_mj.load_design("d1"), fes_mj.load_design("d2"), fes_mj.load_moments("p1p3")


def test_it_says_what_static_says(capsys: pytest.CaptureFixture[str]) -> None:
    _, result = answer(capsys, "static", "d1", "d2", "--group", "p1p3")
    shown, (_, ratio), content = numbers(D2, D1, P1P3), result["ratios"], result["designs"][1]
    assert shown["rider_power_mean_W"] == content["rider_power_mean_W"]
    for row, column, value, (low, high), digits in (
        ("assumed", 0, content["paper_power_mean_W"], content["paper_power_interval_W"], 2),
        ("assumed", 1, ratio["paper_power_ratio"], ratio["paper_power_ratio_interval"], 2),
        ("rider", 0, content["rider_power_mean_W"], content["rider_power_interval_W"], 1),
        ("rider", 1, ratio["rider_power_ratio"], ratio["rider_power_ratio_interval"], 2),
        ("rider", 2, content["rider_power_per_trt"], content["rider_power_per_trt_interval"], 2),
    ):
        assert shown["both"][row][column] == [f"{value:.{digits}f}", f"{low:.{digits}f} to {high:.{digits}f}"]
    assert shown["rider"] == "{} ({})".format(*shown["both"]["rider"][0])


def test_curve_and_windows_are_those_of_static(capsys: pytest.CaptureFixture[str]) -> None:
    _, result = answer(capsys, "static", "d2", "--drive", "muscles", "--group", "p1p3", "--curves")
    shown = by_muscles(D2, P1P3)
    power = result["crank_moment_Nm"] * np.array(result["cadence_rpm"] * np.pi / 30)
    assert shown["static"] == pytest.approx(power, abs=1e-3)
    assert by_muscles(D2, P1P3, 2)["static"] == pytest.approx(power + np.roll(power, 180), abs=2e-3)
    rows = {row["name"]: (row["text"], row["unit"]) for row in shown["windows"]}
    for group, window in result["windows_deg"].items():
        assert rows[group] == (("{:.0f} to {:.0f}".format(*window), "deg") if window else ("never", ""))


def test_why_there_is_no_rider() -> None:
    stuck = D1.with_linkage(crank=0.25)
    assert "cannot close" in numbers(stuck, D1, P1P3)["why"]
    assert "cannot close" in by_muscles(stuck, P1P3)["why"]
    both = numbers(D1, stuck, P1P3)["both"]
    assert {name: [cell is not None for cell in cells] for name, cells in both.items()} == {
        "assumed": [True, False, False],
        "rider": [True, False, True],
    }
    own = fes_mj.load_moments("examples/trial/trial.toml")
    assert numbers(D1, D1, own)["why"].startswith("no muscles belong to these moments")
    assert by_muscles(D1, own) == {"why": f"no muscles of {own.name} are known, only of p1p2 and p1p3"}

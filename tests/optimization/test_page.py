"""The page of a winner: its numbers, its curves, and the front with every objective."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fes_mj
from fes_mj.common.style import LINKS
from fes_mj.optimization.evenness import fluctuation
from fes_mj.optimization.optimize import Optimum
from fes_mj.optimization.pareto import Front
from fes_mj.optimization.winner import assess
from fes_mj.statics.cycles import cycles
from fes_mj.statics.turn import quasi_static
from fes_mj.statics.work_table import WorkTable
from tests.browser import NEEDS_BROWSER, PHONE, browser, check_on_a_phone
from tests.optimization.conftest import problem_of

pytest.importorskip("jinja2")
from fes_mj.optimization import page
from fes_mj.optimization.page import page_html

__all__ = ["browser"]  # the fixture
MOMENTS = fes_mj.load_moments("p1p2")


@pytest.fixture(scope="module")
def front() -> Front:
    """A front of two: D1, and D1 with another crank."""
    problem = problem_of("d1")
    x = problem.variables(problem.template) + np.array([[0.0] * 10, [0.0, 0.0, 0.004] + [0.0] * 7])
    designs = [problem.design(row, "one") for row in x]
    power = [
        [quasi_static(design, fes_mj.load_moments(group)).power_mean for group in ("p1p2", "p1p3")]
        for design in designs
    ]
    return Front(x, np.array(power), np.array([fluctuation(design, MOMENTS)[0] for design in designs]), 2)


@pytest.fixture(scope="module")
def html(front: Front) -> str:
    problem = problem_of("d1")
    winner = assess(problem.template, fes_mj.load_design("trt"), MOMENTS)
    return page_html(winner, Optimum(problem, "nsga-ii", "d1", front.x[0], 2, front), "Found by hand:\nfes_mj ...")


def test_the_page_needs_no_network_and_shows_smoothness(html: str) -> None:
    assert not re.search(r"@import|url\((?!#)|<(script|link|iframe|img)\b", html)
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", html))
    case = fes_mj.Case(fes_mj.load_design("d1"), MOMENTS)
    exact = case.reference_power()
    low, high = re.search(r"lowest to highest, W ([+-]\d+) to ([+-]\d+)", text).groups()  # type: ignore[union-attr]
    assert (float(low), float(high)) == pytest.approx((exact.min(), exact.max()), abs=1)
    knee, hip = cycles(case.design, WorkTable.of(MOMENTS)).joints
    assert f"reversals of knee and hip in a turn {knee.reversals[0]}, {hip.reversals[0]} " in text


def test_every_objective_of_the_front_is_drawn_and_tabled(html: str, front: Front) -> None:
    assert html.count("<svg") == 4
    assert html.count("fluctuation of energy") >= 3  # two axes and a column
    assert front.fluctuation is not None
    cells = re.findall(r"<td>([\d.]+)</td>", html[html.index("<h2>Front") : html.index("<h2>Constraints")])
    rows = np.array(cells, float).reshape(-1, 4)
    np.testing.assert_allclose(rows[:, 1:3], front.power, atol=0.005)
    np.testing.assert_allclose(rows[:, 3], front.fluctuation, atol=0.0005)


def test_the_star_is_at_the_design_that_was_chosen(front: Front, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the front, the one with its variables; over the fluctuation once for each group."""
    drawn: list[Any] = []
    monkeypatch.setattr("fes_mj.viewing.charts.page_svg", lambda _, axes: drawn.append(axes) or "")
    for row in (0, 1):
        page._front_figures(front, front.x[row])
        powers, over = drawn[-2:]
        stars = [
            [line.get_xydata().tolist() for line in axes.lines if line.get_marker() == "*"] for axes in (powers, over)
        ]
        assert stars[0] == [[front.power[row].tolist()]]
        assert stars[1] == [[[front.fluctuation[row], power]] for power in front.power[row]]


def test_without_smoothness_there_is_no_column_of_it(front: Front) -> None:
    plain = Front(front.x, front.power, None, 2)
    assert [*plain.table.columns] == ["design", "p1p2, W", "p1p3, W"]
    assert [len(row) for row in plain.table.cells] == [3, 3]
    assert "fluctuation" not in plain.as_csv()


def test_links_have_the_colours_of_the_video(html: str) -> None:
    drawing = html[html.index("<svg") : html.index("</svg>")]
    assert all(colour in drawing for colour in LINKS.values())


class TestOnAPhone:
    """Of the page in a browser as wide as a phone."""

    pytestmark = NEEDS_BROWSER

    def test_the_page_fits(self, browser: Any, html: str, tmp_path: Path) -> None:
        (file := tmp_path / "page.html").write_text(html, encoding="utf-8")
        check_on_a_phone(browser, file)

    def test_every_number_is_seen_without_scrolling(self, browser: Any, html: str, tmp_path: Path) -> None:
        (file := tmp_path / "page.html").write_text(html, encoding="utf-8")
        width, height = PHONE
        page = browser.new_page(viewport={"width": width, "height": height})
        page.goto(file.as_uri())
        boxes = [cell.bounding_box() for cell in page.locator("table").first.locator("td:nth-child(2)").all()]
        assert len(boxes) > 10
        assert all(box["x"] + box["width"] <= width for box in boxes)
        page.close()

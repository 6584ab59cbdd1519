"""The page in a real browser."""

import re
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.explore.answers import Answers
from fes_mj.explore.server import Server
from fes_mj.explore.turn import POINTS
from fes_mj.linkage.design_file import design_toml
from fes_mj.linkage.variables import replaced
from fes_mj.statics.turn import quasi_static
from tests.browser import DESKTOP, NEEDS_BROWSER, PHONE, browser
from tests.cli.conftest import answer

__all__ = ["browser"]  # the fixture

pytestmark = NEEDS_BROWSER
PATIENCE = 60_000  # ms


class Page:
    """A page that is open, and everything that went wrong in it."""

    def __init__(self, page: Any, address: str) -> None:
        self.page, self.wrong = page, []
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("console", lambda message: self.wrong.append(message.text) if message.type == "error" else None)
        page.goto(address)
        self.settled(0)

    @property
    def updates(self) -> int:
        return int(self.page.evaluate("Number(document.body.dataset.updates || 0)"))

    def settled(self, before: int) -> None:
        """Wait until the page has shown more answers than before."""
        self.until(lambda: self.updates > before)

    def until(self, holds: Callable[[], bool]) -> None:
        """Wait, without a script of ours in the page: its policy allows none."""
        deadline = time.monotonic() + PATIENCE / 1000
        while not holds():
            assert time.monotonic() < deadline
            self.page.wait_for_timeout(20)

    def set(self, name: str, value: float) -> None:
        before = self.updates
        self.page.fill(f"#number-{name}", str(value))
        self.page.press(f"#number-{name}", "Enter")
        self.settled(before)

    def number(self, name: str) -> str:
        return str(self.page.inner_text(f"#numbers tr[data-name={name}] td:nth-child(2)"))

    @property
    def power(self) -> float:
        return float(self.number("power").split()[0])

    def save(self, folder: Path) -> Path:
        with self.page.expect_download() as download:
            self.page.click("#save")
        path = folder / download.value.suggested_filename
        download.value.save_as(path)
        return path

    def choose(self, select: str, value: str) -> None:
        before = self.updates
        self.page.select_option(select, value)
        self.settled(before)


@pytest.fixture(params=[DESKTOP], ids=["desktop"])
def page(browser: Any, answers: Answers, request: pytest.FixtureRequest) -> Iterator[Page]:
    width, height = request.param
    server = Server(answers, "127.0.0.1", 0)
    thread = threading.Thread(target=server.run)
    thread.start()
    opened = browser.new_page(viewport={"width": width, "height": height})
    page = Page(opened, server.address)
    yield page
    opened.close()
    server.should_exit = True
    thread.join()
    assert page.wrong == []


def test_a_slider_moves_and_the_power_is_that_of_the_saved_file(
    page: Page, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, before = page.number("power"), page.updates
    slider = page.page.locator(".dimension[data-name=R2] input[type=range]")
    slider.focus()
    for _ in range(3):
        slider.press("ArrowLeft")
    page.settled(before)
    page.until(page.page.locator("#undo").is_enabled)
    page.page.wait_for_timeout(500)  # answers under way
    saved = page.save(tmp_path)
    assert saved.name == "d1-edited.toml"
    design, moments = fes_mj.load_design(saved), fes_mj.load_moments()
    assert 0.14 < design.linkage.crank < fes_mj.load_design("d1").linkage.crank
    static = quasi_static(design, moments, points=POINTS)
    assert page.number("power") == f"{static.power_mean:.2f} ± {static.power_sd:.2f}"
    code, result = answer(capsys, "static", str(saved))
    assert code == 0
    # shown with two digits, of a tenth of the angles (test_turn)
    assert page.power == pytest.approx(result["power_mean_W"], abs=0.005 + 2e-4 * result["power_mean_W"])
    before = page.updates
    page.page.click("#reset")
    page.settled(before)
    assert page.number("power") == first
    before = page.updates
    page.page.click("#undo")  # of the reset
    page.settled(before)
    assert page.power == pytest.approx(static.power_mean, abs=0.005)


def test_an_impossible_linkage_is_drawn_open_and_blocks_nothing(page: Page) -> None:
    first = page.number("power")
    page.set("R2", 25)
    assert "rocker and coupler cannot close at crank angle 166.8 deg" in page.page.inner_text("#error")
    assert page.page.input_value("#angle") == "167"
    gap = page.page.locator("#scene .gap:visible").bounding_box()
    assert gap["width"] > 10  # pixels; 80.68 mm lack
    assert page.page.inner_text("#power") == "no power"
    before = page.updates
    page.page.click("#undo")
    page.settled(before)
    assert page.number("power") == first
    assert page.page.is_hidden("#error")
    assert page.page.locator("#scene .gap:visible").count() == 0


def test_load_files(page: Page, tmp_path: Path) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(design_toml(replaced(fes_mj.load_design("r1"), {"R6": 0.1})))
    before = page.updates
    page.page.set_input_files("#open-file", own)
    page.settled(before)
    static = quasi_static(fes_mj.load_design(own), fes_mj.load_moments(), points=POINTS)
    assert page.power == pytest.approx(static.power_mean, abs=0.005)
    assert page.page.input_value("#design") == "mine"
    assert page.page.locator(".dimension[data-name=gamma]").count() == 0  # no CDT
    bad = tmp_path / "bad.toml"
    bad.write_text("[linkage]\nkind = 'crt'\n")
    page.page.set_input_files("#open-file", bad)
    page.page.wait_for_selector("#message:visible")
    assert page.page.inner_text("#message").startswith("bad.toml: linkage.R1 is missing")
    page.wrong.clear()  # the browser itself logs a refused question
    moments = tmp_path / "own.csv"
    moments.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n")
    before = page.updates
    page.page.set_input_files("#moments-file", moments)
    page.settled(before)
    static = quasi_static(fes_mj.load_design(own), fes_mj.load_moments(moments), points=POINTS)
    assert page.number("power") == f"{static.power_mean:.2f}".replace("-", "−")  # noqa: RUF001
    assert run(["static", str(own), "--moments", str(moments), "-q"]) == 0


def test_limits_can_be_switched_off(page: Page) -> None:
    page.choose("#design", "r2")
    outside = page.page.locator("#numbers tr.outside")
    assert [row.split("\t")[0] for row in outside.all_inner_texts()] == ["Grashof margin"]
    assert "the Grashof margin is 0.06 cm" in page.page.inner_text("#broken")
    page.page.click("#limits")
    assert outside.count() == 0
    assert page.page.inner_text("#broken") == ""


def test_simulate_shows_its_verdict_while_sliders_move(page: Page) -> None:
    page.page.click("text=Simulate in MuJoCo")
    page.set("R6", 11)
    page.page.wait_for_selector("#verdict table")
    verdict = page.page.inner_text("#verdict p")
    assert verdict.startswith("Of the design as it was: Dynamic and static agree: mean power 31.")
    assert page.page.locator("#verdict td.good").count() == page.page.locator("#verdict table tr").count() - 1


def test_the_model_is_downloaded(page: Page) -> None:
    with page.page.expect_download() as download:
        page.page.click("#model")
    assert download.value.suggested_filename == "d1.xml"
    assert "<mujoco" in Path(download.value.path()).read_text()


def test_it_plays_and_stops(page: Page) -> None:
    angle = page.page.locator("#angle-shown")
    before = angle.inner_text()
    page.until(lambda: angle.inner_text() != before)
    page.page.click("#play")
    stopped = angle.inner_text()
    page.page.wait_for_timeout(300)
    assert angle.inner_text() == stopped
    page.page.fill("#angle", "90")
    assert angle.inner_text() == "90 deg"
    page.choose("#legs", "2")
    assert page.page.locator("#scene .far").count() == 1


@pytest.mark.parametrize("page", [PHONE], indirect=True, ids=["phone"])
def test_on_a_phone_motion_and_power_stay_in_sight(page: Page) -> None:
    width, height = PHONE
    assert page.page.evaluate("document.documentElement.scrollWidth") == width
    row = page.page.locator(".dimension[data-name=R10]")
    row.evaluate("node => node.scrollIntoView({block: 'end'})")
    scene, plot, box = (
        page.page.locator(selector).bounding_box() for selector in ("#scene", "#power-plot", "#number-R10")
    )
    assert scene["y"] >= 0
    assert scene["y"] + scene["height"] <= plot["y"]
    assert plot["y"] + plot["height"] <= box["y"]  # nothing hides what is being moved
    assert box["y"] + box["height"] <= height
    assert re.fullmatch(r"31\.\d\d ± 0\.\d\d W", page.page.inner_text("#power"))
    page.set("R10", 20)
    assert page.page.inner_text("#against").startswith("d1 as loaded: 31.")

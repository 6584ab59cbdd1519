"""The page in a real browser: what a designer sees and does."""

import re
import threading
from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.common.reading import Section
from fes_mj.explore.answers import Answers
from fes_mj.linkage.design_file import design_toml
from fes_mj.linkage.riders import populations
from fes_mj.linkage.variables import replaced
from fes_mj.moments.files import moments_csv
from tests.browser import LAPTOP, NEEDS_BROWSER, PHONE, SCREENS, browser
from tests.cli.conftest import answer
from tests.explore.browsing import Page, page, server

__all__ = ["browser", "page", "server"]  # fixtures

pytestmark = NEEDS_BROWSER


def test_a_slider_moves_and_the_power_is_that_of_the_saved_file(
    page: Page, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, slider = page.number("power"), page.page.locator(".dimension[data-name=R2] input[type=range]")
    slider.focus()
    page.after(lambda: [slider.press("ArrowLeft") for _ in range(3)])
    page.page.wait_for_timeout(800)  # answers under way, and a rest in which it becomes an entry of the history
    saved = page.save(tmp_path)
    assert saved.name == "d1-edited.toml"
    assert 0.14 < fes_mj.load_design(saved).linkage.crank < fes_mj.load_design("d1").linkage.crank
    code, result = answer(capsys, "static", str(saved))
    assert code == 0
    power = page.number("power")
    assert power == f"{result['power_mean_W']:.2f}"
    page.after(lambda: page.page.click("#reset"))
    assert page.number("power") == first
    page.after(lambda: page.page.click("#undo"))  # of the reset
    assert page.number("power") == power


def test_an_impossible_linkage_is_drawn_open_and_marks_what_must_change(page: Page) -> None:
    first = page.number("power")
    page.set("R2", 25)
    lacking = fes_mj.load_design("d1").linkage
    missing = 100 * (0.25 + abs(lacking.pivot_to_crank) - lacking.rocker - lacking.coupler)
    text = page.page.inner_text("#error")
    assert text == f"Rocker and coupler cannot close at crank angle 166.8 deg: {missing:.2f} cm are missing"
    error, plot = (page.page.locator(selector).bounding_box() for selector in ("#error", "#power-plot"))
    assert error["y"] + error["height"] <= plot["y"]  # it covers nothing
    marked = page.page.locator(".dimension.outside")
    assert [row.get_attribute("data-name") for row in marked.all()] == ["R2"]
    assert page.page.inner_text("#broken") == ""
    assert page.page.input_value("#angle") == "167"
    assert page.page.locator("#scene .gap:visible").bounding_box()["width"] > 10  # pixels
    assert page.page.inner_text("#power") == "no power"
    page.after(lambda: page.page.click("#undo"))
    assert page.number("power") == first
    assert page.page.is_hidden("#error")
    assert page.page.locator("#scene .gap:visible").count() == marked.count() == 0


def test_a_number_outside_its_range_is_refused_not_replaced(page: Page) -> None:
    first, field = page.number("power"), page.page.locator("#number-R2")
    for typed in ("900", "-3", ""):
        page.type("R2", typed)
        field.press("Enter")
        assert page.page.inner_text(".dimension[data-name=R2] .refusal") == "must be 0.1 to 200 cm"
        assert (field.input_value(), field.get_attribute("aria-invalid")) == (typed, "true")
    assert page.number("power") == first
    page.set("R2", 15)
    assert page.page.locator(".refusal").count() == 0
    assert page.number("power") != first


def test_kind_branch_and_rider(page: Page, tmp_path: Path) -> None:
    page.choose("#kind", "crt")
    assert page.page.locator(".dimension[data-name=gamma]").count() == 0
    page.choose("#branch", "right")
    page.page.select_option("#sex", "female")
    page.page.fill("#percentile", "5")
    page.after(lambda: page.page.click("#take-rider"))
    made, d1 = fes_mj.load_design(page.save(tmp_path)), fes_mj.load_design("d1")
    assert (made.linkage.kind, made.linkage.branch) == ("crt", "right")
    assert made.linkage.crank_centre == pytest.approx(d1.linkage.crank_centre, abs=1e-12)
    assert (made.linkage.rocker, made.linkage.seat_angle) == (d1.linkage.rocker, d1.linkage.seat_angle)
    assert made.rider == populations()["woman"].rider(5)
    page.choose("#kind", "trt")
    assert page.page.is_hidden("#branch")
    assert page.page.locator("#scene .space").count() == 0  # which bounds six-bars


def test_a_link_a_reload_and_the_way_back(page: Page, tmp_path: Path) -> None:
    page.set("R2", 15.5)
    page.choose("#moments", "p1p3")
    page.page.wait_for_timeout(800)
    sent, saved = page.page.url, page.save(tmp_path).read_text()
    power = page.number("power")
    page.after(page.page.go_back)
    assert page.page.input_value("#number-R2") == "16.08"
    page.after(page.page.go_forward)
    assert page.number("power") == power
    page.page.reload()
    page.settled(0)
    assert page.number("power") == power
    page.after(lambda: page.page.click("#undo"))  # as before the reload
    assert page.page.input_value("#number-R2") == "16.08"
    page.open(sent)
    assert page.save(tmp_path).read_text() == saved
    assert (page.number("power"), page.page.input_value("#moments")) == (power, "p1p3")
    for nonsense in ("#{", "#%7B%22design%22:3%7D", "#%ff"):
        page.open(sent.partition("#")[0] + nonsense)
        assert page.page.inner_text("#message").startswith("The address holds no design")
        assert page.page.input_value("#design") == "d1"
    page.saw("400")


def test_load_files(page: Page, tmp_path: Path) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(design_toml(replaced(fes_mj.load_design("r1"), {"R6": 0.1})))
    page.after(lambda: page.page.set_input_files("#open-file", own))
    static = fes_mj.quasi_static(fes_mj.load_design(own), fes_mj.load_moments())
    assert page.number("power") == f"{static.power_mean:.2f}"
    assert page.page.input_value("#design") == "mine"
    bad = tmp_path / "bad.toml"
    bad.write_text("[linkage]\nkind = 'crt'\n")
    page.page.set_input_files("#open-file", bad)
    page.page.wait_for_selector("#message:visible")
    assert page.page.inner_text("#message").startswith("bad.toml: linkage.R1 is missing")
    page.saw("400")  # the browser itself logs a refused question


def test_a_measurement_file_comes_with_what_it_names_and_opens_nothing_else(page: Page, tmp_path: Path) -> None:
    trial, data = tmp_path / "trial.toml", tmp_path / "data.csv"
    trial.write_text('[moments]\nfile = "data.csv"\nextension = {knee = "negative"}\n')
    data.write_text(moments_csv(fes_mj.load_moments("p1p3")))
    page.after(lambda: page.page.set_input_files("#moments-file", [trial, data]))
    assert page.page.input_value("#moments") == "trial"
    static = fes_mj.quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments(trial))
    assert page.number("power") == f"{static.power_mean:.2f}".replace("-", "−")  # noqa: RUF001
    trial.write_text(f'[moments]\nfile = "{data}"\n')
    page.page.set_input_files("#moments-file", trial)
    page.page.wait_for_selector("#message:visible")
    assert page.page.inner_text("#message").startswith("trial.toml: it names 'data.csv'; choose that file too")
    page.saw("400")


def test_limits_can_be_switched_off(page: Page) -> None:
    page.choose("#design", "r2")
    outside = page.page.locator("#numbers tr.outside")
    assert [row.split("\t")[0] for row in outside.all_inner_texts()] == ["Grashof margin"]
    assert "the Grashof margin is 0.06 cm" in page.page.inner_text("#broken")
    assert page.page.locator("#scene .space").count() == 1
    page.page.click("#limits")
    assert outside.count() == page.page.locator("#scene .space").count() == 0
    assert page.page.inner_text("#broken") == ""


@pytest.mark.parametrize("page", [LAPTOP], indirect=True, ids=["laptop"])
def test_verdicts_appear_in_sight(page: Page) -> None:
    page.page.click("text=Simulate")
    page.page.wait_for_selector("#verdict .good")
    assert page.page.inner_text("#verdict p").startswith("Dynamic and static agree: mean power 31.14 W")
    box = page.page.locator("#verdict").bounding_box()
    assert box["y"] + box["height"] <= LAPTOP[1]
    page.page.click("#verdict summary")
    assert page.page.locator("#verdict td.good").count() == page.page.locator("#verdict tbody tr").count()


@pytest.mark.parametrize("curves_first", [True, False])
def test_a_verdict_says_of_what_it_is(page: Page, answers: Answers, curves_first: bool) -> None:
    """Whichever comes first when the design changes meanwhile: its curves, or the verdict of what it was."""
    turn, may_answer = answers.by_name["turn"], threading.Event()

    def wait(question: Section) -> dict[str, Any]:
        may_answer.wait(60)
        return turn(question)

    answers.by_name["turn"] = wait
    page.page.click("text=Simulate")
    page.type("R6", 11)
    before = page.updates
    page.page.press("#number-R6", "Enter")
    if curves_first:
        may_answer.set()
        page.settled(before)
    page.page.wait_for_selector("#verdict details")
    may_answer.set()
    page.settled(before)
    assert page.page.inner_text("#verdict p").startswith("Earlier, of d1: Dynamic and static agree")
    page.after(lambda: page.page.click("#undo"))
    assert page.page.inner_text("#verdict p").startswith("Dynamic and static agree")
    page.choose("#legs", "2")
    assert page.page.inner_text("#verdict p").startswith("Earlier, of d1: ")


def test_a_seat_is_fitted_and_taken(page: Page, tmp_path: Path) -> None:
    page.page.fill("#percentile", "5")
    page.after(lambda: page.page.click("#take-rider"))
    page.page.click("text=Fit the seat")
    page.page.wait_for_selector("#verdict button")
    verdict = page.page.inner_text("#verdict p")
    page.after(lambda: page.page.click("text=Use this design"))
    design, moments = fes_mj.load_design("d1"), fes_mj.load_moments()
    best = fes_mj.fit_seat(design, populations()["man"].rider(5), moments)
    assert best.static
    assert verdict.startswith("Best seat: ")
    assert f"{best.static.power_mean:.2f} W" in verdict
    assert page.number("power").split()[0] == f"{best.static.power_mean:.2f}"
    seated = fes_mj.load_design(page.save(tmp_path)).linkage
    assert seated.ground == pytest.approx(best.design.linkage.ground, abs=1e-9)
    assert page.page.inner_text("#verdict p").startswith("Best seat: ")  # still


def test_a_search_tells_how_far_it_is_and_can_be_cancelled(page: Page) -> None:
    page.page.click("text=Optimise from here")
    page.until(lambda: re.search(r"3\d\.\d\d W so far; 0 of 4 searches", page.page.inner_text("#verdict")) is not None)
    page.set("R6", 11)  # meanwhile
    page.page.click("#cancel")
    page.page.wait_for_selector("#verdict .bad")
    assert page.page.inner_text("#verdict p") == "Earlier, of d1: Cancelled."
    assert page.page.locator("[data-run]:enabled").count() == 4


def test_both_numbers_whatever_drives(page: Page, capsys: pytest.CaptureFixture[str]) -> None:
    _, result = answer(capsys, "static", "d1", "--drive", "muscles")
    rider = "{:.1f} ({:.1f} to {:.1f})".format(result["rider_power_mean_W"], *result["rider_power_interval_W"])
    page.until(lambda: f"as the paper assumes; for a rider {rider} W" in page.page.inner_text("#against"))
    page.choose("#drive", "muscles")
    page.until(lambda: page.page.inner_text("#power") == f"{rider} W")
    cells = page.page.locator("#both tr[data-name=rider] td").all_inner_texts()
    assert "{} ({})".format(*cells[0].split("\n")) == rider
    assert cells[1].split("\n") == ["1.00", "1.00 to 1.00"]  # it is compared with itself
    assert page.page.inner_text("#against") == f"for a rider; as the paper assumes {page.number('power')} W"
    assert page.number("hamstrings") == "{:.0f} to {:.0f}".format(*result["windows_deg"]["hamstrings"])
    assert page.page.locator("[data-curve='p1p2 muscles']").count() == 1
    page.page.reload()  # the address says what drives
    page.settled(0)
    page.until(lambda: page.page.locator("[data-curve='p1p2 muscles']").count() == 1)
    page.choose("#drive", "moments")
    assert page.page.inner_text("#power") == f"{page.number('power')} W"


def test_clearances_and_layers(page: Page) -> None:
    page.until(lambda: page.page.inner_text("#making .verdict") == "feet 186 mm apart")
    page.page.click("#making summary")
    assert page.page.inner_text("#making .layers").startswith("Layer 1: crank, rocker. Layer 2: coupler. ")
    page.page.click("text=105°")  # of the coupler at the crank's centre
    assert page.page.inner_text("#angle-shown") == "105 deg"
    page.set("R2", 25)  # turns no more
    assert page.page.is_hidden("#making")
    page.choose("#design", "r2")
    page.until(lambda: page.page.inner_text("#making .bad").startswith("no pin in stock bears the "))


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
    assert re.fullmatch(r"31\.\d\d W", page.page.inner_text("#power"))
    page.set("R10", 20)
    assert page.page.inner_text("#against").startswith("d1 as loaded: 31.")


# Contrast as WCAG 2 defines it, of every text that is shown against the first background behind it.
FAINT_TEXTS = """() => {
    const parts = (colour) => colour.match(/[\\d.]+/g).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((v) => v / 255)
        .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
        .reduce((sum, v, n) => sum + v * [0.2126, 0.7152, 0.0722][n], 0);
    const behind = (node) => {
        for (; node; node = node.parentElement) {
            const [r, g, b, a = 1] = parts(getComputedStyle(node).backgroundColor);
            if (a > 0) return [r, g, b];
        }
        return [255, 255, 255];
    };
    const faint = [];
    for (const node of document.querySelectorAll("body *")) {
        const own = [...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim());
        if (!(own || node.matches("input[type=number], select"))) continue;
        if (!node.getClientRects().length || node.disabled) continue;
        const style = getComputedStyle(node);
        const [one, other] = [light(parts(node.closest("svg") ? style.fill : style.color)), light(behind(node))];
        const contrast = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
        if (contrast < 4.5) faint.push(`${node.textContent.trim()} ${contrast.toFixed(2)}`);
    }
    return faint;
}"""
NAMELESS = """() => {
    const labels = (node) => [...(node.labels ?? [])].map((label) => label.textContent).join("");
    const content = (node) => (node.matches("button, summary") ? node.textContent : "");
    return [...document.querySelectorAll("button, input, select, svg[role], summary")]
        .filter((node) => node.getClientRects().length)
        .filter((node) => !((node.getAttribute("aria-label") ?? "") + labels(node) + content(node)).trim())
        .map((node) => node.outerHTML);
}"""


@pytest.mark.parametrize("page", SCREENS, indirect=True)
def test_everything_has_a_name_and_can_be_read(page: Page) -> None:
    page.page.click("text=Simulate")
    page.page.wait_for_selector("#verdict details")
    page.page.click("#verdict summary")
    for design, crank in (("r2", 15), ("d1", 25)):  # outside a limit; one that does not turn
        page.choose("#design", design)
        page.set("R2", crank)
        page.type("R6", 900)
        page.page.press("#number-R6", "Enter")
        assert page.page.evaluate(FAINT_TEXTS) == []
        assert page.page.evaluate(NAMELESS) == []
    assert page.page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_by_keyboard_alone(page: Page) -> None:
    """Every control is reached by the tabulator key, and seen when it is."""
    controls = "main :is(button, input, select):not(:disabled)"
    count = page.page.locator(controls).evaluate_all("nodes => nodes.filter(n => n.getClientRects().length).length")
    reached = set()
    for _ in range(count):
        page.page.keyboard.press("Tab")
        reached.add(page.page.evaluate("[...document.querySelectorAll('*')].indexOf(document.activeElement)"))
        assert page.page.evaluate("document.activeElement.matches(':focus-visible')")
    assert len(reached) == count

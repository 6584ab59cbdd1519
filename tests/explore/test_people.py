"""Several people at the page at once, and a server that is asked much, or is gone."""

from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.explore.answers import Answers
from fes_mj.explore.server import Server
from fes_mj.moments.files import moments_csv
from tests.browser import NEEDS_BROWSER, browser
from tests.explore.browsing import Page, page, running, server

__all__ = ["browser", "page", "server"]  # fixtures

pytestmark = NEEDS_BROWSER


def test_two_browsers_with_files_of_the_same_name(browser: Any, server: Server, tmp_path: Path) -> None:
    pages = [Page(browser.new_context().new_page(), server.address) for _ in range(2)]
    for place, one in enumerate(pages):
        file = tmp_path / str(place) / "trial.csv"
        file.parent.mkdir()
        file.write_text(moments_csv(fes_mj.load_moments(("p1p2", "p1p3")[place])))
        one.after(lambda one=one, file=file: one.page.set_input_files("#moments-file", file))
    design = fes_mj.load_design("d1")
    for one, group in zip(pages, ("p1p2", "p1p3"), strict=True):
        one.choose("#legs", "2")  # another question
        assert one.page.input_value("#moments") == "trial"
        assert one.page.locator("#moments option").all_inner_texts() == ["p1p2", "p1p3", "trial"]
        power = fes_mj.quasi_static(design, fes_mj.load_moments(group)).power_mean
        assert one.number("power") == f"{power:.2f}"
        one.page.reload()  # keeps what it has opened
        one.settled(0)
        assert one.page.input_value("#moments") == "trial"
        assert one.number("power") == f"{power:.2f}"
        assert one.wrong == []
        one.page.context.close()


def test_fifty_questions_at_once(page: Page) -> None:
    """From one page, beside the page's own."""
    script = """async () => {
        const { ask } = await import("./server.js"), { designs } = await ask("start");
        const answers = await Promise.all(Array.from({ length: 50 }, () => ask("turn", { design: designs.d2 })));
        return answers.map(({ moments }) => moments.p1p2.power_mean_W);
    }"""
    power = fes_mj.quasi_static(fes_mj.load_design("d2"), fes_mj.load_moments()).power_mean
    assert page.page.evaluate(script) == pytest.approx([power] * 50, rel=1e-12)


def test_an_answer_that_fails_is_no_end(page: Page, answers: Answers) -> None:
    def fail(_: Any) -> dict[str, Any]:
        raise KeyError("nobody thought of this")

    answers.by_name["save"] = fail
    page.page.click("#save")
    page.page.wait_for_selector("#message:visible")
    message = page.page.inner_text("#message")
    assert "nobody thought of this" in message
    assert "ended" not in message
    page.set("R2", 15)
    assert page.page.is_hidden("#message")
    page.saw("500")


def test_that_it_has_ended_is_said_when_it_has(browser: Any, answers: Answers) -> None:
    with running(Server(answers, "127.0.0.1", 0)) as server:
        page = Page(browser.new_page(), server.address)
    page.page.click("#save")
    page.page.wait_for_selector("#message:visible")
    assert page.page.inner_text("#message").startswith("fes_mj explore has ended")
    page.page.close()


def test_the_address_without_its_token_says_what_is_missing(browser: Any, server: Server) -> None:
    page = browser.new_page()
    page.goto(server.address.partition("?")[0])
    page.wait_for_selector("#message:visible")
    assert "open the address that fes_mj explore has printed" in page.inner_text("#message")
    page.close()


def test_scripts_of_others_are_not_run(page: Page) -> None:
    """Whatever got into the page: its policy lets only the page's own files be scripts."""
    page.page.evaluate("""document.body.insertAdjacentHTML("beforeend", "<img src=x onerror='window.caught = 1'>")""")
    page.page.wait_for_timeout(300)
    assert page.page.evaluate("window.caught") is None
    assert len(page.wrong) == 2  # the image, and the handler
    page.wrong.clear()


def test_moments_that_the_server_has_forgotten(page: Page, answers: Answers, tmp_path: Path) -> None:
    file = tmp_path / "trial.csv"
    file.write_text(moments_csv(fes_mj.load_moments("p1p3")))
    page.after(lambda: page.page.set_input_files("#moments-file", file))
    page.until(lambda: "…" not in page.page.inner_text("#both") + page.page.inner_text("#making"))  # all is answered
    answers.uploads.__init__()  # type: ignore[misc]
    page.set("R2", 15.5)
    assert page.page.inner_text("#message") == "trial is no longer known; open its file again"
    assert page.page.input_value("#moments") == "p1p2"

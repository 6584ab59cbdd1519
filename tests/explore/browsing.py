"""The page, open in a browser: what tests do with it and read from it."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from fes_mj.explore.answers import Answers
from fes_mj.explore.server import Server
from tests.browser import DESKTOP

PATIENCE = 60_000  # ms


class Page:
    """A page that is open, and everything that went wrong in it."""

    def __init__(self, page: Any, address: str) -> None:
        self.page, self.wrong = page, []
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: self.wrong.append(str(error)))
        page.on("console", lambda message: self.wrong.append(message.text) if message.type == "error" else None)
        self.open(address)

    def open(self, address: str) -> None:
        """Go to an address, which makes a new page of it."""
        self.page.goto("about:blank")
        self.page.goto(address)
        self.settled(0)

    def after(self, action: Callable[[], Any]) -> None:
        """Do something upon which the page shows another answer, and wait for that."""
        before = self.updates
        action()
        self.settled(before)

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
        self.type(name, value)
        self.after(lambda: self.page.press(f"#number-{name}", "Enter"))

    def type(self, name: str, value: object) -> None:
        self.page.fill(f"#number-{name}", str(value))

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
        self.after(lambda: self.page.select_option(select, value))

    def saw(self, *messages: str) -> None:
        """These went wrong, as was wanted, and nothing else."""
        assert len(self.wrong) == len(messages)
        assert all(message in text for message, text in zip(messages, self.wrong, strict=True))
        self.wrong.clear()


@contextmanager
def running(server: Server) -> Iterator[Server]:
    thread = threading.Thread(target=server.run)
    thread.start()
    yield server
    server.should_exit = True
    thread.join()


@pytest.fixture
def server(answers: Answers) -> Iterator[Server]:
    with running(Server(answers, "127.0.0.1", 0)) as server:
        yield server


@pytest.fixture(params=[DESKTOP], ids=["desktop"])
def page(browser: Any, server: Server, request: pytest.FixtureRequest) -> Iterator[Page]:
    width, height = request.param
    opened = browser.new_page(viewport={"width": width, "height": height})
    page = Page(opened, server.address)
    yield page
    opened.close()
    assert not page.wrong, page.wrong

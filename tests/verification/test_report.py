"""The report of a full run, and its verdicts as JUnit XML: complete, without need of a network."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from fes_mj.cli.app import run
from fes_mj.common.checks import definitions
from fes_mj.verification.mistakes import faults
from tests.browser import NEEDS_BROWSER, browser, check_on_a_phone

__all__ = ["browser"]  # the fixture


class _Page(HTMLParser):
    """Text, tags and addresses of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []
        self.count: dict[str, int] = {}

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        # xlink:href="#..." points into the same figure
        self.addresses += [value or "" for name, value in attributes if name in ("src", "href", "xlink:href")]


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Report and JUnit file of a full run of one design with faults and a video."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "run.mp4").write_bytes(b"not a real video")
    files = {"html": folder / "out.html", "xml": folder / "out.xml"}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fes_mj.verification.mistakes.faults", lambda: faults()[:3])  # all of them: test_faults.py
        outputs = ["--report", str(files["html"]), "--junit", str(files["xml"])]
        code = run(["validate", "d1", "-q", "--faults", *outputs, "--video", str(folder / "run.mp4")])
    assert code == 0
    return {name: path.read_text() for name, path in files.items()}


@pytest.mark.long
def test_the_report_needs_no_network(report: dict[str, str]) -> None:
    page = _Page()
    page.feed(report["html"])
    assert all(address.startswith(("#", "data:")) for address in page.addresses)
    assert not {"script", "link", "iframe", "img"} & set(page.count)
    assert not re.search(r"@import|url\((?!#)", report["html"])


@pytest.mark.long
def test_the_report_opens_with_the_verdict_and_shows_everything(report: dict[str, str]) -> None:
    page = _Page()
    page.feed(report["html"])
    text = re.sub(r"<[^>]*>", " ", report["html"].split("<body>")[1])
    order = [
        text.index(word) for word in ("checks hold", "Runs", "d1 p1p2", "Crank power over", "Provenance", "python")
    ]
    assert order == sorted(order)
    assert page.count["svg"] == 2 + 2 + 1  # power and refinement of two groups, the chain
    assert page.count["video"] == 1
    assert "data:video/mp4;base64,bm90IGEgcmVhbCB2aWRlbw==" in report["html"]
    assert {name for name in definitions() if name not in text} == {"muscle_moments", "muscle_activation"}
    assert "knee moment on the shank" in text
    assert "(to 10 W at least)" in text  # units keep their capitals
    assert text.count("exact, mW") == 2  # what the curves that coincide differ by
    assert 'name="viewport"' in report["html"]


@pytest.mark.long
def test_junit_counts_every_verdict(report: dict[str, str]) -> None:
    suites = ElementTree.fromstring(report["xml"]).findall("testsuite")
    assert {suite.get("name") for suite in suites} >= {"d1 p1p2", "d1 p1p3", "A02", "injected faults"}
    for suite in suites:
        assert int(suite.get("tests", -1)) == len(suite.findall("testcase"))
        assert suite.get("failures") == "0"


class TestOnAPhone:
    """Of the report in a browser as wide as a phone."""

    pytestmark = NEEDS_BROWSER

    def test_the_report_fits(self, browser: Any, report: dict[str, str], tmp_path: Path) -> None:
        (file := tmp_path / "report.html").write_text(report["html"], encoding="utf-8")
        check_on_a_phone(browser, file)

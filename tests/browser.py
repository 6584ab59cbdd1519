"""A real browser for pages: Debian's Chromium, or what CHROMIUM names, driven by Playwright; skipped where none is."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed: pip install playwright")
CHROMIUM = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
NEEDS_BROWSER = [
    pytest.mark.process,
    pytest.mark.skipif(not CHROMIUM, reason="there is no Chromium: apt-get install chromium, or name one by CHROMIUM"),
]
DESKTOP, LAPTOP, PHONE = (1920, 1080), (1280, 800), (390, 844)
SCREENS = (DESKTOP, LAPTOP, PHONE)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])  # CI runs as root
        yield browser
        browser.close()


def check_on_a_phone(browser: Any, file: Path) -> None:
    """Plots of a page fill a phone's width, with text that can be read, and no table runs off the screen."""
    width, height = PHONE
    page = browser.new_page(viewport={"width": width, "height": height})
    page.goto(file.as_uri())
    page.evaluate("document.querySelectorAll('details').forEach(box => box.open = true)")
    assert page.evaluate("document.documentElement.scrollWidth") == width
    for plot in page.locator("svg").all():
        assert plot.bounding_box()["width"] > 0.85 * width
        sizes = plot.evaluate("svg => [...svg.querySelectorAll('text')].map(t => t.getBoundingClientRect().height)")
        assert min(size for size in sizes if size) > 8  # pixels
    outside = "t => t.getBoundingClientRect().right > innerWidth && !t.closest('.scroll')"
    assert page.evaluate(f"[...document.querySelectorAll('table')].filter({outside}).length") == 0
    page.close()

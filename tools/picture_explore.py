"""Make the picture of the designer's page, docs/images/explore.png: python -m tools.picture_explore"""

import shutil
import threading
from pathlib import Path

from playwright.sync_api import sync_playwright

import fes_mj
from fes_mj.explore.answers import Answers
from fes_mj.explore.server import Server

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "explore.png"
SIZE = {"width": 1280, "height": 800}
CRANK = 15.0  # cm instead of D1's 16.1, so that there is a difference to see
ANGLE = 215  # deg, at which leg and linkage do not hide each other


def main() -> None:
    """Open the page in Chromium, shorten D1's crank, and keep what is seen."""
    answers = Answers(fes_mj.load_design("d1"), fes_mj.load_moments())
    server = Server(answers, "127.0.0.1", 0)
    threading.Thread(target=server.run, daemon=True).start()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport=SIZE)
        page.goto(server.address)
        page.wait_for_selector("body[data-updates='1']")
        page.fill("#number-R2", str(CRANK))
        page.press("#number-R2", "Enter")
        page.wait_for_selector("body[data-updates='2']")
        page.wait_for_selector("#making .verdict:has-text('apart')")
        page.wait_for_selector("#both tr[data-name=rider]:not(:has-text('…'))")
        page.fill("#angle", str(ANGLE))
        page.evaluate("document.activeElement.blur()")
        page.screenshot(path=PICTURE)
        browser.close()


if __name__ == "__main__":
    main()

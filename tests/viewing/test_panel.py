"""The panel beside a video's pictures: what is written stays inside it, and says what agrees."""

from dataclasses import replace

import pytest

import fes_mj

pytest.importorskip("matplotlib")
pytest.importorskip("PIL")
from matplotlib.figure import Figure

from fes_mj.viewing.panel import agreement, write_title, write_verdict


@pytest.mark.parametrize("name", ["d1", "a-design-with-a-name-that-somebody-made-of-all-its-dimensions-2026-11-26"])
def test_titles_stay_inside(name: str) -> None:
    figure = Figure(figsize=(5.6, 7.2), dpi=100)
    write_title(figure, replace(fes_mj.load_design("d1"), name=name), "joint moments of " + name)
    write_verdict(figure, f"check failed: {name}", good=False)
    for line in figure.texts:
        box = line.get_window_extent()
        assert 0 <= box.x0 < box.x1 <= figure.bbox.width
        assert name in line.get_text().lower()  # shrunk, not cut


def test_the_verdict_is_of_the_means_with_their_difference() -> None:
    case = fes_mj.Case(fes_mj.load_design("r1"), fes_mj.load_moments())
    assert agreement(case) == f"mean power agrees: difference {case.difference_text}"
    coarse = fes_mj.Case(fes_mj.load_design("r2"), fes_mj.load_moments(), timestep=4e-3)
    failed = [check.name.replace("_", " ") for check in coarse.checks if not check.ok]
    assert failed
    assert agreement(coarse) == f"check failed: {', '.join(failed)}"

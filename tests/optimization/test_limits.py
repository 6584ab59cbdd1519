"""Problem files: the design space they enclose, and what is refused with which words."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.limits import DEFAULT, depth_inside, load_limits


def test_depth_inside_a_polygon() -> None:
    square = np.array([0, 1, 1 + 1j, 1j])
    points = np.array([0.5 + 0.5j, 0.1 + 0.4j, -0.2 + 0.5j, 2 + 2j])
    assert depth_inside(square, points) == pytest.approx([0.5, 0.1, -0.2, -np.sqrt(2)])
    notched = np.array([0, 2, 2 + 2j, 1 + 1j, 2j])
    # above the notch's tip: the nearest border is its slope; below it: the tip itself
    assert depth_inside(notched, np.array([1 + 1.5j, 1 + 0.9j])) == pytest.approx([-0.5 / np.sqrt(2), 0.1])
    assert depth_inside(square[::-1], points) == pytest.approx([0.5, 0.1, -0.2, -np.sqrt(2)])


def test_a_pivot_on_the_edge_is_inside() -> None:
    """On every edge and corner of the default space, whatever rounding makes of its distance."""
    polygon = load_limits().polygon
    ends, parts = np.roll(polygon, -1), np.linspace(0, 1, 41)
    edges = (polygon[:, None] + parts * (ends - polygon)[:, None]).ravel()
    assert depth_inside(polygon, np.array([*edges, -0.60 + 0.20j])).min() >= 0


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("knee_deg = [69.0, 122.0]", "knee_deg = [122.0, 69.0]", "limits.knee_deg is [122.0, 69.0]; the bounds"),
        ("crank_min = 0.025", "crank_min = 'short'", "limits.crank_min is 'short'; it must be a number"),
        ("crank_min = 0.025", "", "limits.crank_min is missing"),
        ("crank_min", "crank_mni", "unknown key limits.crank_mni; allowed here: crank_min"),
        ("[-1.25, 0.10], [-0.60, 0.10], ", "", "encloses no area"),
        ("[search]", "[look]", "unknown key look"),
    ],
)
def test_a_bad_problem_file_is_one_message(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = DEFAULT.read_text()
    assert old in text
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(fes_mj.InputError) as refused:
        load_limits(path)
    assert str(refused.value).startswith(f"{path}: ")
    assert said in str(refused.value)

"""The picture of a sweep: one line for each design and moments, or every point in its colour."""

from pathlib import Path

import numpy as np
import pytest

from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep

pytest.importorskip("pyarrow")
pytest.importorskip("matplotlib")


def columns(tmp_path: Path, grid: str) -> tuple[Sweep, dict[str, np.ndarray]]:
    study = tmp_path / "study.toml"
    study.write_text(f"[grid]\n{grid}\n")
    sweep = Sweep(load_study(study), tmp_path / "out")
    sweep.run()
    return sweep, {name: sweep.read()[name].to_numpy() for name in sweep.read().column_names}


def test_a_line_for_each_design_and_moments(tmp_path: Path) -> None:
    from matplotlib.figure import Figure

    from fes_mj.sweep import plot

    _, rows = columns(tmp_path, 'design = ["d1", "r2"]\nseat_angle = [40, 20, 30]')
    axes = Figure().subplots()
    plot._lines(axes, rows, "seat_angle")
    assert [line.get_label() for line in axes.lines] == ["d1, p1p2", "r2, p1p2"]
    for line, design in zip(axes.lines, ("d1", "r2"), strict=True):
        own = rows["design"] == design
        order = np.argsort(rows["seat_angle"][own])
        assert np.array_equal(line.get_xdata(), [20, 30, 40])
        assert np.array_equal(line.get_ydata(), rows["power_mean_W"][own][order])


def test_a_map_has_every_point_once(tmp_path: Path) -> None:
    from matplotlib.figure import Figure

    from fes_mj.sweep import plot

    sweep, rows = columns(tmp_path, 'design = ["d1"]\nR2 = [0.15, 0.16, 0.18]\nseat_angle = [20, 30]')
    axes = Figure().subplots()
    plot._map(axes, rows, "R2", "seat_angle")
    none, known = (np.asarray(collection.get_offsets()) for collection in axes.collections)
    assert {tuple(point) for point in none} == {(0.18, 20), (0.18, 30)}
    assert {tuple(point) for point in known} == {(0.15, 20), (0.15, 30), (0.16, 20), (0.16, 30)}
    plot.write_plot(sweep, tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")

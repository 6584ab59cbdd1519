"""Figures: curves over a turn close, residuals are those of the checks, every figure has its caption."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.reading import DATA, read_toml
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.reproduce import figures_page
from fes_mj.paper.runs import Runs

pytest.importorskip("matplotlib")
from matplotlib.axes import Axes

from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.figures import FIGURES
from fes_mj.paper.known import Known, known

RESULTS = Path(__file__).parents[2] / "results"


@pytest.fixture(scope="module")
def facts() -> Known:
    return known(load_evidence())


@pytest.fixture(scope="module")
def runs(facts: Known) -> Runs:
    """What the figures over a turn need."""
    runs = Runs(facts, static={}, printed={}, dynamic={}, answers={}, people={}, rides=[], budgets={}, readings={})
    for name in ("trt", "r2", "d1"):
        for group in RIDER_GROUPS:
            design, moments = fes_mj.load_design(name), fes_mj.load_moments(group)
            runs.static[name, group] = fes_mj.quasi_static(design, moments)
            for legs in (1, 2):
                runs.dynamic[name, group, legs] = fes_mj.Case(design, moments, legs=legs)
    return runs


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    [
        "figure-01-moments-over-crank",
        "figure-04-power-of-the-trt",
        "figure-12-power-of-r2-and-d1",
        "smoothness-with-masses",
    ],
)
def test_curves_over_a_turn_close(name: str, runs: Runs) -> None:
    for axes in FIGURES[name](runs).axes:
        assert isinstance(axes, Axes)
        assert axes.get_xlim() == (0, 360)
        curves = [np.array(line.get_data(), float) for line in axes.lines if len(np.atleast_1d(line.get_xdata())) > 2]
        assert curves
        for angle, value in curves:
            assert angle[-1] - angle[0] == pytest.approx(360)
            assert angle[0] < 360 / 40  # of the fewest points
            assert value[-1] == pytest.approx(value[0], abs=1e-9)


@pytest.mark.long
def test_residuals_are_those_of_the_checks(runs: Runs) -> None:
    """The last row of Figure 4: nearly massless and with all masses, as `inverse_dynamics` and `massless_statics`."""
    for axes, group in zip(FIGURES["figure-04-power-of-the-trt"](runs).axes[-2:], RIDER_GROUPS, strict=True):
        assert isinstance(axes, Axes)
        checks = {check.name: check.value for check in runs.dynamic["trt", group, 1].checks}
        drawn = [np.array(line.get_ydata(), float)[:-1] for line in axes.lines if len(np.array(line.get_ydata())) > 2]
        rms = [float(np.sqrt(np.mean(curve**2))) for curve in drawn]
        assert rms == pytest.approx(
            [checks["massless_statics"], checks["inverse_dynamics"]], rel=0.02
        )  # every nth step


def test_every_figure_has_its_caption() -> None:
    captions = read_toml(DATA / "captions.toml", "captions").section("figure").content
    assert [*captions] == [*FIGURES]
    assert (RESULTS / "figures.md").read_text(encoding="utf-8") == figures_page()

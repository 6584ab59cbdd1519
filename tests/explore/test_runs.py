"""Runs say what the commands say."""

from functools import partial
from pathlib import Path

import pytest

import fes_mj
from fes_mj.common.checks import Check
from fes_mj.common.units import KMH
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.explore import runs
from fes_mj.explore.dimensions import design_of
from fes_mj.fit.seat import fit_seat, seat_text
from fes_mj.linkage.design import Rider
from fes_mj.muscles.drive import load_muscles
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.timing import DUTY
from fes_mj.optimization.problem import make_problem
from fes_mj.optimization.stimulated import MuscleDrive
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.stimulated import stimulated_rider

D1, P1P2 = fes_mj.load_design("d1"), fes_mj.load_moments()


def test_simulate(tmp_path: Path) -> None:
    case = fes_mj.Case(D1, P1P2)
    run = runs.simulate(D1, P1P2, tmp_path, legs=1)
    assert run["ok"]
    assert f"mean power {case.simulation.power_mean:.2f} W" in run["verdict"]
    assert {check.name.replace("_", " ") for check in case.checks} < {row["name"] for row in run["checks"]}
    assert all(row["ok"] for row in run["checks"])


@pytest.mark.long
def test_simulate_by_muscles(tmp_path: Path) -> None:
    case = fes_mj.Case(D1, load_muscles("p1p2"))
    run = runs.simulate(D1, load_muscles("p1p2"), tmp_path, legs=1)
    assert run["ok"]
    assert f"mean power {case.simulation.power_mean:.2f} W" in run["verdict"]
    assert run["verdict"].endswith("by the muscles of the most probable rider of p1p2.")


def test_a_check_that_fails_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.crosscheck.turn_case.check", lambda name, value, _: Check(name, value, limit=0.0))
    run = runs.simulate(D1, P1P2, tmp_path, legs=1)
    assert not run["ok"]
    assert run["verdict"].startswith("Dynamic and static do not agree (")


@pytest.mark.parametrize("drive", ["moments", "muscles"])
def test_ride(drive: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "Ride", partial(Ride, duration=2.0))
    muscles = fes_mj.load_muscles("p1p2")
    moving = P1P2 if drive == "moments" else stimulated_rider(muscles, D1)
    case = RideCase(Ride(D1, moving, Road(slope=0.02), transmission="fixed", duration=2.0))
    run = runs.ride(D1, muscles if drive == "muscles" else P1P2, tmp_path, transmission="fixed", slope=2)
    assert run["ok"] == case.agrees
    speed = case.simulation.trace.mean_speed
    assert speed is None or f"{speed / KMH:.2f} km/h at the end" in run["verdict"]
    assert [row["ok"] for row in run["checks"]] == [check.ok for check in case.checks]


@pytest.mark.usefixtures("coarse_seats")
def test_fit(tmp_path: Path) -> None:
    small = D1.with_rider(thigh=0.45, shank=0.47, mass=62, sex="female")
    best = fit_seat(D1, Rider(0.45, 0.47, 62, "female"), P1P2)
    run = runs.fit(small, P1P2, tmp_path)
    assert seat_text(best.seat).replace("-", "\N{MINUS SIGN}") in run["verdict"]
    seated = fes_mj.quasi_static(design_of(run["design"]), P1P2)
    assert best.static
    assert seated.power_mean == pytest.approx(best.static.power_mean, rel=1e-12)
    giant = runs.fit(D1.with_rider(thigh=0.9, shank=0.9), P1P2, tmp_path)
    assert not giant["ok"]
    assert "design" not in giant


def test_optimise(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert runs.progress(tmp_path) is None
    monkeypatch.setattr(runs, "optimize", partial(fes_mj.optimize, budget=300))
    r1 = fes_mj.load_design("r1")
    run = runs.optimise(r1, P1P2, tmp_path)
    best, problem = design_of(run["design"]), make_problem("crt", P1P2, start="r1", compared_with="r1")
    evaluation = problem.evaluate(problem.variables(best)[None])
    assert evaluation.feasible.all()
    assert f"{evaluation.power[0, 0]:.2f} W" in run["verdict"]
    assert evaluation.power[0, 0] >= problem.evaluate(problem.variables(r1)[None]).power[0, 0]
    assert runs.progress(tmp_path) == f"{evaluation.power[0, 0]:.2f} W so far; 4 of 4 searches are through"


def test_optimise_for_muscles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "optimize", partial(fes_mj.optimize, budget=12))
    monkeypatch.setattr(runs, "SEARCHES", 1)
    run = runs.optimise(fes_mj.load_design("r1"), load_muscles("p1p2"), tmp_path)
    best, muscles = design_of(run["design"]), MuscleDrive(load_riders("p1p2"), DUTY)
    problem = make_problem("crt", P1P2, start="r1", compared_with="r1", muscles=muscles)
    evaluation = problem.evaluate(problem.variables(best)[None])
    assert evaluation.feasible.all()
    assert f"{evaluation.power[0, 0]:.2f} W" in run["verdict"]

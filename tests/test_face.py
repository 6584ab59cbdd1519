"""The public names: each has an example that runs, and results show themselves in a line."""

import ast
import doctest
import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


SLOW = ("fit_population",)
NAMES = [pytest.param(name, marks=[pytest.mark.long] * (name in SLOW)) for name in fes_mj.__all__]


@pytest.mark.parametrize("name", NAMES)
def test_example(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = {"fes_mj": fes_mj, "math": math, "np": np, "folder": tmp_path}
    document = getattr(fes_mj, name).__doc__
    test = doctest.DocTestParser().get_doctest(document, given, name, None, None)
    assert test.examples, f"{name} has no example"
    failed, _ = doctest.DocTestRunner(optionflags=OPTIONS).run(test)
    assert not failed, capsys.readouterr().out


def test_names_are_imported_from_where_they_are_defined() -> None:
    """Type checkers and Python read one list, the stub; no name in it is another module's."""
    assert {name: getattr(fes_mj, name).__module__ for name in fes_mj.__all__} == fes_mj._modules()
    assert {*fes_mj.__all__} <= {*dir(fes_mj)}


def test_the_page_of_the_names_has_them_all() -> None:
    page = (Path(__file__).parents[1] / "docs/python.md").read_text()
    assert [name for name in fes_mj.__all__ if f"   {name}\n" not in page] == []


def test_whatever_a_name_gives_shows_itself_in_a_line() -> None:
    """What an example does not show too: batches, drives, and results that others hold."""
    design, moments, muscles = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), fes_mj.load_muscles("p1p2")
    batch = design.with_linkage(crank=np.full((1000, 1), 0.15))
    turn, case = fes_mj.quasi_static(design, moments), fes_mj.Case(design, moments)
    ride = fes_mj.Ride(design, moments, duration=1.0)
    one = fes_mj.stimulated_rider(muscles, design)
    pulled = fes_mj.simulate(design, muscles)
    results: list[object] = [
        *(design, design.rider, batch, kinematics.solve(batch), moments, moments.measured_on, muscles, muscles.riders),
        *(turn, turn.motion, turn.torque, case, case.steps, fes_mj.simulate(design, moments), pulled, pulled.torque),
        *(ride, fes_mj.ride(ride), fes_mj.RideCase(ride), fes_mj.RideCase(ride).simulation, fes_mj.starts(ride, 4)),
        *(one, one.riders, *fes_mj.stimulation(design), fes_mj.answer(design, [turn], muscles.riders)),
        *(fes_mj.fit_seat(design, design.rider, moments), fes_mj.build_mjcf(design)),
    ]
    shown = [repr(result) for result in results]
    assert [text for text in shown if len(text) > 200 or "\n" in text or "fes_mj." in text] == []
    assert repr(design) == "<Design d1: cdt>"
    assert repr(batch) == "<Design d1: cdt, a batch of 1000>"


PACKAGE = Path(fes_mj.__file__).parent
LIBRARY = [path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).parts[0] not in ("cli", "explore")]


def words(path: Path) -> Iterator[str]:
    """What a module says, without docstrings; a value in the middle is left out."""
    tree = ast.parse(path.read_text())
    for parent in ast.walk(tree):
        for node in ast.iter_child_nodes(parent):
            if isinstance(node, ast.JoinedStr):
                yield "".join(part.value for part in node.values if isinstance(part, ast.Constant))
            elif isinstance(node, ast.Constant) and not isinstance(parent, ast.JoinedStr | ast.Expr):
                yield str(node.value)


def test_what_the_library_says_names_no_options() -> None:
    """Who calls it from Python has none; a whole command in backticks, as the way out, is understood by everybody."""
    named = [text for path in LIBRARY for text in words(path) if re.search("--[a-z]", re.sub("`[^`]*`", "", text))]
    assert named == []


D1, P1P2 = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")
BATCH, MUSCLES, RIDE = D1.with_linkage(crank=np.full((3, 1), 0.15)), fes_mj.load_muscles(), fes_mj.Ride(D1, P1P2)
NO_BATCHES = {
    "answer": lambda: fes_mj.answer(BATCH),
    "quasi_static": lambda: fes_mj.quasi_static(BATCH, P1P2),
    "simulate": lambda: fes_mj.simulate(BATCH, P1P2),
    "Case": lambda: fes_mj.Case(BATCH, P1P2),
    "build_mjcf": lambda: fes_mj.build_mjcf(BATCH),
    "export": lambda: fes_mj.export(BATCH, P1P2, "d1.xml"),
    "ride": lambda: fes_mj.ride(fes_mj.Ride(BATCH, P1P2)),
    "starts": lambda: fes_mj.starts(fes_mj.Ride(BATCH, P1P2)),
    "RideCase": lambda: fes_mj.RideCase(fes_mj.Ride(BATCH, P1P2)).simulation,
    "stimulated_rider": lambda: fes_mj.stimulated_rider(MUSCLES, BATCH),
    "stimulation": lambda: fes_mj.stimulation(BATCH),
    "fit_seat": lambda: fes_mj.fit_seat(BATCH, D1.rider, P1P2),
    "fit_population": lambda: fes_mj.fit_population(BATCH, P1P2),
}


@pytest.mark.parametrize("case", NO_BATCHES)
def test_a_batch_is_refused_where_one_design_is_asked_for(case: str) -> None:
    with pytest.raises(fes_mj.InputError, match=r"^d1: a batch of designs; .*single\(row\)"):
        NO_BATCHES[case]()


NO_RUNS = {
    "timestep 0": lambda: fes_mj.simulate(D1, P1P2, timestep=0),
    "timestep -1": lambda: fes_mj.build_mjcf(D1, timestep=-1),
    "timestep 10": lambda: fes_mj.Case(D1, P1P2, timestep=10).simulation,
    "turns 0": lambda: fes_mj.simulate(D1, P1P2, turns=0),
    "turns nan": lambda: fes_mj.simulate(D1, P1P2, turns=math.nan),
    "points 0": lambda: fes_mj.quasi_static(D1, P1P2, points=0),
    "cadence nan": lambda: fes_mj.Case(D1, P1P2, cadence=math.nan),
    "duration 0": lambda: fes_mj.ride(fes_mj.Ride(D1, P1P2, duration=0)),
    "duration inf": lambda: fes_mj.RideCase(fes_mj.Ride(D1, P1P2, duration=math.inf)).simulation,
    "launch nan": lambda: fes_mj.ride(fes_mj.Ride(D1, P1P2, launch=math.nan)),
    "slope nan": lambda: fes_mj.ride(fes_mj.Ride(D1, P1P2, fes_mj.Road(slope=math.nan))),
    "rolling_mass -1": lambda: fes_mj.ride(fes_mj.Ride(D1, P1P2, fes_mj.Road(rolling_mass=-1))),
    "angles 0": lambda: fes_mj.starts(RIDE, angles=0),
    "cadence 0": lambda: fes_mj.answer(D1, cadence=0),
    "duty nan": lambda: fes_mj.answer(D1, duty=math.nan),
    "duty 2": lambda: fes_mj.load_muscles(duty=2),
    "draws 1": lambda: fes_mj.error_budget(draws=1),
}


@pytest.mark.parametrize("case", NO_RUNS)
def test_a_number_that_no_run_has_is_refused_by_name_and_value(case: str) -> None:
    name, value = case.split()
    with pytest.raises(fes_mj.InputError, match=rf"{name} is {value}\b"):
        NO_RUNS[case]()

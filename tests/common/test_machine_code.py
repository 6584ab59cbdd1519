"""Functions in machine code: the same numbers without numba, kept on disk, made anew after a change anywhere."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest

from fes_mj.common.machine_code import kept_machine_code

WITHOUT = "import sys; sys.modules['numba'] = None\n"
RIDE = """
import fes_mj, numpy as np
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import ride
from fes_mj.simulation.road import ride_on_road
one = Ride(fes_mj.load_design("d2"), fes_mj.load_moments("p1p2"), duration=1.5)
for trace in (ride(one), ride_on_road(one).trace):
    print(*(repr(float(column[-1])) for column in (trace.crank_angle, trace.speed, trace.muscle_work, trace.road_work)))
print("numba" in sys.modules)
"""
INNER = """
from fes_mj.common.machine_code import machine_code

@machine_code
def factor(value):
    return 2.0 * value
"""
OUTER = """
from inner import factor
from fes_mj.common.machine_code import kept_machine_code

@kept_machine_code()
def outer(value):
    return factor(value)

print(outer(1.0), sum(outer.stats.cache_hits.values()))
"""


def run(code: str, **environment: str) -> list[str]:
    answer = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | environment, capture_output=True, text=True, check=True
    )
    return answer.stdout.splitlines()


@pytest.mark.process
def test_without_numba_the_same_functions_run_in_python(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    *plain, imported = run(WITHOUT + RIDE)
    assert imported == "True"  # as None
    *compiled, _ = run("import sys\n" + RIDE, NUMBA_CACHE_DIR=str(tmp_path))
    *kept, _ = run("import sys\n" + RIDE, NUMBA_CACHE_DIR=str(tmp_path))
    assert kept == compiled
    for one, other in zip(plain, compiled, strict=True):
        assert [*map(float, one.split())] == pytest.approx([*map(float, other.split())], rel=1e-9)


@pytest.fixture
def kept(tmp_path: Path) -> dict[str, str]:
    """An environment in which `import outer` runs a kept function that calls one of another file."""
    pytest.importorskip("numba")
    (tmp_path / "inner.py").write_text(INNER)
    (tmp_path / "outer.py").write_text(OUTER)
    path = os.pathsep.join([str(tmp_path), *sys.path])
    return {"NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": path}


@pytest.mark.process
def test_a_change_in_another_file_is_seen(kept: dict[str, str], tmp_path: Path) -> None:
    """Of what it calls; not that something else was imported before."""
    assert run("import outer", **kept) == ["2.0 0"]
    (tmp_path / "other.py").write_text(INNER)
    assert run("import other, outer", **kept) == ["2.0 1"]
    (tmp_path / "inner.py").write_text(INNER.replace("2.0", "3.0"))
    assert run("import outer", **kept) == ["3.0 0"]


@pytest.mark.process
def test_processes_at_once_share_what_they_keep(kept: dict[str, str]) -> None:
    command = [sys.executable, "-c", "import outer"]
    runs = [subprocess.Popen(command, env=os.environ | kept, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [one.communicate()[0].split()[0] for one in runs] == ["2.0"] * 3
    assert run("import outer", **kept) == ["2.0 1"]


def test_where_nothing_can_be_kept_it_is_made_anew() -> None:
    """Of a function without a file, as of one beside which, and in whose user's folder, nothing can be written."""
    scope: dict[str, object] = {}
    exec(compile("def twice(value):\n    return 2 * value\n", "<nowhere>", "exec"), scope)
    twice = cast("Callable[[float], float]", scope["twice"])
    assert kept_machine_code()(twice)(2.5) == 5.0


NAMED = """
from typing import NamedTuple

class Table(NamedTuple):
    value: float
"""
OF_A_NAMED_TUPLE = """
from named import Table
from fes_mj.common.machine_code import kept_machine_code

@kept_machine_code(Table)
def doubled(table):
    return 2.0 * table.value

print(doubled(Table(1.0)), sum(doubled.stats.cache_hits.values()))
"""


@pytest.mark.process
def test_what_was_kept_of_a_named_tuple_that_is_gone_is_made_anew(tmp_path: Path, kept: dict[str, str]) -> None:
    for name in ("Table", "Row"):
        (tmp_path / "named.py").write_text(NAMED.replace("Table", name))
        (tmp_path / "of.py").write_text(OF_A_NAMED_TUPLE.replace("import Table", f"import {name} as Table"))
        assert [run("import of", **kept) for _ in "ab"] == [["2.0 0"], ["2.0 1"]]

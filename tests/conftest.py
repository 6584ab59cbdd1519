"""Designs, moments and a study that many tests share."""

import gc
import os
import shutil
import signal
import time
from functools import partial
from pathlib import Path
from typing import Any

# Before numpy: a worker for every core runs these tests, and threads of its own would only wait for the others'.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np
import pytest
from hypothesis import settings

import fes_mj
from fes_mj.fit.search import best_seats
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep

# Tests that run in the background or under nohup ignore these; the processes that they start must not.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

# Imports and collected tests stay until the end: no looking through them for garbage, in which a quarter of the
# time of collecting them would go.
gc.disable()


NO_TEST_BEGINS_AFTER = float(os.environ.get("NO_TEST_BEGINS_AFTER", "inf"))  # s since 1970: set by .ci/run
LONGEST = "test_everything_about_the_paper_is_written_again"  # begun first, so that all others run beside it


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: item.name != LONGEST)


def pytest_runtest_setup() -> None:
    if time.time() > NO_TEST_BEGINS_AFTER:
        pytest.skip("the time for tests is over: this machine is slow")


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()


# The same examples in every run: a failure can be repeated; continuous integration has four times as many.
settings.register_profile("fes_mj", derandomize=True, deadline=None, max_examples=25)
settings.register_profile("ci", derandomize=True, deadline=None, max_examples=100)
settings.load_profile("ci" if "CI" in os.environ else "fes_mj")


@pytest.fixture(params=DESIGNS)
def design(request: pytest.FixtureRequest) -> fes_mj.Design:
    """Each catalogued design in turn."""
    return fes_mj.load_design(request.param)


@pytest.fixture(
    params=[pytest.param(group, marks=() if group == RIDER_GROUPS[0] else pytest.mark.long) for group in RIDER_GROUPS]
)
def moments(request: pytest.FixtureRequest) -> fes_mj.JointMoments:
    """The recovered moments of each group in turn, of the second one in the long tests."""
    return fes_mj.load_moments(request.param)


@pytest.fixture
def smooth_moments() -> fes_mj.JointMoments:
    """Moments that nobody fitted to anything."""
    angle = np.radians(np.arange(0.0, 360.0, 0.5))
    return fes_mj.JointMoments(
        "smooth", angle, 9 + 11 * np.cos(angle - 1.2) + 2 * np.sin(3 * angle), 7 * np.sin(angle + 0.4)
    )


@pytest.fixture
def coarse_seats(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seats that are sought among few: for tests of anything but how good they are, which is fit/test_search.py's."""
    monkeypatch.setattr("fes_mj.fit.seat.best_seats", partial(best_seats, generations=(10, 10, 10)))


# Of the fixture `study`.
GRID = """
[study]
chunk = 7
[grid]
design = ["d1", "r2", "mine.toml"]
moments = ["p1p2", "mine.csv"]
cadence_rpm = [60, 90]
thigh = { from = 0.50, to = 0.54, steps = 3 }
[sample]
size = 4
seed = 3
R1x = [-0.80, -0.60]
gear_ratio = [1.0, 2.0]
"""


def write_study(folder: Path) -> Path:
    """A study with a design and moments of its own beside it."""
    source = Path(fes_mj.__file__).parent / "data"
    (folder / "mine.toml").write_text((source / "designs/identified/d2.toml").read_text())
    (folder / "mine.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n")
    path = folder / "study.toml"
    path.write_text(GRID)
    return path


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return write_study(tmp_path)


@pytest.fixture(scope="session")
def finished_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of such a study, swept to its end into `out`: to be copied."""
    folder = tmp_path_factory.mktemp("finished")
    Sweep(load_study(write_study(folder)), folder / "out").run()
    return folder


@pytest.fixture
def done(finished_study: Path, tmp_path: Path) -> Sweep:
    """A finished sweep of 21 chunks, in `out`, of the fixture `study`."""
    shutil.copytree(finished_study, tmp_path, dirs_exist_ok=True)
    return Sweep(load_study(tmp_path / "study.toml"), tmp_path / "out")


def rows_of(sweep: Sweep) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = sweep.read().to_pylist()
    return rows

"""The same command gives the same bytes, in processes that order their sets differently."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.process
pytest.importorskip("mediapy")
pytest.importorskip("jinja2")
SCRIPT = """
import sys
from fes_mj.cli.app import run
from fes_mj.viewing import render
render.LOOP = 0.1
sys.exit(run(sys.argv[1:]))
"""


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", "d1", "--out", ".", "--render", "v.mp4", "--legs", "2"],
        ["simulate", "r1", "--json"],
        ["validate", "r2", "--quick", "--report", "r.html", "--junit", "j.xml"],
        ["export", "d2", "-o", "m.xml", "--scene", "--variant", "two-legs"],
        ["draw", "r1", "-o", "."],
        ["ride", "trt", "--duration", "2", "--out", "."],
    ],
    ids=" ".join,
)
def test_twice_the_same_bytes(arguments: list[str], tmp_path: Path) -> None:
    written = []
    for seed in ("1", "4"):  # by which the sets of ezdxf, too, are in another order
        (folder := tmp_path / seed).mkdir()
        command = [sys.executable, "-c", SCRIPT, *arguments]
        done = subprocess.run(command, cwd=folder, env=os.environ | {"PYTHONHASHSEED": seed}, capture_output=True)
        assert (done.returncode, done.stderr) == (0, b"")
        written.append({path.name: path.read_bytes() for path in folder.rglob("*.*")} | {"": done.stdout})
    assert written[0].keys() == written[1].keys()
    assert [name for name in written[0] if written[0][name] != written[1][name]] == []

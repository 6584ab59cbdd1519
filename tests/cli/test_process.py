"""Standard streams that are closed, full, left by their reader or not UTF-8; the verdict stays what it is."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import fes_mj
from tests.cli.conftest import names

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full and a POSIX shell"),
]
DESIGN = Path(fes_mj.__file__).parent / "data" / "designs" / "identified" / "d1.toml"


def shell(command: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Run a shell line in which fes_mj is this one."""
    line = f'fes_mj() {{ "{sys.executable}" -m fes_mj "$@"; }}; {command}'
    return subprocess.run(["bash", "-c", line], cwd=folder, env=os.environ | environment, capture_output=True)


@pytest.mark.parametrize(
    "command", ["static d1", "static d1 --json", "validate --explain all", "static --help", "--help", "--version"]
)
def test_standard_output(command: str, tmp_path: Path) -> None:
    full = shell(f"fes_mj {command} >/dev/full", tmp_path)
    assert full.returncode == 2
    assert full.stderr == b"fes_mj: standard output: cannot be written: No space left on device\n"
    for rest in (">&-", ">&- 2>&-", "| true; exit ${PIPESTATUS[0]}", "| head -1; exit ${PIPESTATUS[0]}"):
        done = shell(f"fes_mj {command} {rest}", tmp_path)
        assert (done.returncode, done.stderr) == (0, b""), rest


def test_a_reader_that_leaves_does_not_stop_the_files(tmp_path: Path) -> None:
    """More is printed than a pipe holds, and the run still ends as it would have."""
    done = shell("fes_mj static d1 --json --curves | true; exit ${PIPESTATUS[0]}", tmp_path)
    assert (done.returncode, done.stderr) == (0, b"")
    done = shell("fes_mj export d1 -o a.xml | true; exit ${PIPESTATUS[0]}", tmp_path)
    assert (done.returncode, done.stderr) == (0, b"")
    assert names(tmp_path) == {"a.xml", "a.csv"}


@pytest.mark.parametrize("rest", ["2>&-", "2>/dev/full", "2>&1 >&- | true; exit ${PIPESTATUS[0]}"])
def test_standard_error_can_be_lost(rest: str, tmp_path: Path) -> None:
    assert shell(f"fes_mj static nope {rest}", tmp_path).returncode == 2
    assert shell(f"fes_mj dance {rest}", tmp_path).returncode == 2
    assert shell(f"fes_mj static d1 {rest}", tmp_path).returncode == 0


@pytest.mark.parametrize(("encoding", "shown"), [("ascii", rb"gr\xf6\xdfe \u81ea"), ("cp1252", b"gr\xf6\xdfe \\u81ea")])
def test_a_terminal_that_is_not_utf8_shows_escapes(encoding: str, shown: bytes, tmp_path: Path) -> None:
    (tmp_path / "größe 自.toml").write_bytes(DESIGN.read_bytes())
    done = shell("fes_mj static *.toml", tmp_path, PYTHONIOENCODING=encoding)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(shown + b", coupler-driven")


def test_closed_streams_are_not_taken_for_files(tmp_path: Path) -> None:
    """With standard output closed the next file opened would get its number, and what is printed."""
    assert shell("fes_mj export d1 -o a.xml --scene <&- >&- 2>&-", tmp_path).returncode == 0
    assert shell("fes_mj export d1 -o b.xml", tmp_path).returncode == 0
    assert (tmp_path / "a.xml").read_bytes() == (tmp_path / "b.xml").read_bytes()

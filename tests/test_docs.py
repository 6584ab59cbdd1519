"""The commands of the tutorials run, in the order of the page, on the files that the page names."""

import re
import shlex
import shutil
from pathlib import Path

import pytest

from fes_mj.cli.app import run

ROOT = Path(__file__).parents[1]


def commands(page: str) -> list[str]:
    """Lines of a page's console blocks."""
    blocks = re.findall(r"```console\n(.*?)```", (ROOT / "docs" / page).read_text(), re.DOTALL)
    return [line for block in blocks for line in block.splitlines()]


def test_own_moments(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(ROOT / "examples" / "trial", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    for command in commands("own_moments.md"):
        program, *arguments = shlex.split(command)
        assert program == "fes_mj"
        assert run(arguments) == 0, command
    assert "Dynamic and static agree" in capsys.readouterr().out
    assert {"moments.png", "plain.csv"} <= {path.name for path in tmp_path.iterdir()}
    page = (ROOT / "docs" / "own_moments.md").read_text()
    assert (tmp_path / "trial.toml").read_text().split("[moments]")[1] in page  # the file shown is the file used


def test_stimulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (command,) = commands("stimulation.md")
    assert run(shlex.split(command)[1:]) == 0
    header = (tmp_path / "d1-windows.csv").read_text().splitlines()[0].split(",")
    page = (ROOT / "docs" / "stimulation.md").read_text()
    for name in re.findall(r"`(\w+_(?:deg|rpm|Hz|s))`", page):
        assert name in header or f"{name.removesuffix('_deg')}_on_deg" in header, name

"""The tutorials do what they say: their files and commands, page by page, and what is shown of the output."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"


def blocks(page: str) -> list[tuple[str, str]]:
    """Language and content of a page's fenced blocks."""
    return re.findall(r"```(\w+)\n(.*?)```", (DOCS / page).read_text(), re.DOTALL)


def _plain(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize(
    "page",
    [
        pytest.param("designer.md", marks=pytest.mark.long),
        "engineer.md",
        "own_moments.md",
        "stimulation.md",
        pytest.param("reviewer.md", marks=pytest.mark.long),
    ],
)
def test_tutorial(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(ROOT / "examples" / "trial", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    printed, commands = "", 0
    for kind, content in blocks(page):
        if name := re.match(r"# (\S+\.\w+)\n", content):
            (tmp_path / name[1]).write_text(content)
        if kind == "console":
            printed = ""
            for line in content.splitlines():
                program, *arguments = shlex.split(line, comments=True)
                assert program == "fes_mj"
                expected = re.search(r"# exit (\d)", line)
                assert run(arguments) == (int(expected[1]) if expected else 0), line
                printed += "".join(capsys.readouterr())
                commands += 1
        elif kind == "text":
            for line in content.splitlines():
                assert _plain(line) in _plain(printed)
        elif kind == "python":
            subprocess.run([sys.executable, "-c", content], check=True, capture_output=True)
    assert commands


def test_the_file_that_is_shown_is_the_file_that_is_used() -> None:
    shown = (DOCS / "own_moments.md").read_text()
    assert (ROOT / "examples" / "trial" / "trial.toml").read_text().split("[moments]")[1] in shown


def test_every_module_is_in_the_structure() -> None:
    named = re.findall(r"^   (fes_mj\.[\w.]+)$", (DOCS / "structure.md").read_text(), re.MULTILINE)
    assert len(named) == len(set(named))
    there = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for path in (ROOT / "fes_mj").rglob("*.py")
    }
    assert set(named) == {name for name in there if not re.match(r"fes_mj(\.cli.*|\.__main__)?$", name)}

"""What the README claims: the table of the ten runs is that of fresh runs, and its examples run."""

import re
from pathlib import Path

import pytest

from fes_mj.design_file import load_design
from tools.update_readme import END, README, START, ten_runs


def test_the_table_of_runs_is_fresh() -> None:
    written = README.read_text(encoding="utf-8").split(START)[1].split(END)[0]
    for old, new in zip(_cells(written.strip()), _cells(ten_runs().markdown().strip()), strict=True):
        assert old[:2] == new[:2]
        # the last digit printed may differ between machines
        assert [float(cell) for cell in old[2:]] == pytest.approx([float(cell) for cell in new[2:]], abs=0.011)


def test_the_example_design_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(_block("toml"))
    assert load_design(path).linkage.kind == "cdt"


def test_the_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    exec(_block("python"), {})
    static, dynamic = map(float, capsys.readouterr().out.split())
    assert dynamic == pytest.approx(static, rel=5e-4)


def _block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert found
    return found.group(1)


def _cells(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|\n").split("|")] for line in table.splitlines()[2:]]

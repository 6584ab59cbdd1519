"""What the README claims: the table of the ten runs is that of fresh runs."""

import pytest

from tools.update_readme import END, README, START, ten_runs


def test_the_table_of_runs_is_fresh() -> None:
    written = README.read_text(encoding="utf-8").split(START)[1].split(END)[0]
    for old, new in zip(_cells(written.strip()), _cells(ten_runs().markdown().strip()), strict=True):
        assert old[:2] == new[:2]
        # the last digit printed may differ between machines
        assert [float(cell) for cell in old[2:]] == pytest.approx([float(cell) for cell in new[2:]], abs=0.011)


def _cells(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|\n").split("|")] for line in table.splitlines()[2:]]

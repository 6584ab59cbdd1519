"""What is printed is what was said."""

import pytest

from fes_mj.common.console import check_word, conclude, print_table, say

MARKED = "[red]a[/blue] :car: \x1b[31m"
SHOWN = r"[red]a[/blue] :car: \x1b[31m"


def test_text_is_neither_broken_nor_read_as_markup(capsys: pytest.CaptureFixture[str]) -> None:
    say(f"{MARKED} {'long ' * 100}end")
    assert capsys.readouterr().out == f"{SHOWN} {'long ' * 100}end\n"


def test_tables_show_their_cells_as_they_are(capsys: pytest.CaptureFixture[str]) -> None:
    print_table(MARKED, ("name", "verdict"), [(MARKED, check_word(True)), ("b", check_word(False))])
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert lines[0] == SHOWN.split()
    assert [*SHOWN.split(), "ok"] in lines
    assert ["b", "FAILED"] in lines


def test_a_conclusion_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    conclude(False, "1 of 2 checks failed", f": {MARKED * 20}")
    assert capsys.readouterr().out == f"1 of 2 checks failed: {SHOWN * 20}\n"

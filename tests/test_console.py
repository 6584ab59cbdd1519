"""What is printed is what was said."""

import pytest

from fes_mj.console import say


def test_text_is_neither_broken_nor_read_as_markup(capsys: pytest.CaptureFixture[str]) -> None:
    text = f"[red]a[/blue] {'long ' * 100}end"
    say(text)
    assert capsys.readouterr().out == f"{text}\n"

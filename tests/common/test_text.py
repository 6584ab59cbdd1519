"""A name from outside can be shown, encoded and stand in XML, whatever it holds."""

from xml.etree import ElementTree

import pytest
from hypothesis import given, strategies
from hypothesis.strategies import characters

from fes_mj.common.text import printable, typeset


@given(strategies.text(characters()))  # surrogates too: a name on disk need not be UTF-8
def test_any_text_can_be_shown(text: str) -> None:
    shown = printable(text)
    assert shown.isprintable()
    element = ElementTree.Element("a", name=shown)
    assert ElementTree.fromstring(ElementTree.tostring(element, "utf-8")).get("name") == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("größe 自転車 [bold]$x$ é", "größe 自転車 [bold]$x$ é"),
        ("a\x1b[31m", r"a\x1b[31m"),
        ("a\nb\tc\0", r"a\nb\tc\x00"),
        ("\u202excod", r"\u202excod"),
        ("\udcff", r"\udcff"),
    ],
)
def test_what_has_no_picture_becomes_an_escape(text: str, shown: str) -> None:
    assert printable(text) == shown


def test_numbers_are_set_with_their_own_signs() -> None:
    assert typeset("-1.5 +- 0.2") == "\u22121.5 \u00b1 0.2"

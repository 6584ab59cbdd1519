"""Pages from templates: text stays text, and nothing is left out unnoticed."""

from pathlib import Path

import pytest

pytest.importorskip("jinja2")

from jinja2 import UndefinedError

from fes_mj.viewing.pages import page


def test_a_page_escapes_text_and_misses_no_name(tmp_path: Path) -> None:
    template = tmp_path / "page.html.j2"
    template.write_text("<p>{{ name }} {{ value | twice }}</p>")
    filters = {"twice": lambda value: str(2 * value)}
    assert page(template, filters, name="R&D <d1>", value=3) == "<p>R&amp;D &lt;d1&gt; 6</p>"
    with pytest.raises(UndefinedError, match="'name' is undefined"):
        page(template, filters, value=3)

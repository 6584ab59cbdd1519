"""Numbers in the text of README and docs: each is that of a result file, which says the command that made it."""

import json
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]
CLAIMS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


@cache
def _results(name: str) -> Any:
    """A result file: JSON, or the tables of a page by their headings."""
    text = (ROOT / "results" / name).read_text(encoding="utf-8")
    return json.loads(text) if name.endswith(".json") else dict(_tables(text))


def _tables(page: str) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Every heading with the table that follows it first."""
    for section in re.split(r"^#+ ", page, flags=re.MULTILINE):
        if table := re.search(r"(?:^\|.*\n)+", section, re.MULTILINE):
            names, _, *rows = ([cell.strip() for cell in line[1:-1].split("|")] for line in table[0].splitlines())
            yield section.split("\n")[0], [dict(zip(names, map(_value, row), strict=True)) for row in rows]


def _value(cell: str) -> str | float:
    try:
        return float(cell)
    except ValueError:
        return cell


def _find(steps: list[str | int | float]) -> Any:
    """Follow keys into a result file; in a table they choose the one row that has them all."""
    here = _results(str(steps[0]))
    for step in steps[1:]:
        if isinstance(here, list):
            rows = [row for row in here if step in row.values()]
            here = rows if len(rows) > 1 or not rows else rows[0]
        elif isinstance(here, dict):
            here = here[step]
    assert not isinstance(here, (dict, list)), f"{steps} chooses no number"
    return here.replace("+-", "±") if isinstance(here, str) else here


SENTENCES = [(page, sentence) for page, sentences in CLAIMS.items() for sentence in sentences]


@pytest.mark.parametrize(
    ("page", "claim"), SENTENCES, ids=[f"{page} {sentence['says'][:40]}" for page, sentence in SENTENCES]
)
def test_a_number_in_the_text_is_that_of_its_result(page: str, claim: dict[str, Any]) -> None:
    sentence = claim["says"].format(**{name: _find(steps) for name, steps in claim["of"].items()})
    text = re.sub(r"\s+", " ", (ROOT / page).read_text(encoding="utf-8")).replace("**", "")
    assert sentence in text

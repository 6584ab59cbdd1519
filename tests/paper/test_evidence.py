"""Evidence: rows as functionals of the curves, and damaged rows named (no command reads a user's evidence)."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA
from fes_mj.paper.evidence import functional, load_evidence
from fes_mj.paper.reconstruction import reconstruct
from tests.cli.test_fuzz import broken


def test_broken_evidence(tmp_path: Path) -> None:
    path, messages = tmp_path / "fuzzed.toml", []
    for text in broken(5, (DATA / "evidence.toml").read_text(), 60):
        path.write_text(text, encoding="utf-8", errors="surrogatepass")
        try:
            reconstruct(load_evidence(path))
        except InputError as error:
            messages.append(str(error))
    assert len(messages) > 30
    assert max(map(len, messages)) < 4000


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('design = "d1"', 'design = "d9"', "design is 'd9'"),
        ('group = "p1p3"', 'group = "p9"', "group is 'p9'"),
        ('unit = "W"', 'unit = "kW"', "unit is 'kW'"),
        ("error = 0.4", "error = -0.4", "error is -0.4; it must be a number above 0"),
        ("leg_m = 0.542", "leg_m = 0.3", "leg_m is 0.3; it must be from 0.475 to 1.0 m"),
        ("leg_m = 0.542", "leg_m = 1e-320", "leg_m is 1e-320"),
        ("error = 0.4", "error = 0.0", "error is 0.0; it must be a number above 0"),
        ("value = 31.29", "value = nan", "value is nan; it must be a finite number"),
        ('source = "table1"', 'source = "rumour"', "source is 'rumour'"),
        ("value = 31.29", "vlaue = 31.29", "vlaue; allowed here: group, name"),
    ],
)
def test_bad_evidence_is_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    text = (DATA / "evidence.toml").read_text()
    assert old in text
    path = tmp_path / "evidence.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        load_evidence(path)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("value = 31.29", 'value = "much"', "value is 'much'; it must be a finite number"),
        ("error = 0.4", "error = true", "error is True; it must be a number above 0"),
        ("leg_m = 0.515", "leg_m = 0.0", "leg_m is 0.0; it must be from 0.475 to 1.0 m"),
        ("leg_m = 0.515\n", "", "leg_m is missing"),
        ("angle_deg = 73.0\n", "", "angle_deg is missing"),
        ('name = "p1p2 power in R1"', 'name = "p1p2 power in TRT"', "'p1p2 power in TRT' is given twice"),
        ('group = "p1p3"', 'group = "p1p2"', "there is no evidence for group 'p1p3'; both groups need some"),
        ("value = 31.29", f"value = 1{400 * '0'}", "it must be a finite number, at most 1e+06"),
        ('name = "p1p2 power in R1"', "name = [1]", "name is '[1]'; it must be a text"),
        ("[[evidence]]", "[[rumour]]", "there is no evidence for group 'p1p2'"),
    ],
)
def test_rows_that_are_no_evidence_are_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    path, text = tmp_path / "evidence.toml", (DATA / "evidence.toml").read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_evidence(path)
    assert words in str(caught.value)


def test_own_legs_of_the_papers_length_are_the_trt() -> None:
    """Moments read at the crank angle itself, and through the map: the same where the legs are the same."""
    (row,) = (row for row in load_evidence() if row.name == "p1p2 15 W with own legs")
    (trt,) = (row for row in load_evidence() if row.name == "p1p2 power in TRT")
    weights = functional(replace(row, leg_m=0.52))
    assert np.abs(weights - functional(trt)).max() < 1e-9

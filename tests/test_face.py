"""The public names: each has an example that runs, and results show themselves in a line."""

import doctest
import math
from pathlib import Path

import numpy as np
import pytest

import fes_mj

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


SLOW = ("fit_population",)
NAMES = [pytest.param(name, marks=[pytest.mark.long] * (name in SLOW)) for name in fes_mj.__all__]


@pytest.mark.parametrize("name", NAMES)
def test_example(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = {"fes_mj": fes_mj, "math": math, "np": np, "folder": tmp_path}
    document = getattr(fes_mj, name).__doc__
    test = doctest.DocTestParser().get_doctest(document, given, name, None, None)
    assert test.examples, f"{name} has no example"
    failed, _ = doctest.DocTestRunner(optionflags=OPTIONS).run(test)
    assert not failed, capsys.readouterr().out


def test_names_are_imported_from_where_they_are_defined() -> None:
    """Type checkers and Python read one list, the stub; no name in it is another module's."""
    assert {name: getattr(fes_mj, name).__module__ for name in fes_mj.__all__} == fes_mj._modules()
    assert {*fes_mj.__all__} <= {*dir(fes_mj)}


def test_the_page_of_the_names_has_them_all() -> None:
    page = (Path(__file__).parents[1] / "docs/python.md").read_text()
    assert [name for name in fes_mj.__all__ if f"   {name}\n" not in page] == []

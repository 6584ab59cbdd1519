"""`fes_mj validate --explain`: every check by the name under which it is printed."""

import pytest

from fes_mj.cli.app import run
from fes_mj.common.checks import definitions
from tests.cli.conftest import answer


def test_every_check_of_simulate_can_be_explained(capsys: pytest.CaptureFixture[str]) -> None:
    _, content = answer(capsys, "simulate", "r1")
    for check in content["checks"]:
        assert run(["validate", "--explain", check["name"]]) == 0
        assert run(["validate", "--explain", check["name"].replace("_", " ").upper()]) == 0
        text = capsys.readouterr().out
        assert "guards against" in text
        assert "usually broken by" in text


def test_every_check_printed_by_simulate_is_named_as_explain_knows_it(capsys: pytest.CaptureFixture[str]) -> None:
    run(["simulate", "r1"])
    lines = capsys.readouterr().out.split("Checks")[1].splitlines()
    names = [line.split("  ")[1].strip() for line in lines if line.rstrip().endswith("ok")]
    assert len(names) >= 6
    assert set(names) <= set(definitions())


def test_all_are_listed_and_an_unknown_one_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["validate", "--explain", "all"]) == 0
    text = capsys.readouterr().out
    assert all(name in text for name in definitions())
    assert run(["validate", "--explain", "loopgap"]) == 2
    assert capsys.readouterr().err == "fes_mj: loopgap: no such check; did you mean loop_gap?\n"

"""Running a command line and reading what it says."""

import json

import pytest

from fes_mj.cli.app import run


def result(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error."""
    code = run(arguments)
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def answer(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict]:
    """Exit code and the JSON that the command prints."""
    code = run([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)

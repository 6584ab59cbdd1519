"""Running a command line and reading what it says."""

import json
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.common.writing import FOLDER_RECORD


def result(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error."""
    code = run(arguments)
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def names(folder: Path) -> set[str]:
    """Names of the files in a folder, but for fes_mj's own record of them."""
    return {path.name for path in folder.iterdir()} - {FOLDER_RECORD}


def answer(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, dict]:
    """Exit code and the JSON that the command prints."""
    code = run([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)

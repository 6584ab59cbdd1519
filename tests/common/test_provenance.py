"""Where a result comes from: inputs told apart and hashed, the same command wherever it is installed."""

from pathlib import Path

import pytest

import fes_mj
from fes_mj.common.provenance import provenance

DATA = Path(fes_mj.__file__).parent / "data"


def test_inputs_are_told_apart_and_hashed(tmp_path: Path) -> None:
    """The SHA-256 is that of the standard's own example (FIPS 180-4)."""
    own, names = tmp_path / "own.toml", ["designs/identified/d1.toml", "designs/printed/d1.toml"]
    own.write_bytes(b"abc")
    inputs = provenance([own, *(DATA / name for name in names)])["inputs"]
    assert inputs["own.toml"] == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert inputs.keys() == {"own.toml", *names}


@pytest.mark.parametrize("program", ["/usr/bin/fes_mj", "/somewhere/fes_mj/__main__.py"])
def test_the_command_is_the_same_wherever_it_is_installed(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", [program, "static", "d1"])
    assert provenance()["command"] == "fes_mj static d1"


def test_the_command_can_be_given_again_and_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["fes_mj", "static", "my own.toml", "\udcff\x1b"])
    assert provenance()["command"] == r"fes_mj static 'my own.toml' '\udcff\x1b'"

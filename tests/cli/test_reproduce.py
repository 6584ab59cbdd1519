"""`fes_mj reproduce`: what it refuses before it computes."""

import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.common.writing import require_replaceable


def test_a_folder_that_cannot_be_made(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert run(["reproduce", "--out", str(tmp_path / "no" / "such")]) == 2
    assert "cannot write the results: the folder does not exist" in capsys.readouterr().err
    (tmp_path / "file").write_text("")
    assert run(["reproduce", "--out", str(tmp_path / "file")]) == 2
    assert "is not a folder" in capsys.readouterr().err


def test_without_matplotlib_the_extra_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert run(["reproduce", "--out", str(tmp_path)]) == 3
    assert "pip install 'fes-mj[paper]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_only_what_it_wrote_itself_is_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "reproduction.json").write_text('{"provenance": {"fes_mj": "0.1.0"}}')
    (stranger := tmp_path / "gains.md").write_text("# mine")
    for name in ("gains.md", "reproduction.json"):
        assert run(["reproduce", "--out", str(tmp_path)]) == 2
        assert f"{name}: cannot write the results: a file has this name that fes_mj did not write" in (
            capsys.readouterr().err
        )
        stranger.unlink(missing_ok=True)


def test_the_results_here_are_as_it_wrote_them() -> None:
    """Or `make reproduce` would refuse to replace them."""
    results = Path(__file__).parents[2] / "results"
    written = [*results.glob("figures/*.png"), results / "reproduction.json"]
    written += [path for path in results.glob("*.md") if "Written by `fes_mj reproduce`" in path.read_text()]
    require_replaceable(written, "the results")

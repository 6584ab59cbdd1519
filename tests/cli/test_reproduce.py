"""`fes_mj reproduce`: what it refuses before it computes."""

import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run


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


def test_only_an_earlier_reproduction_is_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from fes_mj.paper.reproduce import require_ours

    results = Path(__file__).parents[2] / "results"
    require_ours(results)
    (tmp_path / "figures").mkdir()
    require_ours(tmp_path)
    (stranger := tmp_path / "figures" / "power.png").touch()
    assert run(["reproduce", "--out", str(tmp_path)]) == 2
    assert (
        "this folder is not empty and holds no reproduction.json of fes_mj; name a new one" in capsys.readouterr().err
    )
    (tmp_path / "reproduction.json").write_text('{"provenance": {"theirs": 1}}')
    assert run(["reproduce", "--out", str(tmp_path)]) == 2
    assert "of fes_mj" in capsys.readouterr().err
    stranger.rename(tmp_path / "reproduction.json")
    assert run(["reproduce", "--out", str(tmp_path)]) == 2
    assert "reproduction.json: the record of the results is not valid JSON" in capsys.readouterr().err

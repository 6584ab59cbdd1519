"""The commands of the tutorials run, in the order of the page, on the files that the page names."""

import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.simulation.variants import VARIANTS

ROOT = Path(__file__).parents[1]


def commands(page: str) -> list[str]:
    """Lines of a page's console blocks."""
    blocks = re.findall(r"```console\n(.*?)```", (ROOT / "docs" / page).read_text(), re.DOTALL)
    return [line for block in blocks for line in block.splitlines()]


def test_own_moments(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copytree(ROOT / "examples" / "trial", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    for command in commands("own_moments.md"):
        program, *arguments = shlex.split(command)
        assert program == "fes_mj"
        assert run(arguments) == 0, command
    assert "Dynamic and static agree" in capsys.readouterr().out
    assert {"moments.png", "plain.csv"} <= {path.name for path in tmp_path.iterdir()}
    page = (ROOT / "docs" / "own_moments.md").read_text()
    assert (tmp_path / "trial.toml").read_text().split("[moments]")[1] in page  # the file shown is the file used


def test_stimulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (command,) = commands("stimulation.md")
    assert run(shlex.split(command)[1:]) == 0
    header = (tmp_path / "d1-windows.csv").read_text().splitlines()[0].split(",")
    page = (ROOT / "docs" / "stimulation.md").read_text()
    for name in re.findall(r"`(\w+_(?:deg|rpm|Hz|s))`", page):
        assert name in header or f"{name.removesuffix('_deg')}_on_deg" in header, name


def test_models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for command in commands("models.md"):
        assert run(shlex.split(command)[1:]) == 0, command
    page = (ROOT / "docs" / "models.md").read_text()
    named = set(re.findall(r"^\|[^|]*\| `([a-z-]+)` \|", page.split("## Integrator")[0], re.MULTILINE))
    assert named == set(VARIANTS)


def test_the_numbers_of_the_models_are_measured() -> None:
    """What docs/models.md says of drift and gaps is what results/energy.json holds, and that all keep their limits."""
    rows = json.loads((ROOT / "results" / "energy.json").read_text())["rows"]
    assert {row["verdict"] for row in rows} == {"ok"}
    page = (ROOT / "docs" / "models.md").read_text()
    laden = [row["drift, %"] for row in rows if row["variants"].split()[1:2] in (["brake"], ["ride"])]
    assert f"by {min(laden):.3f} to {max(laden):.2f} % with implicitfast" in page
    one = {row["design"]: row for row in rows if row["variants"] == "passive"}
    assert one["D2"]["euler, %"] is None
    assert (
        f"loses {one['D2']['discrete, %']:.1f} % with `discrete`, and RK4 still loses {one['D2']['rk4, %']:.1f} %"
        in page
    )
    assert f"and {one['R1']['rk4, %']:.0f} % in R1" in page
    assert f"{one['R1']['fastest, rpm']:.0f} rpm" in page
    assert f"drifts by {one['R1']['drift, %']:.2f} % in one\nleg of R1" in page
    assert max(row["drift, %"] for row in rows if row is not one["R1"]) < 0.055
    assert max(row["loop gap, um"] for row in rows) < 4

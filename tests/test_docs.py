"""The tutorials do what they say: their files and commands, page by page, and what is shown of the output."""

import ast
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.linkage.design_file import load_design
from fes_mj.simulation.variants import VARIANTS

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"


def blocks(page: str) -> list[tuple[str, str]]:
    """Language and content of a page's fenced blocks."""
    return re.findall(r"```(\w+)\n(.*?)```", (DOCS / page).read_text(), re.DOTALL)


def _plain(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize(
    "page",
    [
        pytest.param("designer.md", marks=pytest.mark.long),
        pytest.param("build.md", marks=pytest.mark.long),
        "engineer.md",
        pytest.param("own_moments.md", marks=pytest.mark.process),
        "stimulation.md",
        pytest.param("riders.md", marks=pytest.mark.long),
        pytest.param("reviewer.md", marks=pytest.mark.long),
    ],
)
def test_tutorial(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(ROOT / "examples" / "trial", tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    printed, commands = "", 0
    for kind, content in blocks(page):
        if name := re.match(r"# (\S+\.\w+)\n", content):
            (tmp_path / name[1]).write_text(content)
        if kind == "console":
            printed = ""
            for line in content.splitlines():
                program, *arguments = shlex.split(line, comments=True)
                assert program == "fes_mj"
                expected = re.search(r"# exit (\d)", line)
                assert run(arguments) == (int(expected[1]) if expected else 0), line
                printed += "".join(capsys.readouterr())
                commands += 1
        elif kind == "text":
            for line in content.splitlines():
                assert _plain(line) in _plain(printed)
        elif kind == "python":
            subprocess.run([sys.executable, "-c", content], check=True, capture_output=True)
    assert commands


def test_the_file_that_is_shown_is_the_file_that_is_used() -> None:
    shown = (DOCS / "own_moments.md").read_text()
    assert (ROOT / "examples" / "trial" / "trial.toml").read_text().split("[moments]")[1] in shown


def test_every_room_is_in_the_structure() -> None:
    """The reference, the picture and the import contract name the folders that are there."""
    from tools.picture_structure import HANDED_UP, PICTURE, drawing, floors

    rooms = {path.parent.name for path in (ROOT / "fes_mj").glob("*/__init__.py")}
    assert {room for floor in floors() for room in floor} == {*HANDED_UP} == rooms
    page = (DOCS / "structure.md").read_text()
    assert re.findall(r"^\| (\w+) \| \[", page, re.MULTILINE) == [room for floor in floors() for room in floor]
    documented = re.findall(r"^   fes_mj\.(\w+)$", page, re.MULTILINE)
    assert sorted(documented) == sorted(rooms - {"cli"})
    assert drawing() == PICTURE.read_text(encoding="utf-8"), "run `python -m tools.picture_structure`"


def test_what_a_room_hands_up_others_use() -> None:
    from tools.picture_structure import HANDED_UP

    asked: set[tuple[str, str]] = set()
    for path in (ROOT / "fes_mj").rglob("*.py*"):
        lines = [*ast.walk(ast.parse(path.read_text()))] if path.suffix in (".py", ".pyi") else []
        for line in lines:
            if isinstance(line, ast.ImportFrom) and (room := str(line.module).split(".")[1:2]) != [path.parent.name]:
                asked |= {(*room, name.name) for name in line.names}
    assert {(room, name) for room, names in HANDED_UP.items() for name in names} <= asked


def test_the_keys_of_the_windows_are_those_of_the_file(tmp_path: Path) -> None:
    header: list[str] = []
    for number, options in enumerate((("--drive", "moments"), ("--cadence", "60"))):
        assert run(["stimulation", "d1", "-q", *options, "--csv", str(tmp_path / f"{number}.csv")]) == 0
        header += (tmp_path / f"{number}.csv").read_text().splitlines()[0].split(",")
    for name in re.findall(r"`(\w+_(?:deg|rpm|W|effort))`", (DOCS / "stimulation.md").read_text()):
        assert name in header or f"{name.removesuffix('_deg')}_on_deg" in header, name


def test_the_design_file_that_is_shown_is_accepted(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(next(content for kind, content in blocks("files.md") if kind == "toml"))
    assert load_design(tmp_path / "mine.toml").linkage.kind == "cdt"


def test_python_as_shown_runs() -> None:
    """Line by line; what a comment shows of a result is what the result shows of itself."""
    names: dict[str, object] = {}
    shown = []
    for line in next(content for kind, content in blocks("python.md") if kind == "python").splitlines():
        code, _, comment = line.partition("  # ")
        if comment:
            shown.append((repr(eval(code, names)), comment))
        else:
            exec(code, names)
    assert all(result.startswith("array") if "an array" in said else said.startswith(result) for result, said in shown)
    assert len(shown) == 6


def test_every_variant_is_in_the_table() -> None:
    before, _ = (DOCS / "models.md").read_text().split("## Integrator")
    assert {*re.findall(r"^\|[^|]*\| `([a-z-]+)` \|", before, re.MULTILINE)} == {*VARIANTS}


def test_the_numbers_of_the_models_are_measured() -> None:
    """What docs/models.md says of drift and gaps is what results/energy.json holds, and that all keep their limits."""
    rows = json.loads((ROOT / "results" / "energy.json").read_text())["rows"]
    assert {row["verdict"] for row in rows} == {"ok"}
    page = (DOCS / "models.md").read_text()
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

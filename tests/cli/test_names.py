"""Files with any name: every output is well-formed, and nothing raw reaches the terminal."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

import fes_mj
from fes_mj.cli.app import run

pytest.importorskip("mediapy")
pytest.importorskip("jinja2")
DESIGN = Path(fes_mj.__file__).parent / "data" / "designs" / "identified" / "d1.toml"


@pytest.mark.process
@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names themselves")
@pytest.mark.parametrize("name", ["[bold]z[red] a$x$ R&D---<b>", "\x1b[31m\n\t\u202e自\udcff {{x}} ${y}"])
def test_any_name_in_every_output(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("fes_mj.viewing.render.LOOP", 0.1)
    monkeypatch.chdir(tmp_path)
    design, moments = f"{name}.toml", f"{name}.csv"
    Path(design).write_bytes(DESIGN.read_bytes())
    Path(moments).write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n")
    own = [design, "--moments", moments]
    monkeypatch.setattr("sys.argv", ["fes_mj", *own])  # which the report quotes
    Path("out").mkdir()
    assert run(["simulate", *own, "--out", "out", "--render", "v.mp4", "-v"]) in (0, 1)
    assert run(["validate", *own, "--quick", "--report", "r.html", "--junit", "j.xml"]) in (0, 1)
    assert run(["export", *own, "-o", "m.xml", "--scene"]) == 0
    assert run(["static", f"{name}-not-there.toml"]) == 2
    assert run(["static", design, "--moments", f"{name}-not-there.csv"]) == 2
    printed = capsys.readouterr()
    assert (printed.out + printed.err).replace("\n", "").isprintable()
    assert sum(not line.startswith("warning: ") for line in printed.err.splitlines()) == 2
    files = [*Path("out").glob("[!.]*"), *Path().glob("*.xml"), Path("r.html"), Path("v.mp4")]
    assert len(files) == 8
    for path in files:
        if path.suffix == ".xml":
            ElementTree.parse(path)
        if path.suffix != ".mp4":
            assert path.read_text(encoding="utf-8").replace("\n", "").isprintable()


def test_a_scene_cannot_name_every_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "d1", "-o", str(tmp_path / "a\x1b.xml"), "--scene"]) == 2
    assert r"a\x1b.xml: the scene is scene.xml" in capsys.readouterr().err
    assert not [*tmp_path.iterdir()]

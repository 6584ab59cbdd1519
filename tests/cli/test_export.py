"""`fes_mj export`: model, table and scene, or one message and no file."""

from importlib.resources import files
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import pytest

from fes_mj.cli.app import run
from tests.cli.conftest import names


def test_export_writes_model_table_and_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = tmp_path / "mine.xml"
    arguments = ["export", "d1", "-o", str(model), "--variant", "two-legs", "--variant", "passive", "--scene"]
    assert run(arguments) == 0
    assert names(tmp_path) == {"mine.csv", "mine.xml", "scene.xml"}
    loaded = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml"))
    assert (loaded.nu, loaded.nv) == (0, 9)
    assert (tmp_path / "mine.csv").read_text().startswith("crank_angle_deg,crank_angle_from_tdc_deg,right_knee_deg,")
    assert str(model) in capsys.readouterr().out


def test_any_file_name_gives_valid_xml(tmp_path: Path) -> None:
    source = Path(str(files("fes_mj"))) / "data" / "designs" / "identified" / "r1.toml"
    design, model = tmp_path / 'R&D ---> "1".toml', tmp_path / 'R&D "1" <new>.xml'
    design.write_text(source.read_text())
    assert run(["export", str(design), "-o", str(model), "--scene"]) == 0
    for path in (model, tmp_path / "scene.xml"):
        ElementTree.parse(path)
        assert mujoco.MjModel.from_xml_path(str(path)).njnt == 5


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["d1", "-o", "{folder}/x.xml", "--variant", "mjx"], "--variant"),
        (["d1", "-o", "{folder}"], "this is a folder"),
        (["d1", "-o", "{folder}/x.txt"], "must end in .xml"),
        (["d1", "-o", "{folder}/none/x.xml"], "does not exist"),
        (["d1", "-o", "{folder}/scene.xml", "--scene"], "another name"),
        (["d1", "-o", "{folder}/x.xml", "--variant", "sites", "--variant", "bodies"], "exclude each other"),
        (["d1", "-o", "{folder}/x.xml", "--variant", "ride", "--variant", "free"], "exclude each other"),
        (["d1", "-o", "{folder}/x.xml", "--variant", "fixed-gear"], "give it with ride"),
        (["r2", "--dims", "printed", "-o", "{folder}/x.xml"], "cannot close at crank angle"),
    ],
)
def test_bad_input_is_one_message_and_no_file(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["export", *(part.format(folder=tmp_path) for part in arguments)]) == 2
    written = capsys.readouterr()
    assert said in written.err
    assert "Traceback" not in written.err
    assert not written.out
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("inputs", "output", "flags", "eaten"),
    [
        ("mine.toml m.csv", "m.xml", [], "m.csv"),  # the table beside the model
        ("mine.toml m.xml", "m.xml", [], "m.xml"),
        ("scene.xml.toml scene.xml", "a.xml", ["--scene"], "scene.xml"),
        ("mine.toml LINK.csv", "m.xml", [], "m.csv"),
    ],
)
def test_no_output_replaces_an_input(
    inputs: str, output: str, flags: list[str], eaten: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    design, moments = inputs.split()
    Path(design).write_bytes((files("fes_mj") / "data" / "designs" / "identified" / "r1.toml").read_bytes())
    Path(eaten).write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n")
    if not Path(moments).exists():
        Path(moments).symlink_to(eaten)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    assert run(["export", design, "--moments", moments, "-o", output, *flags]) == 2
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize(("stranger", "flags"), [("a.csv", []), ("scene.xml", ["--scene"])])
def test_a_file_that_nobody_named_is_replaced_only_if_it_is_ours(
    stranger: str, flags: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["export", "d1", "-o", str(tmp_path / "a.xml"), *flags]
    (tmp_path / stranger).write_text("crank_angle_deg,knee_Nm,hip_Nm\n")
    assert run(arguments) == 2
    assert f"{stranger}: cannot write the " in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == [stranger]
    (tmp_path / stranger).unlink()
    assert run(arguments) == 0
    assert run([*arguments, "--legs", "2"]) == 0
    with (tmp_path / stranger).open("a") as file:  # somebody's work on what was ours
        file.write(" ")
    edited = (tmp_path / stranger).read_bytes()
    assert run(arguments) == 2
    assert (tmp_path / stranger).read_bytes() == edited

"""`fes_mj stimulation`: table, JSON, CSV and plot, and what it refuses."""

import subprocess
import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from tests.cli.conftest import answer, result


def test_table_json_and_files(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    table, picture = tmp_path / "d1.csv", tmp_path / "d1.svg"
    arguments = ["stimulation", "d1", "--cadence", "60", "--lag", "0.1"]
    code, out, _ = result(capsys, *arguments, "--csv", str(table), "--plot", str(picture))
    assert code == 0
    for said in (
        "quadriceps (knee extension)",
        "60.0 (1.00 Hz)",
        "lag 0.1 s = 36.0 deg",
        "points backwards",
        "180 deg",
    ):
        assert said in out
    assert table.read_text().startswith("muscle,moment,leg,cadence_rpm,cadence_Hz,lag_s,lead_deg,")
    assert picture.read_text().startswith("<?xml")
    code, content = answer(capsys, *arguments)
    assert code == 0
    first = content["windows"][0]
    assert (first["muscle"], first["leg"], first["lead_deg"]) == ("quadriceps", "right", pytest.approx(36))
    on, off = (f"{angle:.0f}" for angle in first["stimulate_deg"])
    assert f"{on} to {off}" in out


def test_several_cadences_and_none(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    _, content = answer(capsys, "stimulation", "r1", "--cadence", "30", "--cadence", "60")
    assert {round(window["cadence_rpm"]) for window in content["windows"]} == {30, 60}
    _, content = answer(capsys, "stimulation", "r1")
    assert {round(window["cadence_rpm"], 1) for window in content["windows"]} == {93.2}
    _, out, _ = result(capsys, "stimulation", "r1")
    assert "--lag advances" in out
    assert (
        run(["stimulation", "r1", "-q", "--plot", str(tmp_path / "a.png"), "--cadence", "30", "--cadence", "60"]) == 0
    )
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["d9"], "d9"),
        (["d1", "--cadence", "0"], "for --cadence. Must be >= 1."),
        (["d1", "--cadence", "60", "--cadence", "nan"], "for --cadence. Must be"),
        (["d1", "--lag", "-0.1"], '"-0.1" for --lag. Must be >= 0.'),
        (
            ["d1", "--lag", "0.7"],
            "--lag is 0.7; it must be shorter than a turn of the crank, which takes 0.623 s in d1",
        ),
        (["d1", "--lag", "0.7", "--cadence", "60", "--cadence", "100"], "takes 0.6 s in d1 at 100 rpm"),
        (["d1", "--csv", "{folder}/x.txt"], "must end in .csv"),
        (["d1", "--csv", "{folder}/none/x.csv"], "does not exist"),
        (["d1", "--plot", "{folder}/x.pdf"], "must end in .png or .svg"),
        (["r2", "--dims", "printed"], "cannot close at crank angle"),
    ],
)
def test_bad_input_is_one_message_and_no_file(
    arguments: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = result(capsys, "stimulation", *(part.format(folder=tmp_path) for part in arguments))
    assert (code, out) == (2, "")
    assert said in err
    assert "Traceback" not in err
    assert not [*tmp_path.iterdir()]


def test_no_output_replaces_the_design(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (link := tmp_path / "a.csv").write_text('[linkage]\nkind = "trt"\n')
    code, _, err = result(capsys, "stimulation", str(link), "--csv", str(link))
    assert code == 2
    assert link.read_text().startswith("[linkage]")
    assert "a.csv" in err


def test_it_needs_no_mujoco() -> None:
    script = "import sys; from fes_mj.cli.app import run; run(sys.argv[1:]); sys.exit('mujoco' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script, "stimulation", "d1", "-q"]).returncode == 0

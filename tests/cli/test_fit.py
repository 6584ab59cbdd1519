"""`fes_mj fit`: the promised JSON and file, and what is refused."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import fes_mj
from tests.cli.conftest import answer, result

MAN = ("--percentile", "50", "--sex", "male")


@pytest.mark.usefixtures("coarse_seats")
def test_json_and_design_file_agree(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "mine.toml"
    code, content = answer(capsys, "fit", "r1", *MAN, "-o", str(out))
    assert code == 0
    assert content["fits"]
    assert content["design_file"] == str(out)
    assert content["rider"]["thigh"] == pytest.approx(0.408)
    written, drawn = fes_mj.load_design(out), fes_mj.load_design("r1")
    assert written.linkage.ground - drawn.linkage.ground == pytest.approx(complex(*content["seat_shift_m"]))
    assert out.read_text().startswith("# r1 with the seat moved by fes_mj")
    static = answer(capsys, "static", str(out))[1]
    for key in ("power_mean_W", "knee_range_deg", "hip_range_deg", "extrapolated_share"):
        assert static[key] == pytest.approx(content[key])
    same_draws = replace(written, name="r1")  # each name has its own
    seated = fes_mj.answer(same_draws, riders=fes_mj.load_muscles("p1p2").riders).rider_power
    assert [content["rider_power_mean_W"], *content["rider_power_interval_W"]] == pytest.approx(seated)
    assert content["power_unmoved_W"] < content["power_mean_W"]
    assert content["power_paper_rider_W"] == pytest.approx(answer(capsys, "static", "r1")[1]["power_mean_W"])


@pytest.mark.usefixtures("coarse_seats")
def test_at_another_cadence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is written keeps its gear ratio and has, at the cadence asked for, the power that was said."""
    out = tmp_path / "slow.toml"
    content = answer(capsys, "fit", "r1", *MAN, "--cadence", "40", "-o", str(out))[1]
    assert fes_mj.load_design(out).linkage.gear_ratio == fes_mj.load_design("r1").linkage.gear_ratio
    static = answer(capsys, "static", str(out), "--cadence", "40")[1]
    assert static["power_mean_W"] == pytest.approx(content["power_mean_W"], rel=1e-9)


@pytest.mark.usefixtures("coarse_seats")
def test_not_fitting_is_a_result_and_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "mine.toml"
    arguments = ("fit", "d1", "--stature", "1.25", "--sex", "female", "--forward", "0", "0.1", "-o", str(out))
    code, content = answer(capsys, *arguments)
    assert (code, content["fits"], content["design_file"]) == (0, False, None)
    assert not out.exists()
    text = result(capsys, *arguments)[1]
    assert "Does not fit: d1: thigh and shank cannot close at crank angle" in text
    assert "it would with a seat that moves farther" in text


@pytest.mark.long
def test_a_population(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.setattr("fes_mj.fit.population._NODES", 3)  # a coarse map, in a second
    plot = tmp_path / "who.png"
    code, out, err = result(capsys, "fit", "r2", "--population", "--samples", "10", "--plot", str(plot), "--json")
    content = json.loads(out)
    assert (code, err, content["samples"]) == (0, "", 10)
    for key in ("share_unmoved", "share_fitted"):
        assert content[key].keys() == {"men", "women"}
    assert plot.stat().st_size > 10_000
    again = json.loads(result(capsys, "fit", "r2", "--population", "--samples", "10", "--json")[1])
    assert again == content
    assert "women, seat moved" in result(capsys, "fit", "r2", "--population", "--samples", "10", "--seed", "1")[1]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--stature", "175", "--sex", "male"), "--stature is 175; it must be from 1.32 to 2.37 in metres\n"),
        (("--stature", "0.5", "--sex", "male"), "--stature is 0.5; it must be from 1.32 to 2.37 in metres\n"),
        (("--percentile", "0", "--sex", "male"), '"0.0" for --percentile. Must be > 0.'),
        (("--percentile", "100", "--sex", "male"), '"100.0" for --percentile. Must be < 100.'),
        (("--percentile", "nan", "--sex", "male"), '"nan" for --percentile'),
        (("--percentile", "50"), "--percentile 50.0 needs --sex male or female"),
        (("--sex", "male"), "--sex male needs --stature or --percentile"),
        (("--thigh", "0.4"), "thigh and shank. Missing argument: --shank"),
        (("--thigh", "40", "--shank", "50"), '"40.0" for --thigh. It must be a length in metres from 0.001 to 2.'),
        (("--thigh", "0.4", "--shank", "0.5", *MAN), "Mutually exclusive arguments: {--thigh, --percentile}"),
        (("--up", "0.1", "0"), '"(0.1, 0.0)" for --up. An empty range'),
        (("--forward", "-5", "30"), '"(-5.0, 30.0)" for --forward. Must be >= -1.'),
        (("--recline", "nan", "3"), '"(nan, 3.0)" for --recline. Must be'),
        (("--population", "--samples", "1"), '"1" for --samples. Must be >= 10.'),
        (("--population", "--seed", "-1"), '"-1" for --seed. Must be >= 0.'),
        (("--population", *MAN), "--percentile 50.0 and --population exclude each other"),
        (("--population", "-o", "a.toml"), "--out a.toml and --population exclude each other"),
        (("--samples", "20"), "--samples 20 needs --population"),
        (("-o", "mine.txt"), "the name must end in .toml"),
        (("--dims", "printed"), "rocker and coupler cannot close"),
    ],
)
def test_what_is_refused(arguments: tuple[str, ...], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "fit", "r2", *arguments)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert words in err

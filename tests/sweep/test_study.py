"""Study files: how many points they ask for, and one message for bad input."""

from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.sweep.study import load_study
from tests.conftest import GRID

pytest.importorskip("pyarrow")


def test_the_example_is_a_study() -> None:
    study = load_study(Path(__file__).parents[2] / "examples" / "study.toml")
    assert study.points == 2 * 2 * 2 * 5 * 1000
    assert study.chunks == 20


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("R1x = [-0.80", "R12 = [-0.80", "unknown key sample.R12; allowed here: size, seed, R1x"),
        ("[-0.80, -0.60]", "[-0.60, -0.80]", "sample.R1x is [-0.6, -0.8]; the bounds contradict"),
        ("steps = 3", "steps = 0", "grid.thigh.steps is 0; it must be a whole number from 1"),
        ("from = 0.50", "from = 52", "grid.thigh is 52; it must be from 0.001 to 2"),
        ('"d1", ', '"d7", ', "d7: no such design"),
        ("[60, 90]", "[]", "grid.cadence_rpm is []; it must be a list"),
        ("[60, 90]", "[60, 900]", "grid.cadence_rpm is 900; it must be from 1 to 200"),
        ("[study]", "[stduy]", "unknown key stduy"),
        ("chunk = 7", "chunk = 0.5", "study.chunk is 0.5"),
        ("chunk = 7", 'analysis = "kinetic"', "study.analysis is 'kinetic'; it must be one of static, dynamic"),
        ("thigh = {", "R1x = {", "R1x is both in grid and in sample"),
        ('design = ["d1", "r2", "mine.toml"]', "", "grid.design is missing"),
        ('"r2"', '"trt"', ""),
        (
            "steps = 3",
            "steps = 1000000000000",
            "grid.thigh.steps is 1000000000000; it must be at most 1,000,000 values",
        ),
        ("steps = 3", f"steps = 0x{'f' * 9000}", "grid.thigh.steps is a number of thousands of digits; it must be"),
        ("chunk = 7", "chunk = 1000000000000", "study.chunk is 1000000000000; it must be at most 100,000 points"),
        ("steps = 3", "steps = 300000", "study.chunk is 7; it must be at least 15 for 14,400,000 points"),
        (
            "steps = 3",
            "steps = 300000 }\nmass = { from = 60, to = 80, steps = 1000",
            "14,400,000,000 points; a study has",
        ),
        ("size = 4", "size = 1000000000000", "sample.size is 1000000000000; it must be at most 1,000,000 values"),
        ("seed = 3", "seed = -1", "sample.seed is -1; it must be a whole number from 0, below 2^64"),
        ("seed = 3", f"seed = {2**64}", f"sample.seed is {2**64}; it must be"),
        ("chunk = 7", "timestep = 0.001", "study.timestep is 0.001"),
        ('"d1", ', '"d1", "d1", ', "grid.design is ['d1', 'd1', "),
        ("R1x = [-0.80, -0.60]\ngear_ratio = [1.0, 2.0]\n", "", "sample.size is 4"),
        ("size = 4", "size = 9e9", "sample.size is 9000000000.0; it must be a whole number"),
    ],
)
def test_a_bad_study_is_one_message_and_exit_code_2(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    assert old in GRID
    text = GRID.replace(old, new)
    if not said:  # a variable that one of the designs does not have
        text, said = text.replace("gear_ratio", "R9").replace("[1.0, 2.0]", "[0.3, 0.4]"), "trt is a trt without it"
    study.write_text(text)
    assert run(["sweep", str(study), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 2
    captured = capsys.readouterr()
    assert said in captured.err.replace("\n", " ")
    assert "Traceback" not in captured.err
    assert captured.out == ""
    assert not (tmp_path / "out").exists()

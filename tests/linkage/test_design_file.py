"""Design files: what reads back, and what is refused with which words."""

import math
from pathlib import Path

import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, design_toml, load_design

TRT = {"kind": '"trt"', "R1": "[-0.736, -0.304]", "R2": "0.15", "R6": "0.069", "gear_ratio": "1.31", "seat_angle": "60"}


def written(folder: Path, rider: str = "", **changes: str | None) -> Path:
    """A TRT's design file with some keys changed, or removed (None)."""
    keys = {key: value for key, value in (TRT | changes).items() if value is not None}
    path = folder / "mine.toml"
    path.write_text("[linkage]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items()) + rider)
    return path


def test_a_design_reads_back_as_it_was_written(design: Design, tmp_path: Path) -> None:
    path = tmp_path / f"{design.name}.toml"
    path.write_text(design_toml(design, "A comment\nof two lines"))
    assert load_design(path) == design


def test_the_readme_example_of_the_format_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(
        '[linkage]\nkind = "cdt"\nR1 = [-0.62, 0.25]\nR2 = 0.16\nR6 = 0.10\nR7 = [-0.38, 0.09]\nR8 = 0.14\n'
        "R9 = 0.34\nR10 = 0.22\ngear_ratio = 2.10\nseat_angle = 30.0\n[rider]\nthigh = 0.5\n"
    )
    design = load_design(path)
    assert design.linkage.coupler_angle == math.pi / 2
    assert (design.rider.thigh, design.rider.shank, design.rider.mass) == (0.5, 0.52, 75.0)


FRAME = """[frame]
tube = [[0.06, -0.14], [-0.62, 0.2]]
tube_diameter = 0.04
wheel_centre = [0.1, -0.25]
wheel_diameter = 0.5
ground_height = -0.5
"""


def test_a_frame_reads_back_as_it_was_written(tmp_path: Path) -> None:
    design = load_design(written(tmp_path, FRAME))
    assert design.frame.tube == (0.06 - 0.14j, -0.62 + 0.2j)
    assert (design.frame.wheel_centre, design.frame.chainring_diameter) == (0.1 - 0.25j, None)
    path = tmp_path / "mine.toml"
    path.write_text(design_toml(design))
    assert load_design(path) == design


def test_a_file_without_its_first_header_is_told_so(tmp_path: Path) -> None:
    path = written(tmp_path)
    path.write_text(path.read_text().replace("[linkage]\n", ""))
    with pytest.raises(InputError, match=r"put \[linkage\] before it"):
        load_design(path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("tube_diameter = 0.04\n", "", r"frame\.tube_diameter is missing"),
        ("[[0.06, -0.14], [-0.62, 0.2]]", "[0.06, -0.14]", r"frame\.tube is \[0\.06, -0\.14\]"),
        ("[0.1, -0.25]", "[10, -25]", r"frame\.wheel_centre is \[10, -25\]"),
        ("= -0.5", "= -50", r"frame\.ground_height is -50"),
        ("ground_height", "road", r"unknown key frame\.road; allowed here: tube, tube_diameter"),
    ],
)
def test_what_a_frame_cannot_be_is_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        load_design(written(tmp_path, FRAME.replace(old, new)))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"R2": "15.0"}, r"linkage.R2 is 15.0.*centimetres"),
        ({"R1": "[-73.6, -30.4]"}, r"linkage.R1 is \[-73.6, -30.4\].*centimetres"),
        ({"R2": "-0.15"}, "linkage.R2 is -0.15"),
        ({"R2": "0.0"}, "linkage.R2 is 0.0"),
        ({"R2": "nan"}, "linkage.R2 is nan"),
        ({"R6": "inf"}, "linkage.R6 is inf"),
        ({"R2": '"long"'}, "linkage.R2 is 'long'"),
        ({"R2": "true"}, "linkage.R2 is True"),
        ({"R2": "[0.1, 0.1]"}, r"linkage.R2 is \[0.1, 0.1\]"),
        ({"R1": "-0.7"}, r"linkage.R1 is -0.7"),
        ({"R1": "[-0.7]"}, r"linkage.R1 is \[-0.7\]"),
        ({"R2": None}, "linkage.R2 is missing"),
        ({"R7": "[0.1, 0.1]"}, "unknown key linkage.R7.* R1, R2, R6"),
        ({"R_2": "0.1"}, "unknown key linkage.R_2"),
        ({"kind": '"bike"'}, "linkage.kind is 'bike'"),
        ({"kind": None}, "linkage.kind is None"),
        ({"kind": "[1]"}, r"linkage.kind is \[1\]"),
        ({"gear_ratio": "0"}, "linkage.gear_ratio is 0"),
        ({"seat_angle": "1000"}, "linkage.seat_angle is 1000"),
        ({"rider": "[rider]\nmass = -3\n"}, "rider.mass is -3"),
        ({"rider": "[rider]\nweight = 75\n"}, "unknown key rider.weight"),
        ({"rider": '[rider]\nsex = "x"\n'}, "rider.sex is 'x'"),
        ({"rider": "[extra]\n"}, "unknown key extra"),
        ({"rider": "[linkage]\n"}, "not valid TOML"),
    ],
)
def test_what_cannot_be_used_is_named(changes: dict[str, str], words: str, tmp_path: Path) -> None:
    path = written(tmp_path, **changes)
    with pytest.raises(InputError, match=words) as caught:
        load_design(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unknown_designs_and_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"x9: .*{', '.join(DESIGNS)}"):
        load_design("x9")
    with pytest.raises(InputError, match=r"nothing.toml: .*No such file"):
        load_design(tmp_path / "nothing.toml")
    with pytest.raises(InputError, match="Is a directory"):
        load_design(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b"# \xe9\n")
    with pytest.raises(InputError, match="not UTF-8"):
        load_design(tmp_path / "latin.toml")
    (tmp_path / "flat.toml").write_text("linkage = 3\n")
    with pytest.raises(InputError, match="linkage is 3"):
        load_design(tmp_path / "flat.toml")
    with pytest.raises(InputError, match="dims is 'guessed'"):
        load_design("d1", "guessed")

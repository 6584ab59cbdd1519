"""Tables as programs write them: layouts of public files, what pandas, numpy and spreadsheets make, what is refused."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.moments.tables import load_table

ROWS = np.array([[0.0, -1.5, 2.25], [0.5, 1e-3, -4.0], [1.0, 12.5, 0.125]])
NAMES = ["time", "knee", "hip"]


def lines(separator: str, decimal: str = ".") -> str:
    rows = ["".join(separator.join(f"{value}" for value in row)).replace(".", decimal) for row in ROWS.tolist()]
    return "\n".join(rows) + "\n"


LAYOUTS = {
    "commas": "time,knee,hip\n" + lines(","),
    "quotes": '"time","knee","hip"\n' + lines(","),
    "semicolons": "time;knee;hip\n" + lines(";"),
    "decimal commas": "time;knee;hip\n" + lines(";", ","),
    "tabs": "time\tknee\thip\n" + lines("\t"),
    "tabs with decimal commas": "time\tknee\thip\n" + lines("\t", ","),
    "blanks": "time  knee hip\n" + lines("   "),
    "closing separators": "time,knee,hip,\n" + lines(",").replace("\n", ",\n"),
    "lines above": "Subject: M\u00fcller\nRate,100\n\ntime,knee,hip\n" + lines(","),
    "units below": "time,knee,hip\ns,N m,N m\n" + lines(","),
    "numpy": "# time knee hip\n" + lines(" "),
    "windows": ("time,knee,hip\n" + lines(",")).replace("\n", "\r\n"),
    "components above, as Visual3D": "trial.c3d\ttrial.c3d\ttrial.c3d\ntime\tknee\thip\nITEM\tX\tX\n" + lines("\t"),
    "a name in several words": "time,knee,hip,a note\n" + lines(",").replace("\n", ",a; b\n"),
    "OpenSim 4": "id\nversion=3\nDataType=double\nOpenSimVersion=4.4\nendheader\ntime\tknee\thip\n" + lines("\t"),
    "SIMM": "name id\ndatacolumns 3\ndatarows 3\nrange 0 1\nendheader\ntime knee hip\n" + lines("\t "),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_every_layout_is_the_same_table(layout: str, encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(LAYOUTS[layout].encode(encoding))
    table = load_table(path, "moments", NAMES)
    np.testing.assert_array_equal(np.stack([table.column(name) for name in NAMES], axis=1), ROWS)
    assert table.time_column == "time"


@pytest.mark.parametrize(
    "arguments", [{}, {"index": False}, {"index": False, "sep": ";", "decimal": ","}, {"sep": "\t"}]
)
def test_what_pandas_writes(arguments: dict[str, object], tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    path = tmp_path / "a.txt"
    pandas.DataFrame(dict(zip(NAMES, ROWS.T, strict=True))).to_csv(path, **arguments)
    table = load_table(path, "moments", NAMES)
    np.testing.assert_array_equal(np.stack([table.column(name) for name in NAMES], axis=1), ROWS)


def test_what_numpy_writes(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    np.savetxt(path, ROWS, header=" ".join(NAMES))
    np.testing.assert_array_equal(load_table(path, "moments", NAMES).column("hip"), ROWS[:, 2])


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("Time", "s"), ("timestamp", "s"), ("time_s", "s"), ("secs", "s"), ("t (s)", "s"), ("Time [ms]", "ms"),
        ("t", "s"),
        ("time_ms", "ms"), ("TIME(sec)", "s"), ("Seconds", "s"), ("milliseconds", None), ("torque", None),
        ("T", None), ("timeout", None),
    ],
)  # fmt: skip
def test_names_of_the_time(name: str, unit: str | None, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(f"{name},knee,hip\n{lines(',')}")
    table = load_table(path, "moments", NAMES)
    assert table.time_column == (name if unit else "")
    assert not unit or table.time_unit == unit


@pytest.mark.parametrize("suffix", [".mat", ".xlsx", ".ods", ".trc"])
def test_other_files_are_refused_with_the_way_out(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"MATLAB 5.0 MAT-file\377\376")
    with pytest.raises(InputError, match=rf"a\{suffix}: .*CSV.*\.sto.*; \w"):
        load_table(path, "moments")
    (renamed := tmp_path / "a.csv").write_bytes(b"PK\3\4\0\0")
    with pytest.raises(InputError, match=r"a\.csv: .*CSV"):
        load_table(renamed, "moments")


REFUSED = {
    "nRows": ("x\nnRows=282\nendheader\ntime\tknee\thip\n" + lines("\t"), r"nRows=282, 3 rows"),
    "datarows": ("x\ndatarows 282\nendheader\ntime\tknee\thip\n" + lines("\t"), r"datarows 282, 3 rows"),
    "a number": ("time,knee\n" + "0.25,1.125\n" * 12 + "0.5,1.1", r"line 14 .* knee '1\.1'"),
    "a row": ("time,knee,hip\n" + lines(",") + "1.5,2", r"line 5 .*\b2\b.*\b3\b"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_file_that_was_cut_off(name: str, tmp_path: Path) -> None:
    text, words = REFUSED[name]
    (path := tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=words):
        load_table(path, "moments")


def test_a_file_without_a_line_end_is_whole(tmp_path: Path) -> None:
    (path := tmp_path / "a.csv").write_text("time,knee\n" + "0.25,1.125\n" * 12 + "0.50,1.375")
    assert len(load_table(path, "moments").rows) == 13
    path.write_text("time,knee\n0,11.25\n0.5,14")  # written by hand
    assert load_table(path, "moments").column("knee").tolist() == [11.25, 14]


@pytest.mark.parametrize("cell", ["", "nan"])
def test_a_sample_that_is_missing_is_to_be_taken_out(tmp_path: Path, cell: str) -> None:
    (path := tmp_path / "a.csv").write_text(f"time,knee\n0,1\n1,{cell}\n2,3\n")
    with pytest.raises(InputError, match=rf"a\.csv: line 3: knee is '{cell}'"):
        load_table(path, "moments").column("knee")


def test_a_column_that_is_nearly_there_is_named(tmp_path: Path) -> None:
    (path := tmp_path / "a.csv").write_text("time,Knee_Nm,hip\n" + lines(","))
    with pytest.raises(InputError, match=r"a\.csv: .*'knee_Nm'.* time, Knee_Nm, hip;.* 'Knee_Nm'"):
        load_table(path, "moments").column("knee_Nm")


def test_long_cells(tmp_path: Path) -> None:
    (path := tmp_path / "a.csv").write_text(f"time,knee,note\n0,{'1' * 140_000},{'x' * 140_000}\n")
    table = load_table(path, "moments")
    assert table.column("time").tolist() == [0]
    with pytest.raises(InputError, match=r"line 2: knee is '1{40}\.\.\.'"):
        table.column("knee")


def test_motion_capture(tmp_path: Path) -> None:
    """A file of the package's own writer: angles and moments as model outputs, a point that is not always seen."""
    c3d = pytest.importorskip("c3d")
    writer = c3d.Writer(point_rate=100.0, point_scale=-1.0)
    writer.set_point_labels(["RKneeAngles", "RKneeMoment"])
    for number in range(5):
        points = np.zeros((2, 5), np.float32)
        points[0, :3], points[1, :3] = (number, 1, 2), (10 * number, 3, 4)
        points[1, 3] = -1 if number == 3 else 0
        writer.add_frames([(points, np.empty((0, 0)))])
    path = tmp_path / "a.c3d"
    with path.open("wb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no analog channels
        writer.write(file)
    table = load_table(path, "moments")
    assert table.header == ["time", *(f"{label}.{axis}" for label in ("RKneeAngles", "RKneeMoment") for axis in "xyz")]
    assert np.ptp(table.column("time")) == pytest.approx(0.04)
    assert table.column("RKneeAngles.x").tolist() == [0, 1, 2, 3, 4]
    with pytest.raises(InputError, match=r"line 4: RKneeMoment\.x is 'nan'"):
        table.column("RKneeMoment.x")
    path.write_bytes(b"P\x08junk" * 20)
    with pytest.raises(InputError, match=r"a\.c3d: no \.c3d file that can be read"):
        load_table(path, "moments")

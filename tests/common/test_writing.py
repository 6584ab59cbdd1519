"""Reading, refusing and writing: one wording, naming file, key, value and what is allowed; files appear whole."""

import errno
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fes_mj.common import reading as inputs
from fes_mj.common.errors import InputError
from fes_mj.common.reading import Section, read_json, read_text, read_toml
from fes_mj.common.writing import (
    FOLDER_RECORD,
    remove_leftovers,
    replacing,
    require_replaceable,
    require_results,
    require_writable,
    write_files,
    write_results,
    write_text,
)


def _section(tmp_path: Path, text: str) -> Section:
    path = tmp_path / "a.toml"
    path.write_text(text)
    return read_toml(path, "test file").section("t")


@pytest.mark.parametrize(
    ("text", "ask", "words"),
    [
        ("[t]\nb = 1", lambda t: t.only(["a"]), "unknown key t.b; allowed here: a"),
        ("[t]\nb = 1", lambda t: t.require(["a"], "a t needs it"), "t.a is missing; a t needs it"),
        ("t = 1", lambda t: t, "t is 1; it must be a table [t]"),
        ("[t]\na = true", lambda t: t.number("a"), "t.a is True; it must be a number"),
        ("[t]\na = nan", lambda t: t.number("a"), "t.a is nan; it must be a number"),
        ("[t]\na = -inf", lambda t: t.number("a"), "t.a is -inf; it must be a number"),
        ("[t]\na = 3", lambda t: t.number("a", 0, 2, "from 0 to 2"), "t.a is 3; it must be from 0 to 2"),
        ("[t]\na = 1.0", lambda t: t.whole("a", 1), "t.a is 1.0; it must be a whole number from 1"),
        ("[t]\na = true", lambda t: t.whole("a", 1), "t.a is True; it must be a whole number from 1"),
        ("[t]\na = [1]", lambda t: t.choice("a", ["x", "y"]), "t.a is [1]; it must be one of x, y"),
        ("[t]\na = [1, 2, 3]", lambda t: t.ascending_pair("a"), "t.a is [1, 2, 3]; it must be [lowest, highest]"),
        ("[t]\na = [2, 2]", lambda t: t.ascending_pair("a"), "t.a is [2, 2]; the bounds contradict each other"),
        ("[t]\na = [nan, 2]", lambda t: t.ascending_pair("a"), "t.a is nan; it must be a number"),
    ],
)
def test_what_is_refused(text: str, ask: Callable[[Section], object], words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        ask(_section(tmp_path, text))
    assert str(caught.value).startswith(f"{tmp_path / 'a.toml'}: {words}")


def test_an_integer_that_no_float_can_hold_is_no_number(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"t\.a is 1000"):
        _section(tmp_path, f"[t]\na = 1{'0' * 400}").number("a")


@pytest.mark.parametrize("text", ["a = " + "[" * 5000, "a = 1" + "0" * 5000, "a = ", "=", "a\x00 = 1"])
def test_what_is_no_toml_is_said(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=r"a\.toml: not valid TOML: "):
        read_toml(path, "test file")


def test_a_byte_order_mark_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text("a = 1", encoding="utf-8-sig")
    assert read_toml(path, "test file").content == {"a": 1}


def test_unreadable_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path, words in (
        (tmp_path, "Is a directory"),
        (tmp_path / "none", "No such file"),
        (tmp_path / "nul\0", "no file can have this name"),
        (tmp_path / ("n" * 300), "File name too long"),
    ):
        with pytest.raises(InputError, match=words):
            read_text(path, "test file")
    large = tmp_path / "large"
    large.write_bytes(b"12345")
    monkeypatch.setattr(inputs, "LARGEST_INPUT", 4)
    with pytest.raises(InputError, match="it is larger than"):
        read_text(large, "test file")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "not valid JSON"),
        ('{"a": ', "not valid JSON"),
        ("[1]", "must be a JSON object"),
        ("[" * 99999, "not valid"),
    ],
)
def test_damaged_json_is_refused(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "study.json"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        read_json(path, "record")


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    target = tmp_path / "result.json"
    target.write_text("old")

    def interrupted() -> None:
        with replacing(target) as beside:
            beside.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


@pytest.fixture
def measured(tmp_path: Path) -> Path:
    path = tmp_path / "m.csv"
    path.write_text("measured")
    return path


def test_an_output_never_replaces_an_input_under_any_name(measured: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = measured.parent
    (folder / "symbolic.csv").symlink_to(measured)
    (folder / "hard.csv").hardlink_to(measured)
    monkeypatch.chdir(folder)
    names = (measured, folder / "symbolic.csv", folder / "hard.csv", Path("m.csv"), Path(f"../{folder.name}/m.csv"))
    for output in names:
        for read in names:
            with pytest.raises(InputError, match=r"would replace .*\.csv"):
                require_writable(output, "the table", ".csv", [Path("not-there"), read])


def test_a_named_file_is_replaced_unless_it_is_an_input(measured: Path) -> None:
    require_writable(measured, "the table", ".csv", [measured.with_name("other.csv")])


def test_a_file_that_nobody_named_is_replaced_only_as_it_was_written(measured: Path) -> None:
    other = measured.with_name("n.csv")
    for _ in range(2):  # the same bytes again are known once
        with pytest.raises(InputError, match=r"m\.csv: "):
            require_replaceable([other, measured], "the table")
        write_files({other: "a,b\n1,2\n"}, unnamed=[other])
    require_replaceable([other], "the table")
    assert len((measured.parent / FOLDER_RECORD).read_text().split()) == 1
    write_files({other: "a,b\n3,4\n"}, unnamed=[other])
    require_replaceable([other], "the table")
    with pytest.raises(InputError, match="would replace"):
        require_replaceable([other], "the table", [other])
    other.write_text("a,b\n3,5\n")
    with pytest.raises(InputError, match="changed since"):
        require_replaceable([other], "the table")


def test_a_set_of_results_makes_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "made"
    paths = require_results(folder, ("a.json", "b/a.csv"))
    assert not folder.exists()
    write_results(dict.fromkeys(paths, "new"))
    assert {path.name for path in folder.iterdir()} == {"a.json", "b", FOLDER_RECORD}
    assert require_results(folder, ("a.json", "b/a.csv")) == paths
    with pytest.raises(InputError, match="does not exist"):
        require_results(tmp_path / "no" / "made", ("a.json",))
    with pytest.raises(InputError, match="cannot be made"):
        write_results({tmp_path / "nul\0" / "a": ""})
    with pytest.raises(InputError, match="cannot be written"):
        write_results({tmp_path / "empty" / ("n" * 300): ""})
    assert not (tmp_path / "empty").exists()
    with pytest.raises(InputError, match="is not a folder"):
        require_results(folder / "a.json", ("a.json",))


@pytest.mark.skipif(sys.platform == "win32", reason="no locks there")
def test_the_next_run_removes_what_a_killed_one_left_and_nothing_of_one_that_lives(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    script = (
        "import os, pathlib, signal, sys\n"
        "from fes_mj.common.writing import replacing\n"
        "with replacing(pathlib.Path(sys.argv[1])):\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    subprocess.run([sys.executable, "-c", script, str(target)], check=False)
    assert len([*tmp_path.iterdir()]) == 1
    with replacing(target) as living:
        assert [*tmp_path.iterdir()] == [living]
        remove_leftovers(tmp_path)
        living.write_text("whole")
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("n" * 300 + ".csv", "File name too long"),
        ("nul\0.csv", "no file can have this name"),
        ("none/a.csv", "does not exist"),
        ("m.csv/a.csv", "is not a folder"),
        (".", "this is a folder"),
        ("a.txt", r"must end in \.csv"),
    ],
)
def test_where_no_file_can_be(name: str, words: str, measured: Path) -> None:
    with pytest.raises(InputError, match=words):
        require_writable(measured.parent / name, "the table", ".csv")


def test_files_that_belong_together_appear_together(measured: Path) -> None:
    other = measured.with_name("a.json")
    write_files({measured: "new\n", other: b"{}"})
    assert (measured.read_bytes(), other.read_bytes()) == (b"new\n", b"{}")
    assert {*measured.parent.iterdir()} == {measured, other}
    plain = measured.with_name("plain")
    plain.touch()
    assert other.stat().st_mode == plain.stat().st_mode


@pytest.mark.parametrize("failing", range(3))
def test_of_files_that_belong_together_none_appears_alone(
    failing: int, measured: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever cannot be put in its place, what stood there before stands there again, and nothing else."""
    paths = [measured, measured.with_name("b.xml"), measured.with_name("c.json")]
    (failed := paths[failing]).write_text("of somebody else")
    before = {path: path.read_text() for path in measured.parent.iterdir()}
    rename = Path.replace

    def refuse(self: Path, target: Path) -> Path:
        if target == failed:
            raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(InputError, match=f"{failed.name}: cannot be written: Operation not permitted"):
        write_files(dict.fromkeys(paths, "new"))
    assert {path: path.read_text() for path in measured.parent.iterdir()} == before


def test_a_full_disk_is_blamed_on_the_file(measured: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    other = measured.with_name("b.xml")
    for write in (lambda: write_files({other: "", measured: ""}), lambda: write_text(other, "")):
        with pytest.raises(InputError, match=r"b\.xml: cannot be written: No space left on device"):
            write()
    assert [path.read_text() for path in measured.parent.iterdir()] == ["measured"]


def test_a_folder_that_is_gone_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a\.xml: cannot be written: No such file or directory"):
        write_files({tmp_path / "gone" / "a.xml": ""})

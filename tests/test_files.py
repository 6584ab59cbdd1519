"""Reading, refusing and writing: one wording, naming file, key, value and what is allowed; files appear whole."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fes_mj import files
from fes_mj.errors import InputError
from fes_mj.files import Section, csv_text, read_csv, read_json, read_text, read_toml


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
    path.write_text("a,b\n1,2\n\n3,4\n", encoding="utf-8-sig")
    assert [*read_csv(path, "table", ("a", "b"))] == [(2, [1.0, 2.0]), (4, [3.0, 4.0])]


def test_unreadable_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path, words in (
        (tmp_path, "Is a directory"),
        (tmp_path / "none", "No such file"),
        (tmp_path / "nul\0", "no file can have this name"),
        (tmp_path / ("n" * 300), "File name too long"),
    ):
        with pytest.raises(InputError, match=f"cannot read the test file: {words}"):
            read_text(path, "test file")
    large = tmp_path / "large"
    large.write_bytes(b"12345")
    monkeypatch.setattr(files, "LARGEST_INPUT", 4)
    with pytest.raises(InputError, match="it is larger than"):
        read_text(large, "test file")


def test_a_table_reads_back(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text(csv_text({"a": [1.0, 2.5], "b": [0.1, -3e-12]}))
    assert [row for _, row in read_csv(path, "table", ("a", "b"))] == [[1.0, 0.1], [2.5, -3e-12]]


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
    from fes_mj.files import replacing

    target = tmp_path / "result.json"
    target.write_text("old")

    def interrupted() -> None:
        with replacing(target) as beside:
            beside.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]

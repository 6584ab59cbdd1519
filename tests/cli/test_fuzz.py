"""Broken input in bulk: whatever is wrong with a design file, a moments file or a flag, there is one message.

`pytest tests/cli/test_fuzz.py -m long` looks much further.
"""

import math
import random
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.common.writing import FOLDER_RECORD
from fes_mj.linkage.design import BRANCHES
from fes_mj.linkage.design_file import DESIGNS

DATA = Path(__file__).parents[2] / "fes_mj" / "data"
EXAMPLES = Path(__file__).parents[2] / "examples"
# Values that have broken a reader somewhere.
ODD = (
    *("nan", "inf", "-inf", "1e999", "-1e999", "1e-320", "0", "-0.0", "-1", "1e9", "99999999999999999999", "0x10"),
    *("true", '""', '"0.5"', "'''\n'''", "[]", "[1]", "[1, 2, 3]", "[0.1, nan]", '["a", "b"]', "[[1], 2]", "{}"),
    *("1979-05-27", "07:32:00", "half", "", "0.5 0.5", "=", "#", "\x00", "\ufeff", "\xe9", "\u202e", "\u0663", "1_0"),
    *('"left"', '"right"', '"Left"', "left", '"up"', '["left"]'),
)
ODD_FLAGS = (
    *("", " ", "nan", "-inf", "1e400", "0", "-5", "\u0663", "p1p2", "--", "-", "\xe9" * 300, "a\nb", "../..", "."),
    "/dev/null",
)

# Of these, names of files are made.
ODD_LETTERS = (
    "ab.-$[]{}<>&'\"# \\=*?%~:|\t\n\x01\x1b\x7f\xa0\u0301é自\u200d\u202e\u2028\ufeff\uffff\udc80\udcff\U0001f6b2"
)

Mutation = Callable[[random.Random, str], str]


def _bytes(source: random.Random, text: str) -> str:
    """Some characters exchanged for others."""
    letters = list(text)
    for _ in range(source.randint(1, 4)):
        letters[source.randrange(len(letters))] = source.choice("\x00\x1f\"'[]{}=,.-+eE#\n\t 09azλ\u2028")
    return "".join(letters)


def _cut(source: random.Random, text: str) -> str:
    """A piece is missing, or is there twice."""
    start, end = sorted((source.randrange(len(text)), source.randrange(len(text))))
    return text[:start] + (text[end:] if source.random() < 0.6 else text[start:end] * 2 + text[end:])


def _line(source: random.Random, text: str) -> str:
    """A line lost, doubled, moved, or joined to the next."""
    lines = text.splitlines(keepends=True)
    at = source.randrange(len(lines))
    taken = lines.pop(at)
    kind = source.randrange(4)
    if kind == 1:
        lines[at:at] = [taken, taken]
    elif kind == 2:
        lines.insert(source.randrange(len(lines) + 1), taken)
    elif kind == 3:
        lines.insert(at, taken.rstrip("\n"))
    return "".join(lines)


def _value(source: random.Random, text: str) -> str:
    """One value of a design file, or one cell of a table, is odd."""
    lines = text.splitlines()
    at = source.randrange(len(lines))
    if "=" in lines[at]:
        lines[at] = lines[at].split("=")[0] + "= " + source.choice(ODD)
    else:
        cells = lines[at].split(",")
        cells[source.randrange(len(cells))] = source.choice(ODD)
        lines[at] = ",".join(cells)
    return "\n".join(lines) + "\n"


def _key(source: random.Random, text: str) -> str:
    """A key, table or column has another name."""
    old = source.choice(
        ["R1", "R2", "R6", "R10", "branch", "gear_ratio", "linkage", "rider", "kind", "knee_Nm", "crank_angle_deg"]
    )
    return text.replace(old, source.choice(["", "R99", old.upper(), old + " ", f'"{old}"', "linkage.x"]), 1)


MUTATIONS: tuple[Mutation, ...] = (_bytes, _cut, _line, _value, _value, _key)


def broken(seed: int, original: str, count: int) -> Iterator[str]:
    """`count` damaged versions of a text, some damaged more than once."""
    source = random.Random(seed)
    for _ in range(count):
        text = original
        for _ in range(source.choice((1, 1, 1, 2, 3))):
            text = source.choice(MUTATIONS)(source, text or "\n")
        yield text


def _check_answer(code: int, capsys: pytest.CaptureFixture[str], allowed: tuple[int, ...] = (0, 2)) -> None:
    """Exit code, one message or one result, never a traceback; a warning would have raised."""
    captured = capsys.readouterr()
    said = "".join(line for line in captured.err.splitlines(keepends=True) if not line.startswith("warning: "))
    assert code in allowed, said
    assert "Traceback" not in said
    if code == 2:
        assert captured.out == ""
        assert said.startswith("fes_mj: ")
        assert len(said) < 4000
    else:
        assert said == ""
    assert (captured.out + captured.err).replace("\n", "").isprintable()


def _fuzz_designs(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
    path, refused = folder / "fuzzed.toml", 0
    originals = [(DATA / "designs" / "identified" / f"{name}.toml").read_text() for name in DESIGNS]
    originals += [text.replace("R1 =", f'branch = "{side}"\nR1 =') for text in originals for side in BRANCHES]
    for number, original in enumerate(originals):
        for text in broken(seed + number, original, count):
            path.write_text(text, encoding="utf-8", errors="surrogatepass")
            code = run(["static", str(path), "-q"])
            refused += code == 2
            _check_answer(code, capsys)
    assert list(folder.iterdir()) == [path]
    return refused


def _fuzz_moments(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
    path, refused = folder / "fuzzed.csv", 0
    original = "".join((DATA / "moments" / "p1p2.csv").read_text().splitlines(keepends=True)[::30])
    for text in broken(seed, original, count):
        path.write_text(text, encoding="utf-8")
        code = run(["static", "trt", "-q", "--moments", str(path)])
        refused += code == 2
        _check_answer(code, capsys)
    assert list(folder.iterdir()) == [path]
    return refused


def _fuzz_trials(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
    """A measurement file, its moments or its kinematics damaged; the other two as they are."""
    names, source, refused = ("trial.toml", "id.sto", "ik.mot"), random.Random(seed), 0
    originals = {name: (EXAMPLES / "trial" / name).read_text() for name in names}
    for number in range(count):
        damaged = source.choice(names)
        for name, text in originals.items():
            broken_text = next(broken(seed + number, text, 1)) if name == damaged else text
            (folder / name).write_text(broken_text, encoding="utf-8", errors="surrogatepass")
        code = run(["moments", str(folder / names[0]), "-q"])
        refused += code == 2
        _check_answer(code, capsys)
    assert {path.name for path in folder.iterdir()} == {*names}
    return refused


def _fuzz_files(
    arguments: list[str], original: Path, seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]
) -> int:
    """Damaged study and problem files: a message that names the file, before anything runs."""
    path, refused = folder / "fuzzed.toml", 0
    for text in broken(seed, original.read_text(), count):
        path.write_text(text, encoding="utf-8", errors="surrogatepass")
        code = run([path.name if argument == "FILE" else argument for argument in arguments])
        refused += code == 2
        _check_answer(code, capsys)
    return refused


def _fuzz_flags(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Commands that stop at the first bad flag: nothing may run, nothing may be written."""
    source = random.Random(seed)
    flags = {
        "static": ("--cadence", "--group", "--moments", "--dims", "--curves", "--json"),
        "simulate": ("--cadence", "--turns", "--legs", "--timestep", "--out", "--render", "--nonsense"),
        "export": ("-o", "--out", "--variant", "--cadence", "--dims"),
        "validate": ("--report", "--junit", "--video", "--group", "--cadence", "--moments"),
        "fit": ("--thigh", "--stature", "--sex", "--percentile", "--up", "--samples", "--out", "--population"),
        "stimulation": ("--cadence", "--csv", "--duty", "--dims", "--json"),
        "sing": ("--x",),
    }
    # whatever else is right, this is not, and no parser knows it
    last = {"stimulation": "--csv=none/x.csv", "validate": "--junit=none/x.xml"}
    for _ in range(count):
        command = source.choice([*flags])
        arguments = [command, *source.sample((*DESIGNS, "d9", "a.toml", *ODD_FLAGS), source.randint(0, 2))]
        for _ in range(source.randint(0, 3)):
            arguments.append(source.choice(flags[command]))
            if source.random() < 0.8:
                arguments.append(source.choice(ODD_FLAGS))
        arguments.append(last.get(command, "--moments=none.csv"))
        _check_answer(run(arguments), capsys, (2,))
    assert list(folder.iterdir()) == []


def _fuzz_names(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Files with odd names, there or not: what is printed of them can be shown."""
    source = random.Random(seed)
    design = (DATA / "designs" / "identified" / "d1.toml").read_bytes()
    moments = b"crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n"
    for _ in range(count):
        length = source.choice((0, 1, 1, 3, 8, 60, 200))
        stems = ["".join(source.choices(ODD_LETTERS, k=length)) for _ in range(2)]
        paths = [folder / f"{stem}{suffix}" for stem, suffix in zip(stems, (".toml", ".csv"), strict=True)]
        for path, content in zip(paths, (design, moments), strict=True):
            if source.random() < 0.8:
                with suppress(OSError):  # a longer name than the system takes
                    path.write_bytes(content)
        code = run(["static", str(paths[0]), "--moments", str(paths[1])])
        written = list(folder.iterdir())
        _check_answer(code, capsys, (0,) if len(written) == 2 else (2,))
        for path in written:
            path.unlink()


def _fuzz_outputs(seed: int, count: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> int:
    """Models written among inputs, links to them and files of others, all of which stay as they are."""
    source, refused = random.Random(seed), 0
    design = (DATA / "designs" / "identified" / "r1.toml").read_bytes()
    moments = b"crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n"
    stems = ("a", "b", "scene")
    for _ in range(count):
        (folder / "design.toml").write_bytes(design)
        real = folder / f"{source.choice(stems)}.{source.choice(('csv', 'xml'))}"
        real.write_bytes(moments)
        given = source.choice((real, folder / f"{source.choice(stems)}.csv"))
        if given != real and source.random() < 0.5:
            given.symlink_to(real)
        elif given != real:
            given.hardlink_to(real)
        stranger = folder / f"{source.choice(stems)}.csv"
        if not stranger.exists():
            stranger.write_text("of somebody else")
        kept = {path: path.read_bytes() for path in (folder / "design.toml", real, given, stranger)}
        out = folder / f"{source.choice(stems)}.{source.choice(('xml', 'XML', 'csv'))}"
        scene = ["--scene"] if source.random() < 0.5 else []
        code = run(["export", str(folder / "design.toml"), "--moments", str(given), "-o", str(out), *scene])
        refused += code == 2
        _check_answer(code, capsys)
        # what was named to be written may be replaced, unless it is read
        assert all(
            path.read_bytes() == content for path, content in kept.items() if path != out or path in (real, given)
        )
        assert {path.name for path in folder.iterdir() if path.name.startswith(".")} <= {FOLDER_RECORD}
        for path in folder.iterdir():
            path.unlink()
    return refused


def test_broken_design_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _fuzz_designs(1, 5, tmp_path, capsys) > 45


def test_broken_moments_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _fuzz_moments(2, 75, tmp_path, capsys) > 35


def test_broken_trials(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _fuzz_trials(4, 45, tmp_path, capsys) > 15


STUDY = ["sweep", "FILE", "-o", "no/out", "-q"]  # no such folder: what is right with the file is refused as well
PROBLEM = ["optimize", "crt", "--problem", "FILE", "--start", "d1", "-q"]  # a start of the other kind


def test_broken_study_and_problem_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert _fuzz_files(STUDY, EXAMPLES / "study.toml", 6, 30, tmp_path, capsys) == 30
    assert _fuzz_files(PROBLEM, DATA / "optimization.toml", 7, 30, tmp_path, capsys) == 30


def test_broken_flags(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    _fuzz_flags(3, 125, tmp_path, capsys)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names themselves")
def test_odd_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _fuzz_names(8, 30, tmp_path, capsys)


def test_outputs_among_inputs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert 10 < _fuzz_outputs(9, 30, tmp_path, capsys) < 30


@pytest.mark.parametrize("data", [b"", b"\xff\xfe", b"\x00" * 100, b"\xef\xbb\xbf", bytes(range(256)), b"[" * 20_000])
@pytest.mark.parametrize("name", ["a.toml", "a.csv"])
def test_bytes_that_are_no_text(data: bytes, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    arguments = ["static", str(path)] if name == "a.toml" else ["static", "d1", "--moments", str(path)]
    code = run(arguments)
    _check_answer(code, capsys)
    assert code == 2


def test_extreme_but_allowed_numbers_end_in_a_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every allowed number at its bounds: a verdict or one message, from statics to the simulated turn."""
    source = random.Random(4)
    original = (DATA / "designs" / "identified" / "d1.toml").read_text()
    bounds = {
        "gear_ratio": (1e-6, 20),
        "seat_angle": (-360, 360),
        "gamma": (-360, 360),
        "mass": (1e-9, 500),
        "R8": (0, 2),
    }
    path = tmp_path / "extreme.toml"
    for _ in range(25):
        text = original
        for key in source.sample([*bounds], 2):
            value = next(line for line in original.splitlines() if line.startswith(f"{key} = ")).split(" = ")[1]
            text = text.replace(f"{key} = {value}", f"{key} = {source.choice(bounds[key])}")
        path.write_text(text)
        code = run(["simulate", str(path), "-q"])
        captured = capsys.readouterr()
        assert code in (0, 1, 2)
        assert "Traceback" not in captured.err
        assert captured.out == ""


@pytest.mark.long
def test_moments_that_do_nothing_are_checked_like_others(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "zero.csv"
    path.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,0,0\n180,0,0\n")
    assert run(["static", "d1", "--moments", str(path), "--json"]) == 0
    assert math.isclose(float(capsys.readouterr().out.split('"power_mean_W": ')[1].split(",")[0]), 0.0)
    assert run(["simulate", "d1", "--moments", str(path), "--json"]) == 0
    assert run(["validate", "d1", "--moments", str(path), "--json"]) == 0


@pytest.mark.long
def test_thousands_of_broken_inputs(
    tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folders = [tmp_path_factory.mktemp(name) for name in ("designs", "moments", "flags", "names", "trials")]
    _fuzz_designs(1000, 70, folders[0], capsys)
    _fuzz_moments(2000, 500, folders[1], capsys)
    _fuzz_trials(20_000, 600, folders[4], capsys)
    monkeypatch.chdir(folders[1])
    _fuzz_files(STUDY, EXAMPLES / "study.toml", 5000, 200, folders[1], capsys)
    _fuzz_files(PROBLEM, DATA / "optimization.toml", 6000, 200, folders[1], capsys)
    monkeypatch.chdir(folders[2])
    _fuzz_flags(3000, 800, folders[2], capsys)
    _fuzz_outputs(9000, 100, folders[3], capsys)
    if sys.platform == "linux":
        _fuzz_names(8000, 200, folders[3], capsys)

"""Files of a page are data: read from a bundle, kept for that page alone, bounded, forgotten."""

from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.explore.uploads import LONGEST, MOST, Uploads, moments_of_bundle, read_upload
from fes_mj.moments.files import moments_csv
from tests.explore.conftest import question

P1P3 = fes_mj.load_moments("p1p3")
TRIAL = '[moments]\nfile = "{}"\n'


def bundle(toml: str, **beside: str) -> fes_mj.JointMoments:
    return read_upload(question(name="trial.toml", text=toml, beside=beside), moments_of_bundle)


def test_a_bundle_is_read_as_files_are(tmp_path: Path) -> None:
    text = moments_csv(P1P3)
    read = bundle(TRIAL.format("a b.csv"), **{"a b.csv": text})
    (tmp_path / "a b.csv").write_text(text)
    (tmp_path / "trial.toml").write_text(TRIAL.format("a b.csv"))
    other = fes_mj.load_moments(tmp_path / "trial.toml")
    assert (read.name, [*read.knee], [*read.hip]) == (other.name, [*other.knee], [*other.hip])


@pytest.mark.parametrize("key", ["file", "kinematics"])
def test_an_upload_opens_no_other_file(tmp_path: Path, key: str) -> None:
    secret = tmp_path / "secret.csv"
    secret.write_text("SECRET,b\n1,2\n")
    names = [str(secret), "/etc/hostname", "../secret.csv", "./x/../../secret.csv", "secret.csv", "trial.toml/../x"]
    for name in names:
        toml = TRIAL.format("a.csv") + f'kinematics = "{name}"' if key == "kinematics" else TRIAL.format(name)
        with pytest.raises(InputError) as refusal:
            bundle(toml, **{"a.csv": "time,knee_Nm,hip_Nm\n0,1,2\n"})
        assert str(refusal.value).startswith(f"trial.toml: it names {Path(name).name!r}")
        assert "SECRET" not in str(refusal.value)


@pytest.mark.parametrize("name", ["", ".", "..", "a/b.csv", "/a.csv", "a\0.csv", "a\n.csv", "x" * 300, 1, None])
def test_names_are_names_of_files(name: Any) -> None:
    with pytest.raises(InputError, match=r"^the page: name is "):
        read_upload(question(name=name, text=""), fes_mj.load_design)
    with pytest.raises(InputError, match=r"^the page: beside is "):
        read_upload(question(name="a.toml", text="", beside={name: ""}), fes_mj.load_design)


def test_text_that_is_no_text() -> None:
    with pytest.raises(InputError, match=r"^a.csv: "):
        read_upload(question(name="a.csv", text="\ud800"), moments_of_bundle)
    with pytest.raises(InputError, match=r"^the page: text is"):
        read_upload(question(name="a.csv"), moments_of_bundle)


def test_each_page_has_its_own_and_names_keep_their_meaning() -> None:
    uploads = Uploads()
    other = fes_mj.load_moments("p1p2")
    assert uploads.add("one", P1P3, ["p1p2"]) == "p1p3"
    assert uploads.add("one", other, ["p1p2"]) == "p1p2 2"  # the group keeps its name
    assert uploads.add("one", P1P3, []) == "p1p3 2"
    assert uploads.add("another", P1P3, []) == "p1p3"
    assert [*uploads.of("one")] == ["p1p3", "p1p2 2", "p1p3 2"]
    assert uploads.of("one")["p1p2 2"].name == "p1p2 2"
    assert uploads.of("one")["p1p2 2"].knee is other.knee
    assert [*uploads.of("another")] == ["p1p3"]
    assert uploads.of("a third") == {}


def test_they_are_bounded_and_forgotten() -> None:
    now = 0.0
    uploads = Uploads(clock=lambda: now)
    for number in range(MOST):
        uploads.add(str(number), P1P3, [])
    assert uploads.of("0")  # used last
    uploads.add("one more", P1P3, [])
    assert [bool(uploads.of(str(number))) for number in range(4)] == [True, False, True, True]
    now = LONGEST
    assert uploads.of("2")
    now += 1
    assert [bool(uploads.of(str(number))) for number in range(4)] == [False, False, True, False]

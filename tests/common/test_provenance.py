"""Where a result comes from: inputs told apart and hashed, the same command wherever it is installed."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

import fes_mj
from fes_mj.common.provenance import digest, provenance

DATA = Path(fes_mj.__file__).parent / "data"


def test_inputs_are_told_apart_and_hashed(tmp_path: Path) -> None:
    """The SHA-256 is that of the standard's own example (FIPS 180-4)."""
    own, names = tmp_path / "own.toml", ["designs/identified/d1.toml", "designs/printed/d1.toml"]
    own.write_bytes(b"abc")
    inputs = provenance([own, *(DATA / name for name in names)])["inputs"]
    assert inputs["own.toml"] == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert inputs.keys() == {"own.toml", *names}


@pytest.mark.parametrize("program", ["/usr/bin/fes_mj", "/somewhere/fes_mj/__main__.py"])
def test_the_command_is_the_same_wherever_it_is_installed(program: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", [program, "static", "d1"])
    assert provenance()["command"] == "fes_mj static d1"


def test_the_command_can_be_given_again_and_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["fes_mj", "static", "my own.toml", "\udcff\x1b"])
    assert provenance()["command"] == r"fes_mj static 'my own.toml' '\udcff\x1b'"


@dataclass(frozen=True)
class Pair:
    first: Any
    second: Any


@dataclass(frozen=True)
class Renamed:
    first: Any
    third: Any


@dataclass(frozen=True)
class Retyped:
    first: Any
    second: Any


def same(one: Any, other: Any) -> bool:
    """Whether two values hold the same, by their structure."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, dict):
        return same([*one.items()], [*other.items()])
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, Pair):
        return same((one.first, one.second), (other.first, other.second))
    return repr(one) == repr(other)


PLAIN = st.sampled_from(
    [None, True, 1, 1.0, -0.0, 0.0, 1j, "", "1", "12", b"1", Path("1"), float("nan"), np.float64(1)]
)
ARRAYS = arrays(
    st.sampled_from([np.float64, np.int64, np.int32]),
    st.sampled_from([0, 2, (2, 1), (1, 2)]),
    elements=st.integers(0, 1),
)
VALUES = st.recursive(
    PLAIN | ARRAYS,
    lambda part: (
        st.lists(part, max_size=2)
        | st.lists(part, max_size=2).map(tuple)
        | st.dictionaries(st.sampled_from("ab"), part)
        | st.builds(Pair, part, part)
    ),
    max_leaves=4,
)


@given(VALUES, VALUES)
def test_a_digest_is_shared_by_the_same_values_alone(one: Any, other: Any) -> None:
    assert (digest(one) == digest(other)) == same(one, other)


@given(VALUES)
def test_every_level_of_a_value_counts(value: Any) -> None:
    """The same parts in another nesting, under other names, in another order, as another type."""
    one, two, number = value, [value], np.arange(4.0)
    others = [
        one, two, (value,), [two], [one, one], {"a": one}, {"b": one}, {"a": one, "b": two}, {"b": two, "a": one},
        Pair(one, two), Pair(two, one), Renamed(one, two), Retyped(one, two), {"first": one, "second": two},
        {"a": number, "b": one}, {"a": number[:2], "b": one}, {"a": number.reshape(2, 2), "b": one},
        {"a": number.astype(np.float32), "b": one}, [number[:2], number[2:]], [number[:3], number[3:]],
    ]  # fmt: skip
    assert len({digest(other) for other in others}) == len(others)


def test_long_arrays_count_to_the_last_bit() -> None:
    number = np.ones(10_000)
    changed = number.copy()
    changed[5000] = np.nextafter(1.0, 2.0)
    assert digest({"a": number}) == digest({"a": number.copy()}) != digest({"a": changed})


def test_what_holds_more_than_can_be_seen_is_refused() -> None:
    for value in (len, object(), {1, 2}, np.array([object()])):
        with pytest.raises(TypeError, match="no digest of such a value"):
            digest(value)

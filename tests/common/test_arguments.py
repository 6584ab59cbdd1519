"""A wrong type is refused by name, whatever is annotated."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
import pytest

from fes_mj.common.arguments import batches, checked
from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError


@checked
def called(
    count: int = 1,
    length: float = 1.0,
    vector: complex = 1j,
    source: str | Path | None = None,
    array: FloatArray | None = None,
    names: Iterable[str] = (),
    lengths: Sequence[float] = (),
    limits: Mapping[str, float] | None = None,
    pairs: tuple[tuple[str, Any], ...] = (),
    word: Literal["one", "other"] = "one",
    progress: Callable[[int], None] = lambda _: None,
    later: float = cast("float", None),
) -> bool:
    return True


ALLOWED: dict[str, list[Any]] = {
    "count": [0, np.int64(3)],
    "length": [1, np.float32(0.5)],
    "vector": [1.0, np.complex128(1j)],
    "source": ["d1", Path("d1.toml"), None],
    "array": [np.ones(3), np.arange(3)],
    "names": [["a"], ("a",), {"a": 1}, iter(["a"])],
    "lengths": [[1, 2.0], ()],
    "limits": [{"a": 1.0}],
    "pairs": [(("a", object()),)],
    "word": ["other"],
    "progress": [print],
    "later": [None, 2.0],
}
REFUSED: dict[str, list[Any]] = {
    "count": [1.0, "1", None, np.ones(3)],
    "length": ["1", 1j, [1.0], np.ones(3), None],
    "vector": ["1j", None],
    "source": [3, ["d1"], b"d1"],
    "array": [[1.0, 2.0], np.array(["a"]), np.array([1j])],
    "names": ["a", 3, None, [1]],
    "lengths": ["12", ["1"], {1.0}],
    "limits": [{"a": "b"}, {1: 1.0}, ["a"]],
    "pairs": [[("a", 1)], (("a",),), ((1, 1),)],
    "word": ["third", ["one"]],
    "progress": [3],
    "later": ["1"],
}


@pytest.mark.parametrize("name", ALLOWED)
def test_what_is_annotated_is_allowed(name: str) -> None:
    assert all(called(**{name: value}) for value in ALLOWED[name])


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in REFUSED.items() for value in values])
def test_anything_else_is_refused_by_name_in_a_line(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"^{name} is .*; it must be of type ") as error:
        called(**{name: value})
    assert "\n" not in str(error.value)


def test_a_message_says_the_type_as_it_is_annotated() -> None:
    with pytest.raises(InputError, match=r"^source is 3; it must be of type str or Path or None$"):
        called(source=3)  # type: ignore[arg-type]


def test_arrays_stand_for_numbers_in_a_batch_alone() -> None:
    @batches
    def of_each(length: float) -> float:
        return length

    assert of_each(np.ones((3, 1))).shape == (3, 1)  # type: ignore[arg-type,attr-defined]
    with pytest.raises(InputError, match=r"^length is"):
        of_each(np.array(["1"]))  # type: ignore[arg-type]

"""All reading of files, with one wording for every refusal."""

import json
import math
import re
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from fes_mj.common.errors import InputError

DATA = Path(__file__).parents[1] / "data"  # what the package ships
LARGEST_INPUT = 64 * 2**20  # bytes; a day of measured moments is smaller


def read_bytes(path: Path, what: str) -> bytes:
    """The content of a file. Raises InputError naming the file and the reason."""
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_INPUT + 1)
    except OSError as error:
        raise InputError(f"{path}: cannot read the {what}: {error.strerror}") from None
    except ValueError:  # a NUL in the name
        raise InputError(f"{str(path)!r}: cannot read the {what}: no file can have this name") from None
    if len(data) > LARGEST_INPUT:
        raise InputError(f"{path}: cannot read the {what}: it is larger than {LARGEST_INPUT >> 20} MiB")
    return data


def read_text(path: Path, what: str) -> str:
    """The text of a UTF-8 file, with or without a byte order mark. Raises InputError naming the file and the reason."""
    try:
        return read_bytes(path, what).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: the {what} is not UTF-8 text") from None


@dataclass(frozen=True)
class Section:
    """A table of a TOML file, read key by key; every refusal names file, key, value and what is allowed."""

    path: Path
    name: str  # "" for the file itself
    content: dict[str, Any]

    def label(self, key: str) -> str:
        """The key as a user finds it in the file."""
        return f"{self.name}.{key}" if self.name else key

    def refuse(self, key: str, value: object, allowed: str) -> NoReturn:
        """Raise InputError for a value that is not allowed."""
        try:
            shown = repr(value)
        except ValueError:  # Python writes no integer of thousands of digits, as hexadecimals can be
            shown = "a number of thousands of digits"
        raise InputError(f"{self.path}: {self.label(key)} is {shown}; it must be {allowed}")

    def only(self, allowed: Iterable[str]) -> None:
        """Refuse keys that nobody reads."""
        keys = [*allowed]
        for key in self.content:
            if key not in keys:
                raise InputError(f"{self.path}: unknown key {self.label(key)}; allowed here: {', '.join(keys)}")

    def require(self, keys: Iterable[str], needs: str) -> None:
        """Refuse a table in which a key is missing."""
        for key in keys:
            if key not in self.content:
                raise InputError(f"{self.path}: {self.label(key)} is missing; {needs}")

    def value(self, key: str, default: Any, fits: Callable[[Any], bool], allowed: str) -> Any:
        """What stands at a key, or `default` where nothing does, refused unless it fits."""
        value = self.content.get(key, default)
        if not fits(value):
            self.refuse(key, value, allowed)
        return value

    def section(self, key: str) -> "Section":
        """A table below this one, empty if it is not there."""
        name = self.label(key)
        return Section(self.path, name, self.value(key, {}, lambda value: isinstance(value, dict), f"a table [{name}]"))

    def choice(self, key: str, options: Iterable[str], default: str | None = None) -> str:
        """One of some words."""
        words = [*options]
        word: str = self.value(key, default, lambda value: value in words, f"one of {', '.join(words)}")
        return word

    def switch(self, key: str) -> bool:
        """True or false, false where it is not said."""
        return bool(self.value(key, False, lambda value: isinstance(value, bool), "true or false"))

    def whole(self, key: str, default: int) -> int:
        """A whole number from 1."""
        return int(self.value(key, default, lambda value: type(value) is int and value >= 1, "a whole number from 1"))

    def number(self, key: str, low: float = -math.inf, high: float = math.inf, allowed: str = "a number") -> float:
        """A finite number within bounds."""
        value = self.value(key, None, lambda x: is_number(x) and math.isfinite(x) and low <= x <= high, allowed)
        return float(value)

    def ascending_pair(self, key: str, low: float = -math.inf, high: float = math.inf) -> tuple[float, float]:
        """[lowest, highest], both finite and within bounds."""
        value = self.value(key, None, lambda value: is_list(value, is_number, 2), "[lowest, highest]")
        for part in value:
            if not (math.isfinite(part) and low <= part <= high):
                self.refuse(key, part, "a number" if low == -math.inf else f"from {low:g} to {high:g}")
        if not value[0] < value[1]:
            raise InputError(
                f"{self.path}: {self.label(key)} is {value!r}; "
                "the bounds contradict each other, the first must be the smaller"
            )
        return float(value[0]), float(value[1])


def is_number(value: object) -> bool:
    """Whether a TOML value is a number; true and false are none, nor is an integer that no float can hold."""
    if isinstance(value, int) and not isinstance(value, bool):
        return abs(value) < 10**300
    return isinstance(value, float)


def is_list(value: object, fits: Callable[[Any], bool], count: int | None = None) -> bool:
    """Whether a TOML value is a list whose values all fit, so many where that is said."""
    return isinstance(value, list) and count in (None, len(value)) and all(map(fits, value))


def is_text(value: object) -> bool:
    """Whether a TOML value is a text."""
    return isinstance(value, str)


def read_toml(path: Path, what: str) -> Section:
    """A TOML file as the section of its top level. Raises InputError as read_text, and for what is not TOML."""
    try:
        return Section(path, "", tomllib.loads(read_text(path, what)))
    except InputError:
        raise
    except (ValueError, RecursionError) as error:  # TOMLDecodeError, numbers of thousands of digits, deep nesting
        comma = re.search(r"=\s*[-+]?\d+,\d+[ \t]*(#.*)?$", read_text(path, what), re.MULTILINE)
        hint = f"; a decimal comma? '{comma[0]}'" if comma else ""
        raise InputError(f"{path}: not valid TOML: {error}{hint}") from None


def read_json(path: Path, what: str) -> dict[str, Any]:
    """A JSON file whose top level is an object. Raises InputError as read_text, and for what is no such file."""
    try:
        content = json.loads(read_text(path, what))
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: the {what} is not valid JSON: {error}") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: the {what} must be a JSON object")
    return content

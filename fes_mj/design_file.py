"""Design files: TOML in metres and degrees, read and written; the catalogue is a folder of them."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.design import ARCHITECTURES, Design, Linkage, Rider
from fes_mj.errors import InputError
from fes_mj.segments import DE_LEVA

CATALOGUE = ("trt", "r1", "r2", "d1", "d2")
DIMENSIONS = ("identified", "printed")
_DATA = Path(__file__).parent / "data" / "designs"

# No length of a pedalling linkage or leg comes near this; a larger one is in centimetres.
LONGEST = 2.0  # m
SHORTEST = 1e-3  # m; a shorter link has no inertia that a simulation could use
_SIX_BAR, _ALL = ("crt", "cdt"), ("trt", "crt", "cdt")


@dataclass(frozen=True)
class _Key:
    """One key of a design file: the attribute it fills, what it allows, and for which kinds it is needed or allowed."""

    attribute: str
    allowed: str
    accepts: Callable[[float], bool]
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    vector: bool = False
    degrees: bool = False


def _length(value: float) -> bool:
    return SHORTEST <= value <= LONGEST


def _not_negative(value: float) -> bool:
    return 0 <= value <= LONGEST


def _any_sign(value: float) -> bool:
    return abs(value) <= LONGEST


_LENGTH = f"a length in metres from {SHORTEST:g} to {LONGEST:g}"
_VECTOR = f"[x, y] in metres, each between -{LONGEST:g} and {LONGEST:g}"
_ANGLE = "an angle in degrees between -360 and 360"
_LINKAGE_KEYS = {
    "R1": _Key("ground", _VECTOR, _any_sign, _ALL, vector=True),
    "R2": _Key("crank", _LENGTH, _length, _ALL),
    "R6": _Key("foot", f"a length in metres between -{LONGEST:g} and {LONGEST:g}", _any_sign, _ALL),
    "R7": _Key("pivot_to_crank", _VECTOR, _any_sign, _SIX_BAR, vector=True),
    "R8": _Key("pedal_arm", f"a length in metres from 0 to {LONGEST:g}", _not_negative, _SIX_BAR),
    "R9": _Key("coupler", _LENGTH, _length, _SIX_BAR),
    "R10": _Key("rocker", _LENGTH, _length, _SIX_BAR),
    "gamma": _Key("coupler_angle", _ANGLE, lambda v: abs(v) <= 360, (), ("cdt",), degrees=True),
    "gear_ratio": _Key("gear_ratio", "a ratio above 0, up to 20", lambda v: 0 < v <= 20, _ALL),
    "seat_angle": _Key("seat_angle", _ANGLE, lambda v: abs(v) <= 360, _ALL, degrees=True),
}
_RIDER_KEYS = {
    "thigh": _Key("thigh", _LENGTH, _length, (), _ALL),
    "shank": _Key("shank", _LENGTH, _length, (), _ALL),
    "mass": _Key("mass", "a mass in kg from 1 to 500", lambda v: 1 <= v <= 500, (), _ALL),
}


def load_design(source: str | Path, dims: str = "identified") -> Design:
    """A catalogued design ("trt", "r1", "r2", "d1", "d2"; dims "identified" or "printed") or a design file.

    Raises InputError naming the file, the key, the value and what is allowed.
    """
    if dims not in DIMENSIONS:
        raise InputError(f"dims is {dims!r}; it must be one of {', '.join(DIMENSIONS)}")
    if source in CATALOGUE:
        return _read(_DATA / dims / f"{source}.toml")
    path = Path(source)
    if not path.exists() and path.suffix != ".toml":
        raise InputError(
            f"{source}: no such design; it must be one of {', '.join(CATALOGUE)} or a path to a .toml file"
        )
    return _read(path)


def _read(path: Path) -> Design:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot read the design file: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: the design file is not UTF-8 text") from None
    except ValueError as error:  # TOMLDecodeError, and numbers of thousands of digits
        raise InputError(f"{path}: not valid TOML: {error}") from None
    _refuse_unknown(path, "", content, ("linkage", "rider"))
    linkage, rider = (_table(path, content, name) for name in ("linkage", "rider"))
    kind = linkage.pop("kind", None)
    if not isinstance(kind, str) or kind not in ARCHITECTURES:
        raise InputError(f"{path}: linkage.kind is {kind!r}; it must be one of {', '.join(ARCHITECTURES)}")
    sex = rider.pop("sex", Rider.sex)
    if not isinstance(sex, str) or sex not in DE_LEVA:
        raise InputError(f"{path}: rider.sex is {sex!r}; it must be one of {', '.join(DE_LEVA)}")
    return Design(
        path.stem,
        Linkage(kind, **_values(path, "linkage", linkage, _LINKAGE_KEYS, kind)),
        Rider(sex=sex, **_values(path, "rider", rider, _RIDER_KEYS, kind)),
    )


def _table(path: Path, content: dict[str, Any], name: str) -> dict[str, Any]:
    table = content.get(name, {})
    if not isinstance(table, dict):
        raise InputError(f"{path}: {name} is {table!r}; it must be a table [{name}]")
    return dict(table)


def _refuse_unknown(path: Path, prefix: str, content: dict[str, Any], known: Any) -> None:
    for key in content:
        if key not in known:
            raise InputError(f"{path}: unknown key {prefix}{key}; allowed here: {', '.join(known)}")


def _values(path: Path, table: str, content: dict[str, Any], keys: dict[str, _Key], kind: str) -> dict[str, Any]:
    """Attribute values in SI and radians of one table, every key checked."""
    known = [name for name, key in keys.items() if kind in key.required + key.optional]
    _refuse_unknown(path, f"{table}.", content, known)
    for name in known:
        if kind in keys[name].required and name not in content:
            raise InputError(f"{path}: {table}.{name} is missing; a {kind} needs {keys[name].allowed}")
    return {keys[name].attribute: _value(path, f"{table}.{name}", value, keys[name]) for name, value in content.items()}


def _value(path: Path, name: str, value: Any, key: _Key) -> Any:
    parts = value if isinstance(value, list) else [value]
    numbers = all(isinstance(part, (int, float)) and not isinstance(part, bool) for part in parts)
    shaped = isinstance(value, list) == key.vector and len(parts) == (2 if key.vector else 1)
    if not (numbers and shaped and all(key.accepts(part) for part in parts)):
        metres = "metres" in key.allowed and numbers and any(LONGEST < abs(part) < math.inf for part in parts)
        hint = " (centimetres? lengths are in metres)" if metres else ""
        raise InputError(f"{path}: {name} is {value!r}; it must be {key.allowed}{hint}")
    if key.vector:
        return complex(*parts)
    return math.radians(parts[0]) if key.degrees else float(parts[0])


def design_toml(design: Design, comment: str = "") -> str:
    """The text of a design file that reads back as `design`; `comment` goes above it, a line each."""
    kind = design.linkage.kind
    tables = {
        "linkage": (design.linkage, _LINKAGE_KEYS, [f'kind = "{kind}"']),
        "rider": (design.rider, _RIDER_KEYS, [f'sex = "{design.rider.sex}"']),
    }
    lines = [f"# {line}".rstrip() for line in comment.splitlines()]
    for table, (owner, keys, head) in tables.items():
        lines += [f"[{table}]", *head]
        for name, key in keys.items():
            if kind in key.required + key.optional:
                lines.append(f"{name} = {_written(getattr(owner, key.attribute), key)}")
    return "\n".join(lines) + "\n"


def _written(value: Any, key: _Key) -> str:
    """Shortest decimal that reads back as the same number."""
    if key.vector:
        return f"[{value.real!r}, {value.imag!r}]"
    if not key.degrees:
        return repr(float(value))
    degrees = math.degrees(value)
    for digits in range(12, 18):  # radians and back: the nearest short decimal that is the same angle
        text = np.format_float_positional(degrees, precision=digits, fractional=False, trim="0")
        if math.radians(float(text)) == value:
            return text
    return repr(degrees)

"""Where a result comes from: versions, command, inputs. No date: the same run gives the same bytes."""

import dataclasses
import hashlib
import platform
import shlex
import sys
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.reading import DATA
from fes_mj.common.text import printable


def versions(*packages: str) -> dict[str, str]:
    """Installed version by the name of a package."""
    return {package: version(package) for package in packages}


def provenance(inputs: Iterable[Path] = (), packages: Iterable[str] = ()) -> dict[str, Any]:
    """Versions (also of `packages`), command line with the program's bare name, SHA-256 of every input file by name."""
    program = Path(sys.argv[0])
    name = program.parent.name if program.name == "__main__.py" else program.name  # of `python -m` the package's
    return {
        "fes_mj": version("fes-mj"),
        "python": platform.python_version(),
        **versions("mujoco", "numpy", "scipy", *packages),
        "command": printable(shlex.join([name, *sys.argv[1:]])),
        "inputs": {_name(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in inputs},
    }


def _name(path: Path) -> str:
    """The file's place among the shipped data, or its bare name: two designs differ only by their folder."""
    return str(path.relative_to(DATA)) if path.is_relative_to(DATA) else printable(path.name)


def digest(value: Any) -> str:
    """SHA-256 of all that a value holds, its types, names and shapes, numbers to the last bit, in the order it is in.

    value: data classes, dictionaries, lists, tuples, arrays and plain values, nested. Raises TypeError for others.
    """
    return hashlib.sha256(_encoded(value)).hexdigest()


def _encoded(value: Any) -> bytes:
    """The parts of a value after the name of its type, each after its length: different values have different bytes."""
    name = type(value).__qualname__
    match value:
        case np.ndarray() if not value.dtype.hasobject:
            return _joined(name, str(value.dtype), repr(value.shape), value.tobytes())
        case list() | tuple():
            return _joined(name, *map(_encoded, value))
        case dict():
            return _joined(name, *(_encoded(part) for item in value.items() for part in item))
        case bytes() | str():
            return _joined(name, value)
        case None | bool() | int() | float() | complex() | np.generic() | Path():
            return _joined(name, repr(value))
    if dataclasses.is_dataclass(value):
        values = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        return _joined(name, _encoded(values))
    raise TypeError(f"{name}: no digest of such a value")


def _joined(*parts: str | bytes) -> bytes:
    encoded = [part.encode("utf-8", "surrogatepass") if isinstance(part, str) else part for part in parts]
    return b"".join(len(part).to_bytes(8) + part for part in encoded)

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


def provenance(inputs: Iterable[Path] = (), packages: Iterable[str] = ()) -> dict[str, Any]:
    """Versions (also of `packages`), command line with the program's bare name, SHA-256 of every input file by name."""
    return {
        "fes_mj": version("fes-mj"),
        "python": platform.python_version(),
        **{package: version(package) for package in ("mujoco", "numpy", "scipy", *packages)},
        "command": printable(shlex.join([_program(Path(sys.argv[0])), *sys.argv[1:]])),
        "inputs": {_name(path): hashlib.sha256(path.read_bytes()).hexdigest() for path in inputs},
    }


def _program(path: Path) -> str:
    """The script's name; of `python -m package` the package's."""
    return path.parent.name if path.name == "__main__.py" else path.name


def _name(path: Path) -> str:
    """The file's place among the shipped data, or its bare name: two designs differ only by their folder."""
    return str(path.relative_to(DATA)) if path.is_relative_to(DATA) else printable(path.name)


def digest(value: Any) -> str:
    """SHA-256 of all that a value holds, numbers to the last bit: nested data classes, arrays, tuples, plain values."""
    if isinstance(value, np.ndarray):
        content = value.tobytes()
    elif isinstance(value, (list, tuple)):
        content = "".join(map(digest, value)).encode()
    elif dataclasses.is_dataclass(value):
        content = "".join(digest(getattr(value, field.name)) for field in dataclasses.fields(value)).encode()
    elif hasattr(value, "__dict__"):
        content = "".join(map(digest, vars(value).values())).encode()
    else:
        content = repr(value).encode()
    return hashlib.sha256(content).hexdigest()

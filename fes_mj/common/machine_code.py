"""Functions in machine code where numba is installed (extra `optimize`); elsewhere Python runs the same functions."""

import hashlib
import sys
from collections.abc import Callable, Iterable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

Function = TypeVar("Function", bound=Callable[..., Any])
Structure = TypeVar("Structure")

COMPILED = find_spec("numba") is not None


def machine_code(function: Function) -> Function:
    """The function in machine code, made when it is first called or a caller's is made."""
    return _njit(function)


def inlined_machine_code(function: Function) -> Function:
    """The same as a part of each caller: a call hands on all arrays of a named tuple, which takes as long as a sum."""
    return _njit(function, forceinline=True)


def kept_machine_code(*structures: type) -> Callable[[Function], Function]:
    """The same, kept on disk between processes: of a function that Python calls. structures: named tuples it is given.

    Its machine code holds that of every function it calls, but numba looks for changes in its own file alone, and reads
    what it kept before it looks. So a digest of all these files is a part of the name under which it is kept.
    """

    def keep(function: Function) -> Function:
        if not COMPILED:
            return function
        function.__qualname__ += f"_{_digest(function, structures)}"
        try:
            return _njit(function, cache=True)
        except RuntimeError:  # nowhere to write to: made anew by every process
            return _njit(function)

    return keep


def _digest(function: Callable[..., Any], structures: Iterable[type]) -> str:
    """Of the files in which the machine code that a function calls, and the named tuples that it is given, stand; the
    same whatever else was imported before.
    """
    files, scopes = set(), [function.__globals__]
    while scopes:
        for called in [value.py_func for value in scopes.pop().values() if hasattr(value, "py_func")]:
            if called.__code__.co_filename not in files:
                files.add(called.__code__.co_filename)
                scopes.append(called.__globals__)
    files |= {str(sys.modules[structure.__module__].__file__) for structure in structures}
    return hashlib.sha256(b"".join(Path(file).read_bytes() for file in sorted(files))).hexdigest()[:16]


def _njit(function: Function, **options: bool) -> Function:
    if not COMPILED:
        return function
    compiled: Function = import_module("numba").njit(nogil=True, **options)(function)
    return compiled


def readable(value: Structure) -> Structure:
    """A named tuple of arrays as these functions read it: `in_lists` where Python runs them."""
    return value if COMPILED else in_lists(value)


def in_lists(value: Structure) -> Structure:
    """A named tuple of arrays with lists in their place, which Python reads ten times faster."""
    if isinstance(value, np.ndarray):
        return cast("Structure", value.tolist())
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return cast("Structure", type(value)(*map(in_lists, value)))
    return value

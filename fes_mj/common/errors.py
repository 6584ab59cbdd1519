"""The ways a request can be refused; the command line turns each into one message and an exit code."""

import math
from collections.abc import Collection
from importlib import import_module
from types import ModuleType


class InputError(ValueError):
    """Something the user gave cannot be used (exit code 2). The message names it and what is allowed.

    >>> fes_mj.load_design("d9")
    Traceback (most recent call last):
        ...
    fes_mj.common.errors.InputError: d9: no such design; it must be one of trt, r1, r2, d1, d2 or a path to a .toml file
    """


class AssemblyError(InputError):
    """A linkage whose links cannot close over the whole turn of the crank.

    >>> stretched = fes_mj.load_design("trt").with_linkage(crank=0.4)
    >>> fes_mj.quasi_static(stretched, fes_mj.load_moments("p1p2"))
    Traceback (most recent call last):
        ...
    fes_mj.common.errors.AssemblyError: trt: thigh and shank cannot close at crank angle ...
    """


class MissingPartError(RuntimeError):
    """A needed part of the installation is absent (exit code 3). The message says how to install it.

    >>> fes_mj.common.errors.require_extra("report", "no_such_package")
    Traceback (most recent call last):
        ...
    fes_mj.common.errors.MissingPartError: no_such_package is not installed; it comes with: pip install 'fes-mj[report]'
    """


class UnstableError(RuntimeError):
    """A simulation that broke down (exit code 1).

    >>> one = np.ones(2)
    >>> fes_mj.simulate(fes_mj.load_design("d1"), fes_mj.JointMoments("huge", 0 * one, 1e13 * one, one))
    Traceback (most recent call last):
        ...
    fes_mj.common.errors.UnstableError: d1: the simulation became unstable with a time step of 0.216 ms; ...
    """


def require_one_of(name: str, value: object, allowed: Collection[str]) -> None:
    """Raise InputError for a word that is none of those allowed."""
    if value not in allowed:
        raise InputError(f"{name} is {value!r}; it must be one of {', '.join(allowed)}")


def require_within(name: str, value: float, low: float, high: float = math.inf, unit: str = "") -> None:
    """Raise InputError for a number that is not finite or not from low to high, ends included, all in the unit."""
    if not (low <= value <= high and math.isfinite(value)):
        allowed = f"from {low:g} to {high:g}"
        if high == math.inf:
            allowed = f"at least {low:g}" if low > -math.inf else "finite"
        raise InputError(f"{name} is {value:g} {unit}".rstrip() + f"; it must be {allowed} {unit}".rstrip())


def require_extra(extra: str, *modules: str) -> ModuleType:
    """Import modules of an optional package and return the first.

    Raises MissingPartError with the command that installs the one that is not there.
    """
    try:
        imported = [import_module(module) for module in modules]
    except ModuleNotFoundError as error:
        package = (error.name or modules[0]).partition(".")[0]
        raise MissingPartError(f"{package} is not installed; it comes with: pip install 'fes-mj[{extra}]'") from None
    return imported[0]

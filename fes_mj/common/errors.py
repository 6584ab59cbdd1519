"""The ways a request can be refused; the command line turns each into one message and an exit code."""

from importlib import import_module
from types import ModuleType


class InputError(ValueError):
    """Something the user gave cannot be used (exit code 2). The message names it and what is allowed."""


class AssemblyError(InputError):
    """A linkage whose links cannot close over the whole turn of the crank."""


class MissingPartError(RuntimeError):
    """A needed part of the installation is absent (exit code 3). The message says how to install it."""


class UnstableError(RuntimeError):
    """A simulation that broke down (exit code 1)."""


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

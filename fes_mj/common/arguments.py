"""What Python users pass, against what is annotated: a wrong type is refused by name before it breaks something inside.

Only for the public names; what is checked there is not checked again below. Numbers out of range are refused where
their range is known (errors.require_within).
"""

import re
from collections.abc import Callable, Collection, Mapping
from functools import cache, partial, wraps
from inspect import Parameter, formatannotation, signature
from numbers import Complex, Integral, Real
from types import GenericAlias, NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from fes_mj.common.errors import InputError

Called = TypeVar("Called", bound=Callable[..., Any])

# Numbers of numpy are as good as Python's.
_NUMBERS = {int: Integral, float: Real, complex: Complex}


def checked(called: Called, arrays: bool = False) -> Called:
    """A function, or a class, that raises InputError for an argument of another type than is annotated.

    And for one that it does not have, or that is missing. The default itself is always allowed. arrays: so are arrays
    in place of numbers, which make a batch.
    """
    if isinstance(called, type):
        called.__init__ = checked(called.__init__, arrays)  # type: ignore[misc]
        return called
    parameters = signature(called)

    @cache
    def types() -> dict[str, Any]:
        hints = get_type_hints(called)
        for name, one in parameters.parameters.items():
            if one.kind == Parameter.VAR_POSITIONAL:
                hints[name] = GenericAlias(tuple, (hints[name], ...))
            if one.kind == Parameter.VAR_KEYWORD:  # for another function, which looks at them
                hints[name] = Any
        return hints

    @wraps(called)
    def call(*positional: Any, **named: Any) -> Any:
        try:
            given = parameters.bind(*positional, **named).arguments
        except TypeError as error:
            raise InputError(f"{called.__qualname__.removesuffix('.__init__')}: {error}") from None
        for name, value in given.items():
            allowed = types().get(name, Any)
            if type(value) is allowed or value is parameters.parameters[name].default:  # of most, and fast
                continue
            if not (_is(value, allowed) or (arrays and allowed in _NUMBERS and _is_array(value, "iufc"))):
                raise InputError(f"{name} is {_shown(value)}; it must be of type {_name(allowed)}")
        return called(*positional, **named)

    return call  # type: ignore[return-value]


batches = partial(checked, arrays=True)


def _is(value: object, allowed: Any) -> bool:
    """Whether a value is of an annotated type, in containers each of its items."""
    kind, parts = get_origin(allowed), get_args(allowed)
    if allowed is Any:
        return True
    if kind in (Union, UnionType):
        return any(_is(value, part) for part in parts)
    if kind is Literal:
        return isinstance(value, (str, int)) and value in parts
    if kind is np.ndarray:
        return _is_array(value)
    if kind in (None, type, Callable):
        return isinstance(value, _NUMBERS.get(allowed, kind or allowed))
    if not isinstance(value, kind) or isinstance(value, str):
        return False
    if kind is tuple and parts[-1] is not ...:
        return len(value) == len(parts) and all(map(_is, value, parts))
    if issubclass(kind, Mapping):
        return all(all(map(_is, pair, parts)) for pair in value.items())
    return not isinstance(value, Collection) or all(_is(item, parts[0]) for item in value)


def _is_array(value: object, kinds: str = "iuf") -> bool:
    """Whether it is an array of real numbers, or of those of other kinds (numpy.dtype.kind)."""
    return isinstance(value, np.ndarray) and value.dtype.kind in kinds


def _shown(value: object) -> str:
    """In a line of no more than a few words."""
    text = " ".join(repr(value).split())
    return text if len(text) < 80 else f"{text[:76]} ..."


def _name(allowed: Any) -> str:
    """As in the annotation, without modules."""
    if get_origin(allowed) in (Union, UnionType):
        return " or ".join(map(_name, get_args(allowed)))
    if get_origin(allowed) is np.ndarray:
        return "ndarray"
    return "None" if allowed is NoneType else re.sub(r"\w+\.(?=\w)", "", formatannotation(allowed))

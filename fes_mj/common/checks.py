"""Every check of the harness by name: its limit and why, what it guards against, what usually breaks it."""

import difflib
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, read_toml

_FILE = DATA / "checks.toml"
# A leg that delivers less than this is held to the limits of this much: what discretisation leaves behind does not
# vanish with the mean, the masses swing a hundred watts to and fro all the same.
LEAST_POWER = 10.0  # W


def power_scale(power_mean: float) -> float:
    """What relative limits refer to: the mean power of one leg, W, but no less than LEAST_POWER."""
    return max(abs(power_mean), LEAST_POWER)


@dataclass(frozen=True)
class Definition:
    """One row of data/checks.toml."""

    name: str
    kind: str  # cross-check, code verification, solution verification, benchmark, consistency
    quantity: str  # what is measured, in words
    limit: float
    unit: str  # "" is relative or a count
    reason: str  # why this limit
    guards: str
    breaks: str


class Check(NamedTuple):
    """One comparison: a value that must stay at or below its limit, both in `unit`; subject says of what."""

    name: str
    value: float
    limit: float
    unit: str = ""
    subject: str = ""

    @property
    def ok(self) -> bool:
        return self.value <= self.limit  # NaN is not

    @property
    def factor(self) -> float:
        """By how many times its limit the value is; infinite beyond a limit of zero, and for NaN."""
        if self.limit > 0 and self.value == self.value:
            return self.value / self.limit
        return 0.0 if self.ok else float("inf")

    def as_json(self) -> dict[str, Any]:
        """The check as JSON names it."""
        return self._asdict() | {"ok": self.ok}


@cache
def definitions() -> dict[str, Definition]:
    """All checks by name, in the order of the file."""
    rows = read_toml(_FILE, "checks").content
    return {name: Definition(name, **row) for name, row in rows.items()}


def check(name: str, value: float, subject: str = "") -> Check:
    """A measured value beside the limit that its name stands for."""
    definition = definitions()[name]
    return Check(name, float(value), definition.limit, definition.unit, subject)


def find(name: str) -> Definition:
    """The check of a name, however it is spaced. Raises InputError, with the nearest names, if there is none."""
    key = name.strip().lower().replace(" ", "_").replace("-", "_")
    if key not in definitions():
        near = difflib.get_close_matches(key, definitions(), n=3)
        hint = f"did you mean {' or '.join(near)}?" if near else f"it must be one of {', '.join(definitions())}"
        raise InputError(f"{name}: no such check; {hint}")
    return definitions()[key]

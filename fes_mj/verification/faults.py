"""Realistic mistakes, each put into the real pipeline on its own, and the checks that notice it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any, NamedTuple
from unittest import mock

from fes_mj.checks import Check, criteria
from fes_mj.design import Design
from fes_mj.errors import AssemblyError
from fes_mj.verification.case import Case
from fes_mj.verification.suite import FULL, QUICK, Stage, verify


class Patch(NamedTuple):
    """A replacement of one attribute of a module or class, wherever it was imported to unless `here_only`."""

    owner: Any
    attribute: str
    change: Callable[[Any], Any]  # original -> replacement
    here_only: bool = False


class Fault(NamedTuple):
    """A mistake, the check that stands guard against it, and how it is made: in the code or in the design file."""

    name: str
    mistake: str
    guard: str
    patches: tuple[Patch, ...] = ()
    edit: Callable[[Design], Design] | None = None


class Verdict(NamedTuple):
    """What a fault did: the failed checks in the order they ran (those alone that pass without it)."""

    fault: Fault
    failed: tuple[Check, ...]

    @property
    def caught(self) -> bool:
        return bool(self.failed)

    @property
    def guarded(self) -> bool:
        """Whether the check that is there for it noticed."""
        return self.fault.guard in {each.name for each in self.failed}

    @property
    def first(self) -> Check | None:
        """The first check that noticed."""
        return self.failed[0] if self.failed else None

    def as_json(self) -> dict[str, Any]:
        """The verdict with the first check that noticed and how far beyond its limit it was (null: infinitely)."""
        return {
            "name": self.fault.name,
            "mistake": self.fault.mistake,
            "caught": self.caught,
            "check": self.first.name if self.first else None,
            "factor": self.first.factor if self.first else None,
            "guard": self.fault.guard,
            "caught_by_guard": self.guarded,
            "failed": {each.name: each.factor for each in reversed(self.failed)},
        }


@contextmanager
def injected(fault: Fault) -> Iterator[None]:
    """Make the mistake for the length of a `with` block; everything is put back afterwards, whatever happens."""
    with ExitStack() as stack:
        for patch in fault.patches:
            original = vars(patch.owner)[patch.attribute]
            replacement = patch.change(original)
            owners = {patch.owner} if patch.here_only else {patch.owner, *_importers(patch.attribute, original)}
            for owner in owners:
                stack.enter_context(mock.patch.object(owner, patch.attribute, replacement))
        yield


def _importers(attribute: str, original: Any) -> list[Any]:
    """Modules of this package that bound `original` to the same name by `from ... import`."""
    modules = [module for name, module in sys.modules.items() if name.startswith("fes_mj.")]
    return [module for module in modules if vars(module).get(attribute) is original]


def inject(fault: Fault, case: Case, baseline: dict[str, bool]) -> Verdict:
    """Run the suite on a case under one fault. baseline: check name -> whether it passes without."""
    failed: list[Check] = []
    with injected(fault):
        edited = case._replace(design=fault.edit(case.design)) if fault.edit else case
        # a file with another gear ratio rides at another cadence
        faulty = edited._replace(cadence=edited.design.linkage.cadence)
        with suppress(AssemblyError):  # `loop_closure` has noticed before the model could be built
            failed += (each for each in verify(faulty, _stages(fault)) if not each.ok and baseline.get(each.name))
    return Verdict(fault, tuple(failed))


def _stages(fault: Fault) -> tuple[Stage, ...]:
    """The quick suite, and refinement for what only refinement can see."""
    return FULL if criteria()[fault.guard].kind == "solution verification" else QUICK


def passing(case: Case) -> dict[str, bool]:
    """Check name -> whether it passes on the case as it is, whatever it is measured on."""
    passes: dict[str, bool] = {}
    for each in verify(case, FULL):
        passes[each.name] = each.ok and passes.get(each.name, True)
    return passes

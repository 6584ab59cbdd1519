"""Realistic mistakes, each put into the pipeline of a case on its own, and the checks that notice it.

The steps are methods of crosscheck.pipeline.Pipeline. A fault replaces one of them in a subclass, or edits the design;
nothing else is touched, so nothing has to be put back.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

from fes_mj.common.checks import Check, definitions
from fes_mj.common.errors import AssemblyError
from fes_mj.linkage.design import Design
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import FULL, QUICK, Stage, verify


class Fault(NamedTuple):
    """A mistake, the check that stands guard against it, and how it is made.

    steps: step of the pipeline -> what takes its place. edit: of the design, which only printed values can tell from
    the right one. kinds: linkages that can have it.
    """

    name: str
    mistake: str
    guard: str
    steps: Mapping[str, Any] = {}
    edit: Callable[[Design], Design] | None = None
    kinds: tuple[str, ...] = ("trt", "crt", "cdt")

    def applies(self, case: VerificationCase) -> bool:
        """Whether the mistake can be made in this case, and be noticed."""
        return case.design.linkage.kind in self.kinds and (self.edit is None or case.expected is not None)

    def put_into(self, case: VerificationCase) -> VerificationCase:
        """The case with the mistake in it; nothing measured of the original is taken over."""
        design = self.edit(case.design) if self.edit else case.design
        return replace(case, design=design, pipeline=type("FaultyPipeline", (case.pipeline,), dict(self.steps)))


class Detection(NamedTuple):
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
        """The detection with the first check that noticed and how far beyond its limit it was (null: infinitely)."""
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


def inject(fault: Fault, case: VerificationCase, baseline: Mapping[str, bool]) -> Detection:
    """Run the suite on a case with one fault in it. baseline: check name -> whether it passes without."""
    failed: list[Check] = []
    with suppress(AssemblyError):  # `loop_closure` has noticed before the model could be built
        failed += (
            each for each in verify(fault.put_into(case), _stages(fault)) if not each.ok and baseline.get(each.name)
        )
    return Detection(fault, tuple(failed))


def _stages(fault: Fault) -> tuple[Stage, ...]:
    """The quick suite, and refinement for what only refinement can see."""
    return FULL if definitions()[fault.guard].kind == "solution verification" else QUICK


def passing(case: VerificationCase) -> dict[str, bool]:
    """Check name -> whether it passes on the case as it is, whatever it is measured on."""
    passes: dict[str, bool] = {}
    for each in verify(case, FULL):
        passes[each.name] = each.ok and passes.get(each.name, True)
    return passes

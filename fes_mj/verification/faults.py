"""Realistic mistakes, each put into the pipeline of a case on its own, and the checks that notice it.

The steps are methods of crosscheck.pipeline.Pipeline. A fault replaces one of them in a subclass, or edits the design;
nothing else is touched, so nothing has to be put back.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple, TypeAlias

from fes_mj.common.checks import Check, definitions
from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import ALL
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import (
    FULL_CHECKS,
    QUICK_CHECKS,
    CheckGroup,
    refinement_checks,
    ride_checks,
    two_leg_checks,
    verify,
)

Steps: TypeAlias = dict[str, Any]  # step of a pipeline or of a RideCase -> what takes its place


class Fault(NamedTuple):
    """A mistake, the checks that stand guard against it, and how it is made.

    steps: step of the pipeline -> what takes its place. ride_steps: the same of a RideCase. edit: of the design where
    its file is read. kinds: linkages that can have it. drive: what must drive them, "moments" or "muscles", if it
    matters. legs: how many there must be for it to show.
    """

    name: str
    mistake: str
    guards: Sequence[str]
    steps: Mapping[str, Any] = {}
    ride_steps: Mapping[str, Any] = {}
    edit: Callable[[Design], Design] | None = None
    kinds: Sequence[str] = ALL
    drive: str = ""
    legs: int = 1

    def applies(self, case: VerificationCase) -> bool:
        """Whether the mistake can be made in this case, and be noticed."""
        edited = self.edit is None or (case.file is not None and self.edit(case.design) != case.design)
        driven = self.drive in ("", "moments" if isinstance(case.drive, JointMoments) else "muscles")
        ridden = not self.ride_steps or bool(case.rides)
        return case.design.linkage.kind in self.kinds and edited and driven and ridden

    @property
    def groups(self) -> tuple[CheckGroup, ...]:
        """Of the suite, those that can notice: the rides, or the quick ones and what only refinement can see."""
        if self.ride_steps:
            return (ride_checks,)
        if self.legs > 1:
            return (two_leg_checks,)
        refined = any(definitions()[guard].kind == "solution verification" for guard in self.guards)
        return (*QUICK_CHECKS, refinement_checks) if refined else QUICK_CHECKS

    def put_into(self, case: VerificationCase) -> VerificationCase:
        """The case with the mistake in it; nothing measured of the original is taken over but its rides' time steps.

        A ride that fails is made finer, for which no step is small enough here.
        """
        design = self.edit(case.design) if self.edit else case.design
        pipeline = type("FaultyPipeline", (case.pipeline,), dict(self.steps))
        faulty = replace(case, design=design, pipeline=pipeline, ride_steps=self.ride_steps)
        if not self.ride_steps:
            return faulty
        return replace(faulty, ride_timesteps=tuple(ride.simulation.timestep for ride in case.rides))


def in_model(kind: str, name: str = "", **changes: Any) -> Steps:
    """Change attributes of elements of a kind ("bodies", ...) of the MuJoCo model: of all or of the one with this name.

    changes: a new value, or a function of the old one. The kind "option" and "compiler" are elements themselves.
    """

    def edit(_: object, spec: Any) -> None:
        elements = getattr(spec, kind)
        for element in elements if hasattr(elements, "__len__") else [elements]:
            for attribute, new in changes.items() if name in ("", getattr(element, "name", "")) else ():
                setattr(element, attribute, new(getattr(element, attribute)) if callable(new) else new)

    return {"edit_model": edit}


class Detection(NamedTuple):
    """What a fault did: the failed checks in the order they ran (those alone that pass without it)."""

    fault: Fault
    failed: tuple[Check, ...]

    @property
    def caught(self) -> bool:
        return bool(self.failed)

    @property
    def guarded(self) -> bool:
        """Whether a check that is there for it noticed."""
        return bool({*self.fault.guards} & {check.name for check in self.failed})

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
            "guards": [*self.fault.guards],
            "caught_by_guard": self.guarded,
            "failed": {check.name: check.factor for check in reversed(self.failed)},
        }


def inject(fault: Fault, case: VerificationCase, baseline: Mapping[str, bool]) -> Detection:
    """Run the suite on a case with one fault in it. baseline: check name -> whether it passes without."""
    failed: list[Check] = []
    with suppress(InputError):  # of a design that is refused; the checks of its geometry have noticed before
        failed += (
            check for check in verify(fault.put_into(case), fault.groups) if not check.ok and baseline.get(check.name)
        )
    return Detection(fault, tuple(failed))


def passing(case: VerificationCase) -> dict[str, bool]:
    """Check name -> whether it passes on the case as it is, whatever it is measured on."""
    passes: dict[str, bool] = {}
    for check in verify(case, FULL_CHECKS):
        passes[check.name] = check.ok and passes.get(check.name, True)
    return passes

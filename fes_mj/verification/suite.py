"""Which checks are run, in which order: from the linkage over the model to the simulated turn and its refinement."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from fes_mj.checks import Check, check
from fes_mj.errors import UnstableError
from fes_mj.verification.case import Case
from fes_mj.verification.dynamic import dynamic_checks, two_leg_checks
from fes_mj.verification.geometry import geometry_checks, paper_checks
from fes_mj.verification.model import map_checks, model_checks
from fes_mj.verification.problems import chain_checks, four_bar_checks
from fes_mj.verification.references import exact_checks
from fes_mj.verification.refinement import refinement_checks


class Stage(NamedTuple):
    """Checks that belong together."""

    title: str
    run: Callable[[Case], list[Check]]


QUICK = (
    Stage("geometry", geometry_checks),
    Stage("torque map", map_checks),
    Stage("references", exact_checks),
    Stage("model", model_checks),
    Stage("simulated turn", dynamic_checks),
    Stage("paper", paper_checks),
)
FULL = (*QUICK, Stage("two legs", two_leg_checks), Stage("refinement", refinement_checks))

BENCHMARKS = {"A02": chain_checks, "four-bar": four_bar_checks}


def verify(case: Case, stages: tuple[Stage, ...] = QUICK) -> Iterator[Check]:
    """Run the checks of a case, stage by stage. Raises AssemblyError if its linkage does not close."""
    for stage in stages:
        try:
            yield from stage.run(case)
        except UnstableError:
            yield case.check("stability", math.inf)


def benchmarks() -> Iterator[Check]:
    """Run the published problems, which do not depend on a case."""
    for subject, run in BENCHMARKS.items():
        try:
            yield from run(subject)
        except UnstableError:
            yield check("stability", math.inf, subject)

"""The numbers behind the verdicts of one case, for tables, plots and JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from fes_mj.crosscheck import CrossCheck, cross_check, power_scale
from fes_mj.verification.case import Case
from fes_mj.verification.energy import Audit, audit
from fes_mj.verification.references import Curves, differences, measured_curves
from fes_mj.verification.refinement import Refinement, refine


@dataclass(frozen=True)
class Details:
    """One case: the cross-checked run, crank moment by every method, where the energy went, the refined runs."""

    case: Case
    result: CrossCheck
    curves: dict[str, Curves]  # by family
    audit: Audit
    refinement: Refinement | None  # none in a quick run

    @property
    def uncertainty(self) -> float:
        """Numerical uncertainty of the mean power, W; NaN without refinement."""
        return self.refinement.uncertainty * power_scale(self.result.static) if self.refinement else math.nan

    def summary(self) -> dict[str, Any]:
        """The case as the row of a table of runs."""
        run, static = self.result.simulation, self.result.static
        return {
            "design": self.case.design.name,
            "group": self.case.moments.name,
            "cadence_rpm": self.case.cadence * 30 / math.pi,
            "power_mean_W": run.power_mean,
            "numerical_uncertainty_W": self.uncertainty,
            "static_power_mean_W": static.power_mean,
            "relative_difference": self.result.relative_difference,
            "work_per_turn_J": static.work_per_turn,
            "loop_gap_max_m": run.loop_gap_max,
        }

    def as_json(self) -> dict[str, Any]:
        """Everything but the curves."""
        return self.summary() | {
            "crank_moment_differences_Nm": {
                family: {f"{one} - {other}": value for (one, other), value in differences(curves).items()}
                for family, curves in self.curves.items()
            },
            "energy_J": self.audit.terms,
            "refinement": self.refinement.as_json() if self.refinement else None,
        }


def details(case: Case, thorough: bool) -> Details:
    """Run a case again for its numbers; `thorough` refines it too."""
    result, ledger = cross_check(case.design, case.moments, cadence=case.cadence), audit(case)
    return Details(case, result, measured_curves(case, ledger, result), ledger, refine(case) if thorough else None)

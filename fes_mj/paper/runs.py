"""The runs that tables and figures share: every design of the paper under both groups' moments, static and dynamic."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fes_mj.common.errors import AssemblyError
from fes_mj.crosscheck.turn_case import Case
from fes_mj.fit.population import PopulationFit, fit_population
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.paper import error_budget, identification, riding
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.known import Known, known
from fes_mj.statics.turn import QuasiStatic, quasi_static

# Simulations, populations, rides ...
RUNS = (2 * len(GROUPS) + 1) * len(DESIGNS) + riding.STEPS + error_budget.STEPS + identification.STEPS


@dataclass(frozen=True)
class Runs:
    """By (design, group): statics with identified and with printed dimensions (None where the print cannot turn), with
    Hill's torque-velocity relation, and the checked simulations by (design, group, legs). Who can ride, by design,
    and how they ride. What each unknown contributes, by (design, group). What is known of the moments, and
    what other readings of the paper come to.
    """

    known: Known
    static: dict[tuple[str, str], QuasiStatic]
    printed: dict[tuple[str, str], QuasiStatic | None]
    hill: dict[tuple[str, str], QuasiStatic]
    dynamic: dict[tuple[str, str, int], Case]
    people: dict[str, PopulationFit]
    rides: list[riding.Riding]
    budgets: error_budget.Budgets
    readings: dict[str, dict[str, str]]


def run_all(done: Callable[[], None]) -> Runs:
    """Solve and simulate everything; `done` is called RUNS times."""
    runs = Runs(known(load_evidence()), {}, {}, {}, {}, {}, riding.ride_all(done), {}, identification.read_all(done))
    moments = {group: load_moments(group) for group in GROUPS}
    for name in DESIGNS:
        for group in GROUPS:
            key, design = (name, group), load_design(name)
            runs.static[key] = quasi_static(design, moments[group])
            runs.hill[key] = quasi_static(design, replace(moments[group], torque_velocity=load_torque_velocity("hill")))
            try:
                runs.printed[key] = quasi_static(load_design(name, "printed"), moments[group])
            except AssemblyError:
                runs.printed[key] = None
            for legs in (1, 2):
                runs.dynamic[name, group, legs] = Case(design, moments[group], legs=legs)
                done()
        runs.people[name] = fit_population(load_design(name), moments[GROUPS[0]])
        done()
    runs.budgets.update(error_budget.draw_all(runs.static, done))
    return runs


def joint_speed(result: QuasiStatic, joint: str) -> tuple[float, float]:
    """Mean and peak absolute speed of a joint over the turn, rad/s."""
    speed = result.cadence * np.abs(result.motion.joint_rate[joint])
    return float(speed.mean()), float(speed.max())

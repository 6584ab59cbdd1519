"""The runs that tables and figures share: every design of the paper under both groups' moments, static and dynamic."""

from contextlib import suppress
from dataclasses import dataclass
from itertools import product

import numpy as np

from fes_mj.budget.answer import Answer, answer
from fes_mj.common.console import track
from fes_mj.common.errors import AssemblyError
from fes_mj.crosscheck.turn_case import Case
from fes_mj.fit.population import PopulationFit, fit_population
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.riders import load_riders
from fes_mj.paper import error_budget, identification, riding
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.known import Known, known
from fes_mj.statics.turn import QuasiStatic, quasi_static


@dataclass(frozen=True)
class Runs:
    """By (design, group): statics with identified and with printed dimensions (where the print can turn), both numbers
    of each, and what each unknown contributes; by (design, group, legs) the checked simulations. Who can ride, by
    design, and how they ride. What is known of the moments, and what other readings of the paper come to.
    """

    known: Known
    static: dict[tuple[str, str], QuasiStatic]
    printed: dict[tuple[str, str], QuasiStatic]
    dynamic: dict[tuple[str, str, int], Case]
    answers: dict[tuple[str, str], Answer]
    people: dict[str, PopulationFit]
    rides: list[riding.Riding]
    budgets: error_budget.Budgets
    readings: dict[str, dict[str, str]]


def run_all(silent: bool) -> Runs:
    """Solve and simulate everything, with a bar for each kind of run unless `silent`."""
    readings, rides = identification.read_all(silent), riding.ride_all(silent)
    moments = {group: load_moments(group) for group in RIDER_GROUPS}
    static, printed = {}, {}
    dynamic: dict[tuple[str, str, int], Case] = {}
    for name, group in product(DESIGNS, RIDER_GROUPS):
        key, design = (name, group), load_design(name)
        static[key] = quasi_static(design, moments[group])
        with suppress(AssemblyError):
            printed[key] = quasi_static(load_design(name, "printed"), moments[group])
        dynamic |= {(*key, legs): Case(design, moments[group], legs=legs) for legs in (1, 2)}
    for case in track([*dynamic.values()], "simulations", silent):
        _ = case.checks  # what pages read is computed here, where the bar shows it
    answers = {
        key: answer(result.design, [result], load_riders(key[1]))
        for key, result in track([*static.items()], "riders", silent)
    }
    people = {
        name: fit_population(load_design(name), moments[RIDER_GROUPS[0]])
        for name in track(DESIGNS, "populations", silent)
    }
    budgets = error_budget.draw_all(static, silent)
    return Runs(known(load_evidence()), static, printed, dynamic, answers, people, rides, budgets, readings)


def joint_speed(result: QuasiStatic, joint: str) -> tuple[float, float]:
    """Mean and peak absolute speed of a joint over the turn, rad/s."""
    speed = result.cadence * np.abs(result.motion.joint_rate[joint])
    return float(speed.mean()), float(speed.max())

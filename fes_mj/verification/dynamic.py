"""One simulated turn: the cross-check, and an audited second run of the same model beside it."""

from __future__ import annotations

import math

import numpy as np

from fes_mj.checks import Check
from fes_mj.crosscheck import cross_check, power_scale
from fes_mj.verification.case import Case
from fes_mj.verification.energy import audit


def dynamic_checks(case: Case) -> list[Check]:
    """Every check that needs a simulation of one leg."""
    result, ledger = cross_check(case.design, case.moments, cadence=case.cadence), audit(case)
    run = result.simulation
    advance = float(run.crank_speed.sum() * run.timestep)
    work = power_scale(result.static) * 2 * math.pi * ledger.turns / case.cadence
    count = min(len(ledger.crank_moment), len(run.crank_moment))
    return [
        case.check("stability", 0),
        *(each._replace(subject=case.name) for each in result.checks),
        case.check("whole_turns", abs(advance - 2 * math.pi * run.turns)),
        case.check("sensor_servo", np.sqrt(np.mean((ledger.crank_moment - ledger.servo_moment) ** 2))),
        case.check("pairing", np.abs(ledger.crank_moment[:count] - run.crank_moment[:count]).max()),
        case.check("energy_audit", abs(ledger.integration) / work),
        case.check("constraint_work", abs(ledger.constraint_work) / work),
        case.check("passive_work", abs(ledger.damping) / work),
    ]


def two_leg_checks(case: Case) -> list[Check]:
    """The cross-check with two legs half a turn apart on one crank."""
    result = cross_check(case.design, case.moments, cadence=case.cadence, legs=2)
    return [each._replace(subject=f"{case.name}, two legs") for each in result.checks]

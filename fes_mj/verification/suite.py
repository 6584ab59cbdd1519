"""Which checks are run, in which order: from the linkage over the model to the simulated turn and its refinement."""

import math
from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from fes_mj.common.checks import Check, check
from fes_mj.common.errors import UnstableError
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.assembly import joint_ranges
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.drive import Muscles
from fes_mj.simulation.mjcf import SERVO_GAIN
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.geometry import file_checks, geometry_checks
from fes_mj.verification.model import map_checks, model_checks, muscle_checks
from fes_mj.verification.references import exact_checks


def turn_checks(case: VerificationCase) -> Iterator[Check]:
    """One simulated turn: the cross-check, and an audited second run of the same model beside it."""
    run, ledger = case.simulation, case.audit
    apart = ledger.crank_moment - ledger.servo_moment
    advance = float(run.crank_speed.sum() * run.timestep)
    work = case.power_scale * 2 * math.pi * run.turns / case.cadence
    count = min(len(ledger.crank_moment), len(run.crank_moment))
    yield case.check("stability", 0)
    yield from case.checks
    yield case.check("whole_turns", abs(advance - 2 * math.pi * run.turns))
    yield case.check("sensor_servo", np.sqrt(np.mean(apart**2)) / servo_rounding(case.cadence))
    yield case.check("pairing", np.abs(ledger.crank_moment[:count] - run.crank_moment[:count]).max())
    yield case.check("energy_audit", abs(ledger.integration) / work)
    yield case.check("constraint_work", abs(ledger.constraint_work) / work)
    yield case.check("passive_work", abs(ledger.damping) / work)


def servo_rounding(cadence: float) -> float:
    """To what the servo's force is known, N m: its gain times the rounding of the speed (rad/s) it compares."""
    return SERVO_GAIN * cadence * float(np.finfo(float).eps)


def two_leg_checks(case: VerificationCase) -> Iterator[Check]:
    """The cross-check with two legs half a turn apart on one crank."""
    yield from case.two_legs.checks


def refinement_checks(case: VerificationCase) -> Iterator[Check]:
    """Orders, floor, uncertainty and what is left at a step of zero, where errors are of second order in the step."""
    if isinstance(case.drive, Muscles) and case.drive.jumps:
        return
    result = case.refinement
    yield case.check("gap_order", abs(result.gap_order - 2))
    yield case.check("power_order", abs(result.power_order - 2))
    yield case.check("softness_order", 1 - result.softness_order)
    yield case.check("softness_floor", result.softness_floor)
    yield case.check("finest_work", abs(result.steps[-1].work_error))
    yield case.check("extrapolated_work", abs(result.extrapolated))
    yield case.check("power_uncertainty", result.uncertainty)


def printed_checks(case: VerificationCase) -> Iterator[Check]:
    """A design of the paper against Table 1: joint ranges and, for the paper's moments, power."""
    printed = case.expected
    if printed is None:
        return
    ranges = np.array([*printed.knee_range, *printed.hip_range])
    yield case.check("joint_range", np.abs(joint_ranges(case.design) - ranges).max())
    drive = case.drive
    if isinstance(drive, JointMoments) and drive.name in printed.power:
        power = case.static.work_per_turn * turns_per_second(case.design.linkage.cadence)  # printed at its own cadence
        yield case.check("printed_power", abs(power - printed.power[drive.name]))


def ride_checks(case: VerificationCase) -> Iterator[Check]:
    """A short ride with either transmission, by both solvers."""
    for ride in case.rides:
        yield from ride.checks


CheckGroup: TypeAlias = Callable[[VerificationCase], Iterator[Check]]
QUICK_CHECKS: tuple[CheckGroup, ...] = (
    *(geometry_checks, file_checks, map_checks, muscle_checks, exact_checks, model_checks, turn_checks),
    printed_checks,
)


def quick_groups(legs: int) -> tuple[CheckGroup, ...]:
    """What decides about a design whenever it is simulated: by `simulate` and by `validate --quick`."""
    return (*QUICK_CHECKS, two_leg_checks) if legs == 2 else QUICK_CHECKS


FULL_CHECKS = (*QUICK_CHECKS, two_leg_checks, refinement_checks, ride_checks)


def verify(case: VerificationCase, groups: tuple[CheckGroup, ...] = QUICK_CHECKS) -> Iterator[Check]:
    """Run the checks of a case, group by group. Raises AssemblyError if its linkage does not close."""
    for group in groups:
        yield from _stable(group(case), case.name)


def benchmarks() -> Iterator[Check]:
    """Run the published problems, which do not depend on a case."""
    from fes_mj.verification.problems import chain_checks, four_bar_checks  # need SciPy, which a turn does not

    for subject, run in {"A02": chain_checks, "four-bar": four_bar_checks}.items():
        yield from _stable(run(subject), subject)


def _stable(group: Iterator[Check], subject: str) -> list[Check]:
    """All checks of a group or, where a simulation breaks down, that alone."""
    try:
        return list(group)
    except UnstableError:
        return [check("stability", math.inf, subject)]

"""What riders who may have been measured would give in somebody's experiment: one number a rider, shape (members,).

The function of a row of data/published.toml has the name that the row gives, and takes riders and the row's set-up.
Nothing in here knows what was measured.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Rider
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.fatigue import FALL, RECOVERY, force_factor
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.power import MuscleTurn, best_turn, muscle_turn
from fes_mj.muscles.pull import pull_at
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import Windows

CrankingSetup = Mapping[str, Any]
TRICYCLE = PAPER_TRICYCLE.design
_QUADRICEPS = MUSCLE_GROUPS.index("quadriceps")
_SPREAD = 1.5  # assumption: by which factor a time constant of fatigue may be off either way


def isometric(riders: Riders, hip_deg: Any, knee_deg: Any, rider: Rider = TRICYCLE.rider) -> FloatArray:
    """Knee moment of the fully activated quadriceps at rest, N m, shape (members, angles); deg of flexion."""
    hip, knee = np.broadcast_arrays(np.radians(hip_deg), np.radians(knee_deg))
    flexion = Flexion(hip + np.radians(riders["hip_offset_deg"]), np.atleast_1d(knee))
    rest = Flexion(np.zeros(1), np.zeros(1))
    muscles = anatomy().only("quadriceps")
    return np.asarray(pull_at(riders, flexion, rest, rider, muscles).moment.knee[_QUADRICEPS, :, 0])


def knee_of_largest_torque(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Knee flexion at which the stimulated quadriceps gives the largest isometric torque, deg."""
    knee = np.arange(setup["knee_flexion_deg"][0], setup["knee_flexion_deg"][1] + 0.5)
    return np.asarray(knee[isometric(riders, setup["hip_flexion_deg"], knee).argmax(axis=1)])


def _cranked(riders: Riders, setup: CrankingSetup, rpm: float) -> MuscleTurn:
    """On a standard tricycle, in the windows that are best at setup's `windows_rpm`, or at this cadence."""
    _, windows = best_turn(riders, TRICYCLE, setup.get("windows_rpm", rpm) * RPM)
    used = np.isin(MUSCLE_GROUPS, setup.get("groups", MUSCLE_GROUPS))[:, None, None]
    return muscle_turn(riders, TRICYCLE, rpm * RPM, Windows(windows.on, windows.width * used))


def _torque(riders: Riders, setup: CrankingSetup, rpm: float) -> FloatArray:
    """Crank torque of one leg, N m, shape (members, angles)."""
    return np.asarray(_cranked(riders, setup, rpm).power[:, 0] / (rpm * RPM))


def mean_torque_ratio(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Mean crank torque at the first cadence per that at the second."""
    first, second = (_torque(riders, setup, rpm).mean(axis=1) for rpm in setup["cadence_rpm"])
    return np.asarray(first / second)


def peak_torque_ratio(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Largest crank torque at the first cadence per that at the second."""
    first, second = (_torque(riders, setup, rpm).max(axis=1) for rpm in setup["cadence_rpm"])
    return np.asarray(first / second)


def power_ratio(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Mean power at the first cadence per that at the second."""
    first, second = setup["cadence_rpm"]
    return np.asarray(mean_torque_ratio(riders, setup) * (first / second))


def later_peak(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """By how much later in the turn torque is largest at the first cadence than at the second, deg."""
    first, second = (_torque(riders, setup, rpm).argmax(axis=1) for rpm in setup["cadence_rpm"])
    return np.asarray((first - second + 180) % 360 - 180, float)


def fatigue_ratio(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Force lost in `minutes` at the first cadence per that at the second."""
    turns = [_cranked(riders, setup, rpm) for rpm in setup["cadence_rpm"]]
    first, second = (
        1 - force_factor(turn.activation[_QUADRICEPS].mean(axis=-1)[:, 0], 60 * setup["minutes"]) for turn in turns
    )
    return np.asarray(first / second)


def _uncertain(riders: Riders, seed: int) -> FloatArray:
    """A factor on a time constant of fatigue for every rider."""
    return np.asarray(_SPREAD ** np.random.default_rng(seed).uniform(-1, 1, len(riders)))


def lost_force(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Of an isometric contraction, lost after so many at a duty, %."""
    time = setup["contractions"] * setup["contraction_s"] / setup["duty"]
    fall, recovery = (constant * _uncertain(riders, seed) for seed, constant in enumerate((FALL, RECOVERY)))
    return np.asarray(100 * (1 - force_factor(setup["duty"], time, recovery, fall)))


def power(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Mean power of both legs over setup's cadences, W."""
    of_each = [2 * _cranked(riders, setup, rpm).power_mean[:, 0] for rpm in setup["cadence_rpm"]]
    return np.asarray(np.mean(of_each, axis=0))


def _with_strength(riders: Riders, strength: float) -> Riders:
    """The same riders, every group of this strength, rectus femoris recruited as the vasti."""
    changed = {f"{group}_strength": strength for group in MUSCLE_GROUPS} | {"rectus_recruitment": 1.0}
    columns = {name: np.full(len(riders), value) for name, value in changed.items()}
    return Riders(riders.name, dict(riders.values) | columns, riders.likelihood)


def power_per_able_bodied(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Power of stimulated riders of a strength per that of able-bodied ones, %, each group of whom is at its best.

    These use the whole turn, at the best of some cadences, and rise as much more slowly as was measured.
    """
    stimulated = _with_strength(riders, setup["strength"])
    slow = {"rise_s": riders.values["rise_s"] * setup["able_bodied_rise"], "delay_s": np.zeros(len(riders))}
    able = _with_strength(Riders(riders.name, dict(riders.values) | slow, riders.likelihood), 1.0)
    of_able_bodied = [
        best_turn(able, TRICYCLE, rpm * RPM, duty=1.0, each_its_own=True)[0].power_mean[:, 0]
        for rpm in setup["able_bodied_rpm"]
    ]
    of_stimulated = _cranked(stimulated, setup, setup["cadence_rpm"][0]).power_mean[:, 0]
    return np.asarray(100 * of_stimulated / np.max(of_able_bodied, axis=0))


def advance(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """By how much earlier in time a group's best window begins than where it would at a standstill, s."""
    group = MUSCLE_GROUPS.index(setup["group"])
    slow, fast = (
        best_turn(riders, TRICYCLE, rpm * RPM, each_its_own=True)[1].on[group, :, 0] for rpm in setup["cadence_rpm"]
    )
    earlier = np.radians((slow - fast + 180) % 360 - 180)
    return np.asarray(earlier / (np.diff(setup["cadence_rpm"]) * RPM))


def best_width(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Width of a group's window that gives the largest power, whatever it costs, deg."""
    _, windows = best_turn(riders, TRICYCLE, setup["cadence_rpm"][0] * RPM, duty=1.0, each_its_own=True)
    return np.asarray(windows.width[MUSCLE_GROUPS.index(setup["group"]), :, 0])

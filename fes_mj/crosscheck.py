"""Dynamic against static: what is compared, the limits, the verdict."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.checks import Check, check
from fes_mj.design import Design
from fes_mj.inverse_dynamics import crank_moment
from fes_mj.simulation import Simulation, simulate
from fes_mj.statics import QuasiStatic, quasi_static
from fes_mj.torque import JointMoments

# A leg that delivers less than this is held to the limits of this much: what discretisation leaves behind does not
# vanish with the mean, the masses swing a hundred watts to and fro all the same.
LEAST_POWER = 10.0  # W
# The near-massless variant keeps so much of all masses that inertia adds this power to the quasi-static curve. With
# less, the loops, whose stiffness MuJoCo scales with the masses, give way to the jumps of the torque map.
INERTIA_POWER_RMS = 0.03  # W
# The simulation's error is of first order in its step, and grows with how sharply a design turns its links round. Where
# the default step leaves a check failing, a quarter of it is tried, this often; what then disagrees, disagrees.
REFINEMENTS = 2


@dataclass(frozen=True)
class CrossCheck:
    """A simulation beside the references it was checked against."""

    simulation: Simulation
    massless: Simulation
    static: QuasiStatic
    checks: tuple[Check, ...]
    refinements: int = 0  # how often the default step was quartered

    @property
    def agrees(self) -> bool:
        return all(each.ok for each in self.checks)

    @property
    def relative_difference(self) -> float:
        """Mean power, dynamic minus static, relative to static."""
        return relative_difference(self.simulation.power_mean, self.static.power_mean)

    @property
    def difference_text(self) -> str:
        """The same for people: in percent, or in W where the static mean is zero."""
        if np.isfinite(self.relative_difference):
            return f"{100 * self.relative_difference:+.4f} %"
        return f"{self.simulation.power_mean - self.static.power_mean:+.4f} W"


def cross_check(
    design: Design,
    moments: JointMoments,
    *,
    cadence: float | None = None,
    timestep: float | None = None,
    turns: int = 1,
    legs: int = 1,
) -> CrossCheck:
    """Simulate with full masses and nearly without, solve statics, compare (arguments as `simulate`)."""
    static = quasi_static(design, moments, cadence)
    options: dict[str, Any] = {"cadence": cadence, "timestep": timestep, "turns": turns, "legs": legs}
    simulation = simulate(design, moments, **options)
    massless = simulate(design, moments, **options, mass_scale=near_massless(static), gravity=0.0)
    power = power_scale(static)
    duration = len(simulation.crank_angle) * simulation.timestep
    checks = (
        check("mean_power", abs(simulation.power_mean - static.power_mean) / power),
        check("loop_gap", simulation.loop_gap_max),
        check("cadence_ripple", simulation.cadence_ripple),
        check("inverse_dynamics", _rms_per_leg(simulation, reference_power(simulation))),
        check("massless_statics", _rms_per_leg(massless, reference_power(massless, 0.0))),
        check("energy_balance", abs(simulation.energy.lost) / (power * duration * legs)),
    )
    return CrossCheck(simulation, massless, static, checks)


def refined_cross_check(design: Design, moments: JointMoments, **options: Any) -> CrossCheck:
    """cross_check (same arguments but timestep) at the default step, and at quarters of it while a check fails."""
    result = cross_check(design, moments, **options)
    for count in range(1, REFINEMENTS + 1):
        if result.agrees:
            break
        finer = cross_check(design, moments, timestep=result.simulation.timestep / 4, **options)
        result = replace(finer, refinements=count)
    return result


def near_massless(static: QuasiStatic) -> float:
    """Factor on the masses at which inertia, without weight, adds INERTIA_POWER_RMS to the quasi-static power."""
    massive = crank_moment(static.design, static.moments, static.cadence, static.crank_angle, gravity=0.0)
    inertia_power = static.cadence * np.sqrt(np.mean((massive - static.crank_moment) ** 2))
    return float(min(1.0, INERTIA_POWER_RMS / inertia_power))


def power_scale(static: QuasiStatic) -> float:
    """What the relative limits refer to: the mean power of one leg, but no less than LEAST_POWER, W."""
    return max(abs(static.power_mean), LEAST_POWER)


def relative_difference(value: float, reference: float) -> float:
    """(value - reference) / |reference|; NaN for a zero reference."""
    return (value - reference) / abs(reference) if reference else np.nan


def reference_power(simulation: Simulation, mass_scale: float | None = None) -> NDArray[np.float64]:
    """Exact crank power of all legs at the simulated crank angles, W; mass_scale 0 is the quasi-static curve."""
    scale = simulation.mass_scale if mass_scale is None else mass_scale
    angle, cadence = simulation.crank_angle, simulation.cadence
    legs = (
        crank_moment(simulation.design, simulation.moments, cadence, angle - leg.lag, scale, simulation.gravity)
        for leg in simulation.legs
    )
    return cadence * np.sum([*legs], axis=0)


def cycle_csv(result: CrossCheck) -> str:
    """The measured turns as CSV, a row a time step."""
    run = result.simulation
    columns = {
        "crank_angle_deg": np.degrees(run.crank_angle),
        "crank_power_W": run.power,
        "inverse_dynamics_power_W": reference_power(run),
        "quasi_static_power_W": reference_power(run, 0.0),
        **{f"{name}_deg": np.degrees(angle) for name, angle in run.joint_angle.items()},
        **{f"{name}_Nm": moment for name, moment in run.joint_moment.items()},
        **{f"{name}_gap_m": gap for name, gap in run.loop_gap.items()},
    }
    lines = [",".join(f"{value:.9g}" for value in row) for row in np.column_stack([*columns.values()]).tolist()]
    return "\n".join([",".join(columns), *lines]) + "\n"


def _rms_per_leg(simulation: Simulation, reference: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean((simulation.power - reference) ** 2))) / len(simulation.legs)

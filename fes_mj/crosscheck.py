"""Dynamic against static: what is compared, the limits, the verdict."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj.design import Design
from fes_mj.inverse_dynamics import crank_moment
from fes_mj.simulation import Simulation, simulate
from fes_mj.statics import QuasiStatic, quasi_static
from fes_mj.torque import JointMoments

# Cycle-mean power: masses and weight return their energy, so only discretisation and loop softness are left.
MEAN_POWER_LIMIT = 5e-4  # relative
LOOP_GAP_LIMIT = 1e-5  # m
CADENCE_RIPPLE_LIMIT = 1e-4  # relative
POWER_RMS_LIMIT = 0.1  # W, instantaneous power of one leg
ENERGY_LIMIT = 5e-4  # lost energy per joint work
# A leg that delivers less than this is held to the limits of this much: what discretisation leaves behind does not
# vanish with the mean, the masses swing a hundred watts to and fro all the same.
LEAST_POWER = 10.0  # W
# The near-massless variant keeps so much of all masses that inertia adds this power to the quasi-static curve. With
# less, the loops, whose stiffness MuJoCo scales with the masses, give way to the jumps of the torque map.
INERTIA_POWER_RMS = 0.03  # W


class Check(NamedTuple):
    """One comparison: a value that must stay at or below its limit, both in `unit` ("" is relative)."""

    name: str
    value: float
    limit: float
    unit: str = ""

    @property
    def ok(self) -> bool:
        return self.value <= self.limit  # NaN is not


@dataclass(frozen=True)
class CrossCheck:
    """A simulation beside the references it was checked against."""

    simulation: Simulation
    massless: Simulation
    static: QuasiStatic
    checks: tuple[Check, ...]

    @property
    def agrees(self) -> bool:
        return all(check.ok for check in self.checks)

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
    power = max(abs(static.power_mean), LEAST_POWER)
    duration = len(simulation.crank_angle) * simulation.timestep
    checks = (
        Check("mean_power", abs(simulation.power_mean - static.power_mean) / power, MEAN_POWER_LIMIT),
        Check("loop_gap", simulation.loop_gap_max, LOOP_GAP_LIMIT, "m"),
        Check("cadence_ripple", simulation.cadence_ripple, CADENCE_RIPPLE_LIMIT),
        Check("inverse_dynamics", _rms_per_leg(simulation, reference_power(simulation)), POWER_RMS_LIMIT, "W"),
        Check("massless_statics", _rms_per_leg(massless, reference_power(massless, 0.0)), POWER_RMS_LIMIT, "W"),
        Check("energy_balance", abs(simulation.energy.lost) / (power * duration * legs), ENERGY_LIMIT),
    )
    return CrossCheck(simulation, massless, static, checks)


def near_massless(static: QuasiStatic) -> float:
    """Factor on the masses at which inertia, without weight, adds INERTIA_POWER_RMS to the quasi-static power."""
    massive = crank_moment(static.design, static.moments, static.cadence, static.crank_angle, gravity=0.0)
    inertia_power = static.cadence * np.sqrt(np.mean((massive - static.crank_moment) ** 2))
    return float(min(1.0, INERTIA_POWER_RMS / inertia_power))


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

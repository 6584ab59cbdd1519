"""Dynamic against static: what is measured of a case, what is compared in it, the verdict."""

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, cast

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.checks import LEAST_POWER, Check, check, power_scale
from fes_mj.common.provenance import versions
from fes_mj.common.units import RPM
from fes_mj.common.writing import csv_text
from fes_mj.crosscheck.pipeline import Pipeline, Setup
from fes_mj.linkage.turning import FROM_TOP, turning
from fes_mj.muscles.torque import MuscleTorque
from fes_mj.simulation.bench import BenchOptions, Simulation
from fes_mj.simulation.mjcf import Physics
from fes_mj.statics.characteristics import power_characteristics
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import LegTurns, QuasiStatic

# The near-massless variant keeps so much of all masses that inertia adds this power to the quasi-static curve. With
# less, the loops, whose stiffness MuJoCo scales with the masses, give way to the jumps of the torque map.
INERTIA_POWER_RMS = 0.03  # W


@dataclass(frozen=True, eq=False, repr=False)
class Case(Brief, Setup):
    """A setup and all that was measured of it, computed when it is first asked for, once.

    pipeline: the steps that everything is computed by; another one is a case with a fault.

    >>> case = fes_mj.Case(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    >>> case
    <Case d1 p1p2 at 96.4 rpm, legs: 1>
    >>> case.agrees
    True
    """

    label: str = field(default="", kw_only=True)
    pipeline: type[Pipeline] = field(default=Pipeline, kw_only=True)

    @property
    def brief(self) -> str:
        return f"{self.name} at {self.cadence / RPM:.1f} rpm, legs: {self.legs}"

    @property
    def name(self) -> str:
        """Design, and what drives it."""
        return self.label or f"{self.design.name} {self.drive.name}"

    @cached_property
    def steps(self) -> Pipeline:
        """The pipeline of this setup."""
        return self.pipeline(*(getattr(self, field.name) for field in fields(Setup)))

    @cached_property
    def static(self) -> QuasiStatic | MuscleStatic:
        """The quasi-static turn. Raises AssemblyError if the linkage does not close."""
        return self.steps.quasi_static()

    @cached_property
    def joint_forces(self) -> JointForces:
        """Of the quasi-static turn, without and with masses."""
        return JointForces(self.static)

    @cached_property
    def statics(self) -> LegTurns | MuscleStatic:
        """The quasi-static turns of all legs."""
        static = self.static
        if isinstance(static, MuscleStatic):
            return static
        left_turn = () if static.moments.left is None or self.legs == 1 else (self.steps.quasi_static("left_"),)
        return LegTurns((static, *cast("tuple[QuasiStatic, ...]", left_turn)), self.legs)

    @cached_property
    def simulation(self) -> Simulation:
        """The run with full masses. Raises UnstableError if it breaks down."""
        return self.steps.run()

    @cached_property
    def massless(self) -> Simulation:
        """The run without weight and with so little of the masses that inertia adds INERTIA_POWER_RMS to statics."""
        massive = self.steps.crank_moment(self.static.motion, gravity=0.0)
        inertia_power = self.cadence * np.sqrt(np.mean((massive - self.static.crank_moment) ** 2))
        mass_scale = float(min(1.0, INERTIA_POWER_RMS / inertia_power))
        return self.steps.run(BenchOptions(Physics(mass_scale, gravity=0.0)))

    def reference_power(self, run: Simulation | None = None, mass_scale: float | None = None) -> FloatArray:
        """Exact crank power of all legs at the crank angles of a run, W; mass_scale 0 is the quasi-static curve.

        After the friction of bearings, if there is any.
        """
        run = run or self.simulation
        total = np.zeros_like(run.crank_angle)
        scale = run.mass_scale if mass_scale is None else mass_scale
        for leg in run.legs:
            motion = self.steps.motion(run.crank_angle - leg.lag)
            total = total + self.steps.crank_moment(motion, scale, run.gravity, leg.prefix)
            if self.steps.friction:
                total = total - self.steps.friction.crank_moment(motion)
        return np.asarray(self.cadence * total)

    @property
    def friction_loss(self) -> float:
        """Of the bearings of one leg, W."""
        return self.steps.friction.power if self.steps.friction else 0.0

    @property
    def static_power_mean(self) -> float:
        """Quasi-static mean crank power of one leg after the friction of its bearings, W."""
        return self.statics.power_mean - self.friction_loss

    @property
    def power_scale(self) -> float:
        """What the relative limits refer to, W, see checks.power_scale."""
        return power_scale(self.statics.power_mean)

    @property
    def relative_difference(self) -> float:
        """Mean power, dynamic minus static, relative to static; NaN for a static mean of zero."""
        dynamic, static = self.simulation.power_mean, self.static_power_mean
        return (dynamic - static) / abs(static) if static else np.nan

    @property
    def difference_text(self) -> str:
        """The same for people: in percent, or in W where the static mean is too small for it to mean anything."""
        if abs(self.static_power_mean) >= LEAST_POWER:
            difference, unit = 100 * self.relative_difference, "%"
        else:
            difference, unit = self.simulation.power_mean - self.static_power_mean, "W"
        return f"{difference:+.4f} {unit}" if round(difference, 4) else f"less than 0.0001 {unit}"

    def rms_per_leg(self, run: Simulation, mass_scale: float | None = None) -> float:
        """Instantaneous crank power of a run against reference_power, root mean square per leg, W."""
        difference = run.power - self.reference_power(run, mass_scale)
        return float(np.sqrt(np.mean(difference**2))) / len(run.legs)

    def check(self, name: str, value: float) -> Check:
        """A measured value of this case beside its limit."""
        return check(name, value, self.name)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The cross-check."""
        return (
            *self.simulation.checks(self.statics.power_mean, self.friction_loss, self.name),
            self.check("inverse_dynamics", self.rms_per_leg(self.simulation)),
            self.check("massless_statics", self.rms_per_leg(self.massless, 0.0)),
            *self._activation_checks,
        )

    @property
    def _activation_checks(self) -> list[Check]:
        """Of muscles: activation of the run against the periodic answer, per what both may miss."""
        torque, run = self.steps.torque, self.simulation
        if not isinstance(torque, MuscleTorque):
            return []
        answers = [torque.activation(run.crank_angle - leg.lag) for leg in run.legs]
        apart = np.abs(run.activation - np.concatenate(answers).T).max()
        return [self.check("muscle_activation", float(apart) / torque.hidden(run.timestep))]

    @property
    def agrees(self) -> bool:
        """Whether every check holds."""
        return all(check.ok for check in self.checks)

    @property
    def characteristics(self) -> dict[str, Any]:
        """How even the simulated power of all legs is, as JSON names and units it."""
        return power_characteristics(self.simulation.power, self.simulation.turns)

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        run = self.simulation
        static = self.statics.summary() | self.joint_forces.summary()
        return static | {
            "power_mean_W": run.power_mean,
            "work_per_turn_J": run.work_per_turn,
            "knee_range_deg": run.joint_range_deg.knee,
            "hip_range_deg": run.joint_range_deg.hip,
            **{f"simulated_{name}": value for name, value in self.characteristics.items()},
            "power_sd_W": self.statics.power_sd,
            "static_power_mean_W": self.static_power_mean,
            "friction_loss_W": self.friction_loss,
            "relative_difference": self.relative_difference,
            "loop_gap_max_m": run.loop_gap_max,
            "cadence_ripple": run.cadence_ripple,
            "agrees": self.agrees,
            "checks": [check.as_json() for check in self.checks],
            "legs": len(run.legs),
            "turns": run.turns,
            "timestep_s": run.timestep,
            "loop_force_max_N": {loop: float(np.abs(force).max()) for loop, force in run.loop_force.items()},
            "energy_J": run.energy.as_json(),
            "versions": versions("fes-mj", "mujoco", "numpy"),
        }

    def cycle_csv(self) -> str:
        """The measured turns as CSV, a row a time step."""
        run = self.simulation
        return csv_text(
            {
                "crank_angle_deg": np.degrees(run.crank_angle),
                FROM_TOP: turning(self.design).degrees_from_top(run.crank_angle),
                "crank_power_W": run.power,
                "inverse_dynamics_power_W": self.reference_power(),
                "quasi_static_power_W": self.reference_power(mass_scale=0.0),
                **{f"{name}_deg": np.degrees(angle) for name, angle in run.joint_angle.items()},
                **{f"{name}_Nm": moment for name, moment in run.joint_moment.items()},
                **{f"{name}_activation": active for name, active in run.activation_of.items()},
                **{f"{name}_gap_m": gap for name, gap in run.loop_gap.items()},
            }
        )

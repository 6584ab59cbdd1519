"""Dynamic against static: one measured case, what is compared in it, the limits, the verdict."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.checks import LEAST_POWER, Check, check
from fes_mj.common.writing import csv_text
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.loads import Load, body_loads
from fes_mj.linkage.segments import GRAVITY
from fes_mj.linkage.turning import FROM_TOP, turning
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import TorqueMap, torque_map
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import Simulation, simulate
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.statics.characteristics import power_characteristics
from fes_mj.statics.extrapolation import turning_in_range
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.turn import TURN_POINTS, QuasiStatic, equilibrium, virtual_work

# The near-massless variant keeps so much of all masses that inertia adds this power to the quasi-static curve. With
# less, the loops, whose stiffness MuJoCo scales with the masses, give way to the jumps of the torque map.
INERTIA_POWER_RMS = 0.03  # W


@dataclass(frozen=True, eq=False)
class Case:
    """A design under joint moments at a cadence (rad/s, by default Eq. 16), and all that was measured of it.

    Everything is computed when it is first asked for, once. The methods up to `run` are the steps of the pipeline; a
    subclass that replaces one of them is a case with a fault. timestep: s, by default chosen by time_step.
    """

    design: Design
    moments: JointMoments
    cadence: float = 0.0
    timestep: float | None = None
    turns: int = 1
    legs: int = 1
    label: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        if not self.cadence:
            object.__setattr__(self, "cadence", self.design.linkage.cadence)

    @property
    def name(self) -> str:
        """Design and moments."""
        return self.label or f"{self.design.name} {self.moments.name}"

    # The steps of the pipeline.

    @cached_property
    def torque(self) -> TorqueMap:
        return torque_map(self.moments)

    def motion(self, crank_angle: FloatArray) -> Motion:
        """Kinematics at crank angles, rad."""
        return kinematics.solve(self.design, crank_angle)

    def joint_moment(self, motion: Motion, leg: str = "") -> PerJoint[FloatArray]:
        """Knee and hip moment along a motion of the leg with this name prefix, N m."""
        return self.torque.of(leg).along(motion, self.cadence)

    def loads(self, motion: Motion, mass_scale: float = 1.0, gravity: float = GRAVITY) -> dict[str, Load]:
        """Weight and inertia along a motion."""
        return body_loads(motion, self.cadence, mass_scale, gravity)

    def equilibrium(
        self, motion: Motion, joint_moment: PerJoint[FloatArray], loads: dict[str, Load] | None = None
    ) -> tuple[FloatArray, dict[str, ComplexArray]]:
        """Crank moment and reactions by free-body equilibrium."""
        return equilibrium(motion, joint_moment, loads)

    def edit_model(self, spec: Spec) -> None:
        """Change the MuJoCo model before it is compiled; nothing is changed here."""

    def run(self, **options: Any) -> Simulation:
        """Simulate with these options of bench.simulate instead of the case's own."""
        own = {"cadence": self.cadence, "timestep": self.timestep, "turns": self.turns, "legs": self.legs}
        return simulate(self.design, self.moments, **own | options, torque=self.torque, edit=self.edit_model)

    # What is measured.

    def spec(self) -> Spec:
        """The MuJoCo model of one leg, not drawn."""
        spec = build_mjcf(self.design, cadence=self.cadence, timestep=self.timestep, drawn=False)
        self.edit_model(spec)
        return spec

    @cached_property
    def static(self) -> QuasiStatic:
        """The quasi-static turn. Raises AssemblyError if the linkage does not close."""
        return self.static_at(TURN_POINTS)

    @cached_property
    def joint_forces(self) -> JointForces:
        """Of the quasi-static turn, without and with masses."""
        return JointForces(self.static)

    def static_at(self, points: int, leg: str = "") -> QuasiStatic:
        """The quasi-static turn at another number of crank angles, or of the leg with this name prefix."""
        torque = self.torque.of(leg)
        turning_in_range(self.design, torque.reference)
        motion = self.motion(np.linspace(0, 2 * np.pi, points, endpoint=False))
        joint_moment = self.joint_moment(motion, leg)
        return QuasiStatic(motion, torque, self.cadence, joint_moment, *self.equilibrium(motion, joint_moment))

    @cached_property
    def statics(self) -> tuple[QuasiStatic, ...]:
        """The quasi-static turn of every leg whose moments are its own."""
        if self.moments.left is None or self.legs == 1:
            return (self.static,)
        return self.static, self.static_at(TURN_POINTS, "left_")

    @property
    def static_power_mean(self) -> float:
        """Quasi-static mean crank power of one leg, on average of the legs, W."""
        return float(np.mean([each.power_mean for each in self.statics]))

    @property
    def power_sd(self) -> float | None:
        """Its standard deviation, W: the errors of two files of moments are independent. None where it is not known."""
        deviations = [each.power_sd for each in self.statics]
        known = [each for each in deviations if each is not None]
        return math.hypot(*known) / len(known) if len(known) == len(deviations) else None

    @cached_property
    def simulation(self) -> Simulation:
        """The run with full masses. Raises UnstableError if it breaks down."""
        return self.run()

    @cached_property
    def massless(self) -> Simulation:
        """The run with almost no masses and no weight."""
        return self.run(mass_scale=self.near_massless, gravity=0.0)

    @cached_property
    def near_massless(self) -> float:
        """Factor on the masses at which inertia, without weight, adds INERTIA_POWER_RMS to the quasi-static power."""
        massive = self.crank_moment(self.static.motion, gravity=0.0)
        inertia_power = self.cadence * np.sqrt(np.mean((massive - self.static.crank_moment) ** 2))
        return float(min(1.0, INERTIA_POWER_RMS / inertia_power))

    def crank_moment(
        self, motion: Motion, mass_scale: float = 1.0, gravity: float = GRAVITY, leg: str = ""
    ) -> FloatArray:
        """Exact crank moment of a leg at constant speed, N m, without MuJoCo (inverse_dynamics.crank_moment)."""
        return virtual_work(motion, self.joint_moment(motion, leg), self.loads(motion, mass_scale, gravity))

    def reference_power(self, run: Simulation | None = None, mass_scale: float | None = None) -> FloatArray:
        """Exact crank power of all legs at the crank angles of a run, W; mass_scale 0 is the quasi-static curve."""
        run = run or self.simulation
        scale = run.mass_scale if mass_scale is None else mass_scale
        legs = [
            self.crank_moment(self.motion(run.crank_angle - leg.lag), scale, run.gravity, leg.prefix)
            for leg in run.legs
        ]
        return np.asarray(self.cadence * np.sum(legs, axis=0))

    # What is concluded.

    @property
    def power_scale(self) -> float:
        """What the relative limits refer to: the mean power of one leg, but no less than LEAST_POWER, W."""
        return max(abs(self.static_power_mean), LEAST_POWER)

    @property
    def relative_difference(self) -> float:
        """Mean power, dynamic minus static, relative to static; NaN for a static mean of zero."""
        dynamic, static = self.simulation.power_mean, self.static_power_mean
        return (dynamic - static) / abs(static) if static else np.nan

    @property
    def difference_text(self) -> str:
        """The same for people: in percent, or in W where the static mean is too small for it to mean anything."""
        if abs(self.static_power_mean) >= LEAST_POWER:
            return f"{100 * self.relative_difference:+.4f} %"
        return f"{self.simulation.power_mean - self.static_power_mean:+.4f} W"

    def check(self, name: str, value: float) -> Check:
        """A measured value of this case beside its limit."""
        return check(name, value, self.name)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The cross-check."""
        run, power = self.simulation, self.power_scale
        duration = len(run.crank_angle) * run.timestep
        return (
            self.check("mean_power", abs(run.power_mean - self.static_power_mean) / power),
            self.check("loop_gap", run.loop_gap_max),
            self.check("cadence_ripple", run.cadence_ripple),
            self.check("inverse_dynamics", self.rms_per_leg(run)),
            self.check("massless_statics", self.rms_per_leg(self.massless, 0.0)),
            self.check("energy_balance", abs(run.energy.lost) / (power * duration * self.legs)),
        )

    def rms_per_leg(self, run: Simulation, mass_scale: float | None = None) -> float:
        """Instantaneous crank power of a run against reference_power, root mean square per leg, W."""
        difference = run.power - self.reference_power(run, mass_scale)
        return float(np.sqrt(np.mean(difference**2))) / len(run.legs)

    @property
    def agrees(self) -> bool:
        return all(each.ok for each in self.checks)

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        run = self.simulation
        known = self.static.summary() | self.joint_forces.summary()
        return known | {
            "power_mean_W": run.power_mean,
            "work_per_turn_J": 2 * np.pi * run.power_mean / run.cadence,
            "knee_range_deg": run.joint_range_deg.knee,
            "hip_range_deg": run.joint_range_deg.hip,
            **power_characteristics(run.power, run.turns),
            "power_sd_W": self.power_sd,
            "static_power_mean_W": self.static_power_mean,
            "relative_difference": self.relative_difference,
            "loop_gap_max_m": run.loop_gap_max,
            "cadence_ripple": run.cadence_ripple,
            "agrees": self.agrees,
            "checks": [each.as_json() for each in self.checks],
            "legs": len(run.legs),
            "turns": run.turns,
            "timestep_s": run.timestep,
            "loop_force_max_N": {loop: float(np.abs(force).max()) for loop, force in run.loop_force.items()},
            "energy_J": run.energy.as_json(),
            "versions": {name: version(name) for name in ("fes-mj", "mujoco", "numpy")},
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
                **{f"{name}_gap_m": gap for name, gap in run.loop_gap.items()},
            }
        )

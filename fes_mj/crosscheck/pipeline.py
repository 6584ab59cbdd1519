"""The steps from a design and what drives it to a measured turn, each of which a fault can replace."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import GRAVITY, BodyLoad, body_loads
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.torque_map import TorqueMap
from fes_mj.muscles.drive import Muscles
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bearings import add_friction
from fes_mj.simulation.bench import PLAIN_BENCH, BenchOptions, Simulation, simulate
from fes_mj.simulation.mjcf import REAL, ModelOptions, Physics, build_mjcf
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.drive import Drive, driven_speed, torque_source
from fes_mj.statics.equilibrium import equilibrium, virtual_work
from fes_mj.statics.friction import BearingLoss, Bearings
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import QuasiStatic, turn_points

# Steps per those that suffice elsewhere, where stimulation jumps and the power's error is of first order in the step.
FINER_WHERE_IT_JUMPS = 4


@dataclass(frozen=True, eq=False)
class Setup:
    """A design and what drives it at a cadence (rad/s, by default Eq. 16), for whole turns of one leg or two.

    drive: JointMoments, or Muscles, of which it is the most probable rider. timestep: s, by default chosen by
    time_step. bearings: with friction, if they are given.
    """

    design: Design
    drive: Drive
    cadence: float = cast("float", None)  # until __post_init__
    timestep: float | None = None
    turns: int = 1
    legs: int = 1
    bearings: Bearings | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "cadence", crank_speed(self.design, self.cadence))
        if self.timestep is None and isinstance(self.drive, Muscles) and self.drive.jumps:
            steps = FINER_WHERE_IT_JUMPS * steps_per_turn(self.design, self.cadence, turns=self.turns)
            object.__setattr__(self, "timestep", 2 * math.pi / self.cadence / steps)


class Pipeline(Setup):
    """The steps of a setup. A subclass that replaces one of them is a pipeline with a fault."""

    @cached_property
    def torque(self) -> TorqueSource:
        return torque_source(self.drive, self.design, self.cadence)

    def motion(self, crank_angle: FloatArray) -> Motion:
        """Kinematics at crank angles, rad."""
        return kinematics.solve(self.design, crank_angle)

    def joint_moment(self, motion: Motion, leg: str = "") -> PerJoint[FloatArray]:
        """Knee and hip moment along a motion of the leg with this name prefix, N m."""
        return self.torque.of(leg).along(motion, self.cadence)

    def loads(self, motion: Motion, mass_scale: float = 1.0, gravity: float = GRAVITY) -> dict[str, BodyLoad]:
        """Weight and inertia along a motion."""
        return body_loads(motion, self.cadence, mass_scale, gravity)

    def equilibrium(
        self, motion: Motion, joint_moment: PerJoint[FloatArray], loads: dict[str, BodyLoad] | None = None
    ) -> tuple[FloatArray, dict[str, ComplexArray]]:
        """Crank moment and reactions by free-body equilibrium."""
        return equilibrium(motion, joint_moment, loads)

    def edit_model(self, spec: Spec) -> None:
        """Change the MuJoCo model before it is compiled: give it the friction of bearings, if any."""
        if self.friction:
            add_friction(spec, self.design.linkage.architecture, LEGS[self.legs], self.friction.moments)

    def run(
        self, options: BenchOptions = PLAIN_BENCH, *, timestep: float | None = None, turns: float | None = None
    ) -> Simulation:
        """Simulate; timestep (s) and turns instead of the setup's own. Raises UnstableError if it breaks down."""
        return simulate(
            self.design,
            self.drive,
            cadence=self.cadence,
            timestep=self.timestep if timestep is None else timestep,
            turns=self.turns if turns is None else turns,
            legs=self.legs,
            options=replace(options, torque=self.torque, edit=self.edit_model),
        )

    # What several steps give together.

    def spec(self, physics: Physics = REAL) -> Spec:
        """The MuJoCo model of one leg, not drawn."""
        options = ModelOptions(physics, drawn=False)
        spec = build_mjcf(self.design, cadence=self.cadence, timestep=self.timestep, options=options)
        self.edit_model(spec)
        return spec

    def quasi_static(self, leg: str = "", points: int | None = None) -> QuasiStatic | MuscleStatic:
        """The quasi-static turn of the leg with this name prefix, over so many crank angles (default turn_points).

        Raises AssemblyError if the linkage does not close.
        """
        driven_speed(self.design, self.drive, self.cadence, self.legs)
        motion = self.motion(kinematics.uniform_turn(turn_points(self.design) if points is None else points))
        joint_moment, torque = self.joint_moment(motion, leg), self.torque.of(leg)
        crank_moment, reactions = self.equilibrium(motion, joint_moment)
        turn = (motion, self.cadence, joint_moment, crank_moment, reactions)
        if isinstance(self.drive, Muscles):
            every = self.drive.stimulated(self.design, self.cadence)
            return MuscleStatic(*turn, self.drive.timing, every, self.legs, every.most_probable)
        return QuasiStatic(*turn, cast("TorqueMap", torque))

    @cached_property
    def friction(self) -> BearingLoss | None:
        """What the bearings of one leg lose, the right one's if the legs differ; None without friction."""
        return BearingLoss(JointForces(self.quasi_static()), self.bearings) if self.bearings else None

    def crank_moment(
        self, motion: Motion, mass_scale: float = 1.0, gravity: float = GRAVITY, leg: str = ""
    ) -> FloatArray:
        """Exact crank moment of a leg at constant speed, N m, without MuJoCo (equilibrium.crank_moment)."""
        return virtual_work(motion, self.joint_moment(motion, leg), self.loads(motion, mass_scale, gravity))

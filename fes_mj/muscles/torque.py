"""Joint moments by the muscles of one rider, twice (linkage.torque_source): of a whole turn, and step by step."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.machine_code import in_lists
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import LegControl
from fes_mj.moments.torque_map import scalar_source, source_parameters
from fes_mj.muscles.activation import answer
from fes_mj.muscles.anatomy import GROUPS
from fes_mj.muscles.instant import LegMuscles, Stimulus, joint_moments, stimulation
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import LEADING, Stimulated, stimulated_by_joint
from fes_mj.muscles.stepping import Memory, MuscleStepper, Stimulator, steady

# Crank angles of a turn at which activation is known where a power curve is compared: what corners of windows hide in
# between is then less than the error of the finest time step of a refinement.
_FINE = 7200
_FINE_TURN = np.arange(_FINE) * (2 * np.pi / _FINE)


@dataclass(frozen=True, eq=False)
class MuscleTorque:
    """Of one rider, stimulated on one design at one cadence; every leg does the same, its part of a turn later."""

    stimulated: Stimulated
    _memories: dict[tuple[float, float], Memory] = field(default_factory=dict, repr=False)

    @property
    def riders(self) -> Riders:
        return self.stimulated.riders

    @property
    def design(self) -> Design:
        return self.stimulated.motion.design

    @property
    def cadence(self) -> float:
        """Rad/s."""
        return self.stimulated.cadence

    def of(self, _: str) -> "MuscleTorque":
        return self

    def along(self, motion: Motion, cadence: float) -> PerJoint[FloatArray]:
        """Moments along a motion of the design at its cadence, N m, by `pull` and the periodic answer."""
        active = self.activation(motion.crank_angle)
        moment = pull(self.riders, motion, cadence).moment
        return moment.map(lambda groups: np.einsum("ga,ga->a", active, groups[:, 0, 0]))

    def activation(self, crank_angle: FloatArray) -> FloatArray:
        """Of each group at crank angles, rad, shape (groups, angles)."""
        return np.stack([np.interp(crank_angle, _FINE_TURN, group, period=2 * np.pi) for group in self._answer])

    def hidden(self, timestep: float) -> float:
        """Largest part of an activation that may lie between two angles of `activation`, or two steps of this time, s.

        Where stimulation bends or jumps between two samples, no more of it is missed than the bend over a cell and a
        step for half the time that both take; activation follows it by its share of the faster time constant. The
        direction of a joint that turns round is told to a step: by joints what changes in two steps is missed as well.
        """
        asked = self._asked
        bend = np.abs(np.roll(asked, 1, axis=-1) - 2 * asked + np.roll(asked, -1, axis=-1)).max()
        cell = _FINE_TURN[1] / self.cadence
        if self.stimulated.windows is None:
            bend += 2 * timestep / cell * np.abs(np.diff(asked)).max()
        return float(bend * (1 + timestep / cell) * (cell + timestep) / 2 / self.leg.rise)

    @cached_property
    def _asked(self) -> FloatArray:
        """Stimulation as it arrives, over the fine turn, shape (groups, angles)."""
        cadence, windows, riders = np.full((1, 1), self.cadence), self.stimulated.windows, self.riders
        if windows is None:
            return stimulated_by_joint(riders, self.design, self.cadence, _FINE_TURN)[:, 0, 0]
        return windows.at(_FINE_TURN - cadence * riders["delay_s"], cadence * ramp())[:, 0, 0]

    @cached_property
    def _answer(self) -> FloatArray:
        turn, known = self.stimulated.turn, self.riders
        start = 0.0 if turn is None else turn.activation[:, 0, 0, 0]
        return answer(self._asked, 2 * np.pi / self.cadence, known["rise_s"].item(), known.fall.item(), start)

    @property
    def stimulus(self) -> Stimulus:
        """The windows of crank angle, or of the angle in the measurement that a joint stands for, in lists."""
        windows = self.stimulated.windows
        if windows is not None:
            return in_lists(Stimulus.of(windows, self.cadence))
        on, width = np.radians(np.moveaxis(self.riders.windows()[:, 0], -1, 0))
        return in_lists(Stimulus(on, width, self.riders.measured_on.cadence * ramp()))

    @cached_property
    def leg(self) -> LegMuscles:
        """The rider's muscles, in lists."""
        return LegMuscles.of(self.riders, self.design.rider).in_lists

    def stimulator(self, lag: float) -> Stimulator:
        """What asks for stimulation in a leg that trails by this crank angle, rad: crank, or joints that move so."""
        stimulus, groups = self.stimulus, range(len(GROUPS))
        if self.stimulated.windows is not None:
            return lambda crank, *_: [stimulation(stimulus, group, crank - lag) for group in groups]
        sources = PerJoint.of(scalar_source)
        where = PerJoint.of(lambda joint: source_parameters(self.riders.measured_on, joint))
        leading = [JOINTS.index(LEADING[group]) for group in GROUPS]

        def by_joint(_: float, knee: float, hip: float, knee_rate: float, hip_rate: float) -> list[float]:
            there = sources.knee(where.knee, knee, knee_rate), sources.hip(where.hip, hip, hip_rate)
            return [stimulation(stimulus, group, there[leading[group]]) for group in groups]

        return by_joint

    def control(self, leg: Leg, timestep: float) -> LegControl:
        """A leg in steps of this time, s, as `instant` knows it, in a ride that has been steady before."""
        ask, muscles, moments_of = self.stimulator(leg.lag), self.leg, self.moments_of
        stepper = MuscleStepper(muscles, timestep, self._memory(ask, leg.lag, timestep))
        kept: list[tuple[float, ...]] = []

        def moments(*state: float) -> tuple[float, float]:
            active = stepper.advance(ask(*state))
            kept.append(active)
            return moments_of(muscles, active, *state[1:])

        return LegControl(moments, kept)

    moments_of = staticmethod(joint_moments)

    def _memory(self, ask: Stimulator, lag: float, timestep: float) -> Memory:
        """What a leg's muscles remember at crank angle 0, the same in every run."""
        if (lag, timestep) not in self._memories:
            count = round(2 * np.pi / self.cadence / timestep)
            angle = np.arange(count) * (2 * np.pi / count)
            motion = kinematics.solve(self.design, angle - lag)
            rates = motion.joint_rate.map(lambda rate: self.cadence * rate)
            states = zip(*(column.tolist() for column in (angle, *motion.joint_angle, *rates)), strict=True)
            start = self.activation(np.array([-lag]))[:, 0].tolist()
            self._memories[lag, timestep] = steady(self.leg, timestep, [ask(*state) for state in states], start)
        return self._memories[lag, timestep]

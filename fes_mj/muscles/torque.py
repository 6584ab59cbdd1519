"""Joint moments by the muscles of one rider, twice (linkage.torque_source): of a whole turn, and step by step."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.machine_code import in_lists
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import LegControl
from fes_mj.moments.torque_map import scalar_source
from fes_mj.muscles.activation import periodic_activation
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.by_joint import LEADING, TURNED, JointLed
from fes_mj.muscles.instant import LegMuscles, Stimulus, joint_moments, stimulation
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import Stimulated
from fes_mj.muscles.stepping import MuscleMemory, MuscleStepper, StimulusLaw, steady

# Crank angles of a turn at which activation is known where a power curve is compared: what corners of windows hide in
# between is then less than the error of the finest time step of a refinement.
_FINE = 7200
_FINE_TURN = np.arange(_FINE) * (2 * np.pi / _FINE)


@dataclass(frozen=True, eq=False, repr=False)
class MuscleTorque(Brief):
    """Of one rider, stimulated on one design at one cadence; every leg does the same, its part of a turn later."""

    stimulated: Stimulated
    _memories: dict[tuple[float, float], MuscleMemory] = field(default_factory=dict)

    @property
    def brief(self) -> str:
        return f"{self.design.name} {self.riders.name} muscles at {self.cadence / RPM:.1f} rpm"

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
        angles = self._asked[0]
        return np.stack([np.interp(crank_angle, angles, group, period=2 * np.pi) for group in self._answer])

    def hidden(self, timestep: float) -> float:
        """Largest part of an activation that may lie between two angles of `activation`, or two steps of this time, s.

        Where stimulation bends between two samples, no more of it is missed than the bend over a cell and a step for
        half the time that both take; of a jump, which is between two angles and told to steps by its area, less than
        all of it for a step. Activation follows by its share of the faster time constant.
        """
        (angle, asked), cell = self._asked, _FINE_TURN[1] / self.cadence
        change, jumps = np.diff(asked, append=asked[:, :1]), np.diff(angle, append=2 * np.pi) <= TURNED
        jump = np.abs(change[:, jumps]).max(initial=0.0)
        smooth = change[:, ~jumps]
        bend = np.abs(np.diff(smooth, append=smooth[:, :1])).max()
        return float((bend * (1 + timestep / cell) * (cell + timestep) / 2 + jump * timestep) / self.leg.rise)

    @cached_property
    def _led(self) -> JointLed:
        """By joints, over the fine turn."""
        return JointLed.of(self.riders, self.design, self.cadence, _FINE_TURN)

    @cached_property
    def _asked(self) -> tuple[FloatArray, FloatArray]:
        """Crank angles, rad, and stimulation that arrives there, shape (groups, angles)."""
        cadence, windows, riders = np.full((1, 1), self.cadence), self.stimulated.windows, self.riders
        if windows is None:
            return self._led.crank_angle[0], self._led.stimulation[:, 0]
        return _FINE_TURN, windows.at(_FINE_TURN - cadence * riders["delay_s"], cadence * ramp())[:, 0, 0]

    @cached_property
    def _answer(self) -> FloatArray:
        """Activation at the same angles."""
        turn, riders = self.stimulated.turn, self.riders
        start = np.zeros(len(MUSCLE_GROUPS)) if turn is None else turn.activation[:, 0, 0, 0]
        if self.stimulated.windows is None:
            return self._led.activation(start[:, None])[:, 0]
        times = 2 * np.pi / self.cadence, riders["rise_s"].item(), riders.fall.item()
        return periodic_activation(self._asked[1], *times, start)

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

    def stimulator(self, lag: float) -> StimulusLaw:
        """What asks for stimulation in a leg that trails by this crank angle, rad: crank, or joints that move so."""
        stimulus, groups = self.stimulus, range(len(MUSCLE_GROUPS))
        if self.stimulated.windows is not None:
            return lambda crank, *_: [stimulation(stimulus, group, crank - lag) for group in groups]
        sources, trial = [scalar_source(joint) for joint in JOINTS], self.riders.measured_on
        where = [trial.parameters(joint) for joint in JOINTS]
        leading = [JOINTS.index(LEADING[group]) for group in MUSCLE_GROUPS]
        last = [rate.item() for rate in kinematics.solve(self.design, -lag - _FINE_TURN[[1]]).joint_rate]

        def asked(group: int, joint: int, angle: float, rate: float) -> float:
            return stimulation(stimulus, group, sources[joint](where[joint], angle, rate))

        def by_joint(_: float, *state: float) -> list[float]:
            result = []
            for group, joint in enumerate(leading):
                angle, rate, before = state[joint], state[2 + joint], last[joint]
                value = asked(group, joint, angle, rate)
                if (before < 0) != (rate < 0):
                    # it turned round since the step before: straight lines to this value and on have the jump's area
                    value += (before / (before - rate) - 0.5) * (asked(group, joint, angle, before) - value)
                result.append(value)
            last[:] = state[2:]
            return result

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

    def _memory(self, ask: StimulusLaw, lag: float, timestep: float) -> MuscleMemory:
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

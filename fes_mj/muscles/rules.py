"""Rules by which riders are stimulated on a design; designs are compared under one of them.

best: windows of a stimulator with the largest expected power (timing). measured: those of the measurement, from the
most bent knee on. stimulation-by-angle: what was stimulated at a joint's angle and direction in the measurement is
stimulated there; of the knee for quadriceps and hamstrings, of the hip for the gluteus. by-angle: the paper's, in which
the moment itself belongs to a joint's angle and direction.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.turning import turning
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.by_angle import moments_by_angle
from fes_mj.muscles.by_joint import JointLed
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.power import MuscleTurn, best_turn, muscle_turn
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, Windows

BEST, MEASURED, BY_ANGLE, STIMULATION_BY_ANGLE = RULES = ("best", "measured", "by-angle", "stimulation-by-angle")


@dataclass(frozen=True, eq=False)
class Stimulated:
    """Riders on one design under a rule.

    motion: over TURN_ANGLES. moment: of the muscles, N m, positive in extension, shape (members, angles). turn: what
    muscles do, and windows: when, (groups, members or 1, 1); None where the rule knows none.
    """

    riders: Riders
    motion: Motion
    cadence: float
    moment: PerJoint[FloatArray]
    turn: MuscleTurn | None = None
    windows: Windows | None = None

    @cached_property
    def power(self) -> FloatArray:
        """Crank power of one leg by its joints, W, shape (members, angles)."""
        rate = self.motion.joint_rate
        return np.asarray(self.cadence * (self.moment.knee * rate.knee + self.moment.hip * rate.hip))

    @property
    def notes(self) -> list[str]:
        """What a reader must know of the result: muscles whose moment arm changes its sign."""
        offset = self.riders["hip_offset_deg"]
        ends = np.radians(np.stack([offset.min(axis=0), offset.max(axis=0)]))
        changed = anatomy().changed_arms(Flexion.along(self.motion, ends))
        return [f"the moment arm of {arm} changes its sign within the angles that are used" for arm in changed]

    @property
    def most_probable(self) -> int:
        """Number of the rider with the largest density."""
        return int(np.argmax(self.riders.likelihood))

    def alone(self, member: int) -> "Stimulated":
        """One of the riders, stimulated as among the others."""
        riders, moment = self.riders.taken([member]), self.moment.map(lambda moment: moment[[member]])
        turn = self.turn and self.turn.alone(member)
        return Stimulated(riders, self.motion, self.cadence, moment, turn, self.windows and self.windows.of(member))


def stimulated(rule: str, riders: Riders, design: Design, cadence: float, duty: float = DUTY) -> Stimulated:
    """Riders on a design under one of RULES; the last few are kept.

    cadence: rad/s. duty: as for best_windows, of the best rule alone.
    Raises InputError for joints beyond the range of the muscles' lengths, AssemblyError if the linkage does not turn.
    """
    turning(design)
    return _stimulated(rule, riders, design, cadence, duty)


@lru_cache(maxsize=4)
def _stimulated(rule: str, riders: Riders, design: Design, cadence: float, duty: float) -> Stimulated:
    motion = known_motion(riders, design)
    if rule == BY_ANGLE:
        return Stimulated(riders, motion, cadence, moments_by_angle(trial_moments(riders), motion, riders.measured_on))
    windows = None
    if rule == BEST:
        turn, windows = best_turn(riders, design, cadence, duty)
    elif rule == MEASURED:
        windows = trial_windows(riders, design)
        turn = muscle_turn(riders, design, cadence, windows)
    else:
        active = JointLed.of(riders, design, cadence, TURN_ANGLES).activation_at(TURN_ANGLES)
        turn = MuscleTurn(pull(riders, motion, cadence), active[:, :, None])
    return Stimulated(riders, motion, cadence, turn.moment.map(lambda moment: moment[:, 0]), turn, windows)


def known_motion(riders: Riders, design: Design) -> Motion:
    """Over TURN_ANGLES. Raises as `stimulated`."""
    turning(design)
    motion = kinematics.solve(design, TURN_ANGLES)
    anatomy().require_range(design.name, riders.flexion(motion))
    return motion


def trial_windows(riders: Riders, design: Design) -> Windows:
    """The windows of the measurement on a design, counted from its own most bent knee."""
    on, width = np.moveaxis(riders.windows(), -1, 0)[..., None]
    return Windows(on, width).shifted(np.degrees(turning(design).top_dead_centre))


def trial_moments(riders: Riders) -> PerJoint[FloatArray]:
    """Joint moments of the muscles in the measurement over a turn of its crank, N m, shape (members, TURN_POINTS)."""
    trial = riders.measured_on
    there = muscle_turn(riders, trial.design, trial.cadence, trial_windows(riders, trial.design))
    return there.moment.map(lambda moment: moment[:, 0])

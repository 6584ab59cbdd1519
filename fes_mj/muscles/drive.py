"""Stimulated muscles as what drives the legs, where otherwise joint moments do."""

from dataclasses import dataclass
from pathlib import Path

from fes_mj.common.brief import Brief
from fes_mj.common.errors import require_one_of
from fes_mj.linkage.design import Design
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.rules import BEST, BY_ANGLE, RULES, STIMULATION_BY_ANGLE, Stimulated, stimulated, trial_moments
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, widths_up_to
from fes_mj.muscles.torque import MuscleTorque


@dataclass(frozen=True, eq=False, repr=False)
class Muscles(Brief):
    """An ensemble of riders and when they are stimulated; a simulation is of the most probable of them.

    timing: "best", "measured", "by-angle" or "stimulation-by-angle". duty: largest share of the turn in which a group
    is stimulated, with timing "best". Raises InputError for a timing or a duty that is none.

    >>> fes_mj.load_muscles("p1p2")
    <Muscles p1p2 muscles, timing best>
    """

    riders: Riders
    timing: str = BEST
    duty: float = DUTY

    def __post_init__(self) -> None:
        require_one_of("timing", self.timing, RULES)
        widths_up_to(self.duty)

    @property
    def brief(self) -> str:
        return self.driver

    @property
    def name(self) -> str:
        return f"{self.riders.name} muscles {self.timing}"

    @property
    def driver(self) -> str:
        """What moves the legs, in a few words."""
        return f"{self.riders.name} muscles, timing {self.timing}"

    @property
    def jumps(self) -> bool:
        """Whether stimulation jumps, where a joint turns round: errors are then of first order in a time step."""
        return self.timing == STIMULATION_BY_ANGLE

    def stimulated(self, design: Design, cadence: float) -> Stimulated:
        """Every rider on a design at a cadence in rad/s. Raises as rules.stimulated."""
        return stimulated(self.timing, self.riders, design, cadence, self.duty)

    def simulated(self, design: Design, cadence: float) -> Stimulated:
        """The most probable rider, stimulated as is best for all. Raises as rules.stimulated."""
        every = self.stimulated(design, cadence)
        return every.alone(every.most_probable)

    def torque(self, design: Design, cadence: float) -> TorqueSource:
        """What gives joint moments by that rider's muscles; by angle, the map of those of the measurement."""
        one = self.simulated(design, cadence)
        if self.timing != BY_ANGLE:
            return MuscleTorque(one)
        moment, trial = trial_moments(one.riders).map(lambda moments: moments[0]), self.riders.measured_on
        return torque_map(
            JointMoments(self.name, TURN_ANGLES - trial.top_dead_centre, moment.knee, moment.hip, measured_on=trial)
        )


def load_muscles(source: str | Path = "p1p2", timing: str = BEST, duty: float = DUTY) -> Muscles:
    """Stimulated muscles of a rider group, or of an ensemble's file (.npz). Raises InputError for what is none.

    >>> fes_mj.simulate(fes_mj.load_design("d1"), fes_mj.load_muscles("p1p2"))
    <Simulation d1 p1p2 muscles best: 7.98 W at 96.4 rpm, 2880 steps>
    """
    return Muscles(load_riders(source), timing, duty)

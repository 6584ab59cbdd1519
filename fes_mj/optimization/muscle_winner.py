"""What a design found for muscles is worth: with all riders of the ensemble, beside a design that it had to beat."""

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.muscles.rules import BEST
from fes_mj.optimization.buildable import COMMON, Buildability
from fes_mj.optimization.stimulated import SEARCHED, MuscleDrive
from fes_mj.statics.muscle_static import MuscleStatic

if TYPE_CHECKING:
    from fes_mj.optimization.optimize import Optimum


@dataclass(frozen=True)
class MuscleWinner:
    """The turns of two designs, each at its own cadence and timed best, of the same riders; build: of the first."""

    turn: MuscleStatic
    compared_with: MuscleStatic
    build: Buildability
    agrees: bool = True  # nothing of it was simulated

    @classmethod
    def of(cls, design: Design, other: Design, drive: MuscleDrive) -> "MuscleWinner":
        """Raises InputError where a joint leaves the known lengths of muscles."""

        def solved(one: Design) -> MuscleStatic:
            return MuscleStatic.solve(one, drive.riders, one.linkage.cadence, BEST, drive.duty)

        turn = solved(design)
        return cls(turn, solved(other), Buildability.of(turn))

    @property
    def design(self) -> Design:
        return self.turn.design

    @property
    def driver(self) -> str:
        """What moves the legs, in a few words."""
        return self.turn.driver

    @property
    def gain(self) -> tuple[float, float, float]:
        """Over the other design: expected power, W, its standard deviation over the riders, and how many have more."""
        gains = self.turn.powers - self.compared_with.powers
        return float(gains.mean()), float(gains.std()), float(np.mean(gains > 0))

    @property
    def joint_speed(self) -> PerJoint[float]:
        """Mean absolute, deg/s."""
        per_s = 360 * turns_per_second(self.turn.cadence)
        return self.turn.motion.joint_rate.map(lambda rate: per_s * float(np.abs(rate).mean()))

    @property
    def notes(self) -> list[str]:
        """What to beware of."""
        count = len(self.turn.stimulated.riders)
        return [f"{min(SEARCHED, count)} riders stood for all {count} in the search", *self.turn.notes]

    @property
    def rows(self) -> list[tuple[str, str]]:
        """What was found out, as text."""
        mean, deviation, share = self.gain
        windows = (self.turn.windows_deg or {}).items()
        return [
            ("mean crank power, W", f"{self.turn.power_mean:.2f} ± {self.turn.power_sd:.2f}"),
            ("cadence, rpm", f"{self.turn.cadence / RPM:.1f}"),
            *((f"mean {joint} speed, deg/s", f"{speed:.1f}") for joint, speed in self.joint_speed.items()),
            *((f"{group} on, deg", "{:.0f} to {:.0f}".format(*ends) if ends else "never") for group, ends in windows),
            *self.build.rows,
            (f"gain over {self.compared_with.design.name}, W", f"{mean:+.2f} ± {deviation:.2f}"),
            ("riders who gain, %", f"{100 * share:.0f}"),
        ]

    def doubts(self, optimum: "Optimum") -> list[str]:
        """As Winner.doubts."""
        return [*self.build.doubts(optimum.problem.limits.build or COMMON), *optimum.edges]

    def summary(self, optimum: "Optimum") -> dict[str, Any]:
        """The result as JSON names and units it; optimum: of the search that found the design."""
        turn, (mean, deviation, share) = self.turn.summary(), self.gain
        keys = ("group", "drive", "timing", "power_mean_W", "power_sd_W", "work_per_turn_J", "cadence_rpm",
                "windows_deg", "duty", "power_two_legs_min_W", "negative_share")  # fmt: skip
        people = {"power_people_W": optimum.power, "riders": optimum.riders} if optimum.problem.people.count > 1 else {}
        return {
            "kind": self.design.linkage.kind,
            "method": optimum.method,
            **{key: turn[key] for key in keys},
            "feasible": optimum.feasible,
            "violations": optimum.violations,
            "evaluations": optimum.evaluations,
            "riders_searched": min(SEARCHED, len(self.turn.stimulated.riders)),
            **{f"mean_{joint}_speed_deg_s": speed for joint, speed in self.joint_speed.items()},
            "compared_with": self.compared_with.design.name,
            "gain_W": mean,
            "gain_deviation_W": deviation,
            "gain_share": share,
            "design_space": optimum.problem.limits.space,
            **asdict(self.build),
            "doubts": self.doubts(optimum),
            "repair": optimum.repair or None,
            **people,
        }

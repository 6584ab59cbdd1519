"""What a design found for muscles is worth: with all riders of the ensemble, beside a design that it had to beat."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.units import turns_per_second
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.rules import BEST
from fes_mj.optimization.assessed import Assessed
from fes_mj.optimization.buildable import Buildability
from fes_mj.optimization.optimize import Optimum
from fes_mj.optimization.stimulated import SEARCHED, MuscleDrive
from fes_mj.statics.muscle_static import MuscleStatic


@dataclass(frozen=True)
class MuscleWinner(Assessed):
    """The turns of two designs, each at its own cadence and timed best, of the same riders; build: of the first.

    case: of the most probable rider.
    """

    compared_with: MuscleStatic
    turn: MuscleStatic

    @classmethod
    def of(cls, design: Design, other: Design, drive: MuscleDrive) -> "MuscleWinner":
        """Raises InputError where a joint leaves the known lengths of muscles."""

        def solved(one: Design) -> MuscleStatic:
            return MuscleStatic.solve(one, drive.riders, one.linkage.cadence, BEST, drive.duty)

        turn, muscles = solved(design), Muscles(drive.riders, BEST, drive.duty)
        per_s = 360 * turns_per_second(turn.cadence)
        speeds = turn.motion.joint_rate.map(lambda rate: per_s * float(np.abs(rate).mean()))
        return cls(Case(design, muscles), speeds, Buildability.of(turn), solved(other), turn)

    @property
    def gain(self) -> tuple[float, float, float]:
        """Over the other design: expected power, W, its standard deviation over the riders, and how many have more."""
        gains = self.turn.powers - self.compared_with.powers
        return float(gains.mean()), float(gains.std()), float(np.mean(gains > 0))

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
            *self.answer_rows,
            ("expected on the design as it is, W", f"{self.turn.power_mean:.2f}"),
            ("  of the most probable rider", f"{self.case.static.power_mean:.3f}"),
            *((f"  his {name}", value) for name, value in self.simulated_rows),
            *self.speed_rows,
            *((f"{group} on, deg", "{:.0f} to {:.0f}".format(*ends) if ends else "never") for group, ends in windows),
            *self.build.rows,
            (f"gain over {self.compared_with.design.name}, W", f"{mean:+.2f} ± {deviation:.2f}"),
            ("riders who gain, %", f"{100 * share:.0f}"),
        ]

    def summary(self, optimum: Optimum) -> dict[str, Any]:
        """As Assessed.summary: power is that of all riders; what is simulated, with power_mode_W, the likeliest's."""
        turn, (mean, deviation, share) = self.turn.summary(), self.gain
        keys = ("drive", "timing", "power_mean_W", "power_sd_W", "power_mode_W", "work_per_turn_J", "windows_deg",
                "duty", "power_two_legs_min_W", "negative_share")  # fmt: skip
        return super().summary(optimum) | {
            **{key: turn[key] for key in keys},
            "riders_searched": min(SEARCHED, len(self.turn.stimulated.riders)),
            "gain_W": mean,
            "gain_deviation_W": deviation,
            "gain_share": share,
        }

"""A quasi-static turn that muscles drive: of the riders who may have been measured, stimulated under one rule.

Joint moments, crank moment and reactions are the expected ones, means over the riders: all are linear in each other.
Passive moments, which do no work over a turn, are left out as masses are.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import all_legs
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import Stimulated, stimulated
from fes_mj.muscles.timing import DUTY
from fes_mj.statics.characteristics import power_characteristics
from fes_mj.statics.equilibrium import equilibrium
from fes_mj.statics.turn import DrivenTurn


@dataclass(frozen=True, eq=False, repr=False)
class MuscleStatic(DrivenTurn):
    """One turn of the massless model under muscles, of so many legs; `stimulated` has every rider's.

    member: number of the rider whose turn it is; without one it is the expected turn.
    """

    rule: str
    stimulated: Stimulated
    legs: int = 1
    member: int | None = None

    @classmethod
    def solve(
        cls, design: Design, riders: Riders, cadence: float, rule: str, duty: float = DUTY, legs: int = 1
    ) -> "MuscleStatic":
        """Raises as rules.stimulated; cadence: rad/s."""
        result = stimulated(rule, riders, design, cadence, duty)
        moment = result.moment.map(lambda moment: moment.mean(axis=0))
        return cls(result.motion, cadence, moment, *equilibrium(result.motion, moment), rule, result, legs)

    @property
    def driver(self) -> str:
        return f"{self.stimulated.riders.name} muscles, timing {self.rule}"

    @property
    def first(self) -> "MuscleStatic":
        """The turn of the first leg, as LegTurns has it: all do the same."""
        return self

    @property
    def turns(self) -> "tuple[MuscleStatic]":
        """The turns that differ, as LegTurns has them."""
        return (self,)

    @property
    def powers(self) -> FloatArray:
        """Mean crank power of one leg of each rider, W, shape (members,)."""
        return np.asarray(self.stimulated.power.mean(axis=1))

    @property
    def power_sd(self) -> float:
        """Standard deviation of one leg's mean power over the riders, W."""
        return float(self.powers.std())

    def ratio(self, other: "MuscleStatic") -> tuple[float, float]:
        """Expected power per another design's, and the standard deviation of the riders' own ratios."""
        return self.power_mean / other.power_mean, float((self.powers / other.powers).std())

    @property
    def windows_deg(self) -> dict[str, list[float] | None] | None:
        """[on, off] by group of the most probable rider's stimulation, deg of crank; None where there is none."""
        windows = self.stimulated.windows
        return windows.by_group(self.stimulated.most_probable) if windows else None

    @property
    def notes(self) -> list[str]:
        """What a reader must know of the result: muscles whose moment arm changes its sign."""
        return self.stimulated.notes

    def summary(self) -> dict[str, Any]:
        """As DrivenTurn.summary; power and work are one leg's, evenness is that of all legs together."""
        both, riders, windows = all_legs(self.power), self.stimulated.riders, self.stimulated.windows
        turn, whose = self.stimulated.turn, slice(None) if self.member is None else self.member
        share = None if windows is None else windows.width.mean(axis=(1, 2)) / 360
        return super().summary() | {
            "drive": "muscles",
            "group": riders.name,
            "timing": self.rule,
            "legs": self.legs,
            "power_sd_W": self.power_sd,
            "power_mode_W": float(self.powers[self.stimulated.most_probable]),
            "muscle_power_W": None if turn is None else float(turn.power_mean[whose].mean()),
            "power_two_legs_min_W": float(both.min()),
            "negative_share": float(np.mean(both < 0)),
            **power_characteristics(all_legs(self.power, self.legs)),
            "windows_deg": self.windows_deg,
            "duty": None if share is None else dict(zip(MUSCLE_GROUPS, map(float, share), strict=True)),
            "ramp_s": ramp(),
            "extrapolated_share": 0.0,
            "notes": self.notes,
            "warnings": [],
            **_rider(riders.most_probable, self.design),
        }


def _rider(rider: Riders, design: Design) -> dict[str, Any]:
    """A single rider's muscles as JSON names and units them; all lengths are those of the anatomy, before scaling."""
    muscles, value = anatomy(), {name: float(column[0]) for name, column in rider.values.items()}
    columns = {
        "name": muscles.names,
        "group": [MUSCLE_GROUPS[number] for number in muscles.group],
        "strength": rider.strength(muscles).ravel().tolist(),
        "max_isometric_force_N": muscles.force.tolist(),
        "optimal_fibre_length_m": muscles.optimal.tolist(),
        "tendon_slack_length_m": rider.slack(muscles).ravel().tolist(),
        "pennation_rad": muscles.pennation.tolist(),
        "max_speed_fibre_lengths_per_s": [value["max_speed"]] * len(muscles.names),
    }
    scales = muscles.length_scale(design.rider).ravel().tolist()
    return {
        "activation_rise_s": value["rise_s"],
        "activation_fall_s": value["rise_s"] * value["fall_per_rise"],
        "delay_s": value["delay_s"],
        "hip_flexion_offset_deg": value["hip_offset_deg"],
        "muscles": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)],
        "length_scale": dict(zip(muscles.names, scales, strict=True)),
    }

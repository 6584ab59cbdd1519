"""The setting of a stimulator at one cadence: best windows, what every group gives and costs, what mistiming costs."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import TWO_LEGS, all_legs
from fes_mj.linkage.turning import turning
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.fatigue import HALF_AN_HOUR, power_over_time, recoveries
from fes_mj.muscles.power import MuscleTurn
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import BEST, Stimulated, stimulated
from fes_mj.muscles.timing import DUTY, Windows, activation

MISTIMED = 20.0  # deg, by which windows are shifted to see what that costs


@dataclass(frozen=True, eq=False)
class Setting:
    """The best windows of a design at one cadence (rad/s); duty: the limit that the user keeps.

    legs: that are stimulated, both half a turn apart or the right one alone.
    """

    design: Design
    cadence: float
    duty: float
    stimulated: Stimulated
    legs: int = 2

    @classmethod
    def best(cls, design: Design, riders: Riders, cadence: float, duty: float = DUTY, legs: int = 2) -> "Setting":
        """Raises as rules.stimulated, and InputError where no group gives power."""
        setting = cls(design, cadence, duty, stimulated(BEST, riders, design, cadence, duty), legs)
        if not setting.windows.width.any():
            raise InputError(
                f"{design.name}: at {cadence / RPM:.4g} rpm no muscle group gives power, however it is stimulated; "
                "choose a slower cadence or a wider duty"
            )
        return setting

    @property
    def turn(self) -> MuscleTurn:
        assert self.stimulated.turn is not None  # the best rule has one
        return self.stimulated.turn

    @property
    def windows(self) -> Windows:
        """Shape (groups, 1, 1): the same for all riders."""
        assert self.stimulated.windows is not None
        return self.stimulated.windows

    @property
    def riders(self) -> Riders:
        return self.stimulated.riders

    @cached_property
    def power(self) -> FloatArray:
        """Mean power of each group, one leg, W, shape (groups, members)."""
        return self.turn.group_power[..., 0]

    @cached_property
    def together(self) -> FloatArray:
        """Power of the legs together over the turn, W, shape (members, angles)."""
        return all_legs(self.turn.power[:, 0], self.legs)

    @cached_property
    def effort(self) -> FloatArray:
        """Share of the turn x strength x largest force of each group, per that of the measurement, shape (groups,)."""
        muscles = anatomy()
        force = self.riders.strength(muscles)[..., 0, 0] * muscles.force[:, None]
        strength = np.stack([force[part].sum(axis=0).mean() for part in muscles.of_group])
        measured = self.riders.windows()[..., 1].mean(axis=1)
        return np.asarray(self.windows.width[:, 0, 0] * strength / float(measured @ strength))

    def lost(self, degrees: float) -> FloatArray:
        """Expected power of each group that windows later by so much lose, one leg, W, shape (groups,)."""
        later = activation(self.windows.shifted(degrees), self.riders, self.cadence)
        return np.asarray((self.power - MuscleTurn(self.turn.pulled, later).group_power[..., 0]).mean(axis=1))

    @cached_property
    def early_late(self) -> tuple[FloatArray, FloatArray]:
        """`lost` by windows that are MISTIMED early, and late."""
        return self.lost(-MISTIMED), self.lost(MISTIMED)

    @property
    def tired(self) -> list[float]:
        """Expected power of the legs after half an hour at this cadence, W: by the slower recovery, by the faster."""
        after = [power_over_time(self.turn, np.array([HALF_AN_HOUR]), recovery) for recovery in recoveries().values()]
        return sorted(self.legs * float(power.mean()) for power in after)

    def summary(self) -> dict[str, Any]:
        """What it gives and costs, as JSON names and units it."""
        leg, over_turn = self.power.sum(axis=0), self.together.mean(axis=0)
        early, late = (float(lost.sum() / leg.mean()) for lost in self.early_late)
        legs = "one_leg" if self.legs == 1 else "two_legs"
        return {
            "cadence_rpm": self.cadence / RPM,
            "cadence_Hz": turns_per_second(self.cadence),
            "power_mean_W": float(leg.mean()),
            "power_sd_W": float(leg.std()),
            f"power_{legs}_W": float(over_turn.mean()),
            f"power_{legs}_30_min_W": self.tired,
            f"power_{legs}_min_W": float(over_turn.min()),
            "negative_share": float(np.mean(over_turn < 0)),
            "stimulation_effort": float(self.effort.sum()),
            "power_per_effort_W": float(leg.mean() / self.effort.sum()),
            "early_loss_share": early,
            "late_loss_share": late,
        }

    def records(self) -> Iterator[dict[str, Any]]:
        """A row for each group and leg, as files name and unit it; angles None where a group is not stimulated."""
        top = turning(self.design).top_dead_centre
        for number, group in enumerate(MUSCLE_GROUPS):
            width = float(self.windows.width[number, 0, 0])
            power, effort = self.power[number], float(self.effort[number])
            for leg in TWO_LEGS[: self.legs]:
                on = float(self.windows.on[number, 0, 0]) + math.degrees(leg.lag)
                ends = [on % 360, (on + width) % 360] if width else [None, None]
                from_top = [None if end is None else (end - math.degrees(top)) % 360 for end in ends]
                yield {
                    "cadence_rpm": self.cadence / RPM,
                    "muscle": group,
                    "leg": leg.prefix.removesuffix("_"),
                    "on_deg": ends[0],
                    "off_deg": ends[1],
                    "on_from_tdc_deg": from_top[0],
                    "off_from_tdc_deg": from_top[1],
                    "duty": width / 360,
                    "power_W": float(power.mean()),
                    "power_sd_W": float(power.std()),
                    "stimulation_effort": effort,
                    "power_per_effort_W": float(power.mean()) / effort if effort else None,
                    "early_loss_W": float(self.early_late[0][number]),
                    "late_loss_W": float(self.early_late[1][number]),
                }

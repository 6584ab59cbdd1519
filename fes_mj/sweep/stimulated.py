"""Points of a sweep that muscles drive, one after the other: each is a turn of every rider of an ensemble."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.muscles.riders import Riders
from fes_mj.statics.muscle_static import MuscleStatic

Columns: TypeAlias = dict[str, NDArray[Any]]
RESULTS = ("power_mean_W", "power_sd_W", "work_per_turn_J", "extrapolated_share")


@dataclass(frozen=True, eq=False)
class Stimulation:
    """Under which of rules.RULES, for how large a share of the turn at most, whose muscles by name of the moments."""

    rule: str
    duty: float
    riders: Mapping[str, Riders]

    def columns(self, name: str, designs: Design, rpm: FloatArray, more: tuple[str, ...]) -> Columns:
        """RESULTS of the points of a batch, and why there is none ("why", "" where there is one).

        more: further results by their names in MuscleStatic.summary.
        """
        result: Columns = {key: np.full(len(rpm), np.nan) for key in (*RESULTS, *more)}
        why = np.full(len(rpm), "", object)
        for row, speed in enumerate(rpm.tolist()):
            design, cadence = designs.single(row), speed * RPM
            try:
                turn = MuscleStatic.solve(design, self.riders[name], cadence, self.rule, self.duty)
            except InputError as error:
                why[row] = str(error).removeprefix(f"{design.name}: ")
                continue
            summary = turn.summary()
            for key, column in result.items():
                column[row] = summary[key]
        return result | {"why": why}

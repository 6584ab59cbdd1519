"""Points of a sweep that muscles drive, one after the other: each is a turn of every rider of an ensemble."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.muscles.drive import Muscles
from fes_mj.statics.muscle_static import MuscleStatic

Columns: TypeAlias = dict[str, NDArray[Any]]
RESULTS = ("power_mean_W", "power_sd_W", "work_per_turn_J", "extrapolated_share")


def by_muscles(muscles: Muscles, designs: Design, rpm: FloatArray, legs: int, more: list[str]) -> Columns:
    """RESULTS of the points of a batch, and why there is none ("why", "" where there is one).

    more: further results by their names in MuscleStatic.summary.
    """
    result: Columns = {key: np.full(len(rpm), np.nan) for key in (*RESULTS, *more)}
    why = np.full(len(rpm), "", object)
    for row, speed in enumerate(rpm.tolist()):
        design = designs.single(row)
        try:
            turn = MuscleStatic.solve(design, muscles.riders, speed * RPM, muscles.timing, muscles.duty, legs)
        except InputError as error:
            why[row] = str(error).removeprefix(f"{design.name}: ")
            continue
        summary = turn.summary()
        for key, column in result.items():
            column[row] = summary[key]
    return result | {"why": why}

"""Do intervals hold what is true? Riders whose muscles are known, measured as the real ones were, and identified."""

from collections.abc import Sequence

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.muscles.identification import Candidates, Measured, identify_riders
from fes_mj.muscles.power import best_turn, muscle_turn
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import DUTY


def gains(
    riders: Riders, designs: Sequence[Design], base: Design, duty: float = DUTY, actual: Riders | None = None
) -> FloatArray:
    """Mean power on each design per that on `base`, each stimulated as is best in expectation, (designs, members).

    actual: whose gains instead under the same stimulation; by default the riders' own.
    """

    def power(design: Design) -> FloatArray:
        turn, windows = best_turn(riders, design, duty=duty)
        turn = muscle_turn(actual, design, design.linkage.cadence, windows) if actual else turn
        return turn.power_mean[:, 0]

    return np.stack([power(design) for design in designs]) / power(base)


def held(
    measured: Measured,
    designs: Sequence[Design],
    base: Design,
    riders: int,
    candidates: int,
    seed: int,
    share: float = 0.8,
) -> BoolArray:
    """Whether intervals of this share of the probability hold the gains of riders of the prior, (riders, designs).

    measured: what is known of each, whose values are replaced by what the rider would give; candidates: see identify.
    """
    random, ends = np.random.default_rng(seed), ((1 - share) / 2, (1 + share) / 2)
    truth = Candidates.of(Riders("truth", prior_draws(riders, random), np.zeros(riders)), measured)
    result = np.zeros((riders, len(designs)), bool)
    for row in range(riders):
        members = identify_riders(measured._replace(values=truth.simulated(row, random)), random, candidates).members(
            100
        )
        low, high = np.quantile(gains(members, designs, base), ends, axis=1)
        true = gains(members, designs, base, actual=truth.riders.taken([row]))[:, 0]
        result[row] = (low <= true) & (true <= high)
    return result

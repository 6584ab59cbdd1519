"""Designs for people instead of for one rider: few stand for a sample, each with a seat that is searched for as well.

Seats are variables beside the lengths, so that a design costs a turn a rider; a search for the seats within every
evaluation would cost hundreds.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.cluster.vq import kmeans2

from fes_mj.common.arrays import FloatArray
from fes_mj.fit.population import PEOPLE
from fes_mj.fit.seats import SEAT_LIMITS, Seats
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.kinematics import positions
from fes_mj.linkage.riders import populations

STATISTICS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "population": lambda power: power.mean(axis=1),
    "population-p10": lambda power: np.percentile(power, 10, axis=1),
}
# Who stand for a sample. With 3 or 8 the mean power of R1 and D1 differs by less than 0.03 W.
RIDERS = 5
# Searched around the seat in which a rider's leg is as stretched as the design's own: along the road, in height, m, and
# the seat angle's change, rad. The best seats of R1 and D1 are well within.
_MOVES = np.array([(-0.10, 0.10), (-0.20, 0.20), SEAT_LIMITS.recline])


@dataclass(frozen=True)
class People:
    """The design's own rider, in the seat as drawn, and others for whom the seat is moved; by default none.

    others: their thighs and shanks, m, shape (others, 2). plane: power of a sample's people by that of all these
    riders, the own one first, shape (people, riders). statistic: of the sample's power, a key of STATISTICS.
    """

    others: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    plane: FloatArray = field(default_factory=lambda: np.ones((1, 1)))
    statistic: str = "population"

    @property
    def count(self) -> int:
        return len(self.others) + 1

    @property
    def search(self) -> FloatArray:
        """Search ranges of the moves of all seats, shape (moves, 2)."""
        return np.tile(_MOVES, (len(self.others), 1))

    def seated(self, design: Design, moves: FloatArray) -> Design:
        """Designs, shape (n,), with every rider: a batch of n times `count`, design by design.

        moves: of the others' seats, see _MOVES, shape (n, moves). A seat goes no farther than SEAT_LIMITS.
        """
        if not len(self.others):
            return design
        leg_length = design.rider.thigh + design.rider.shank
        pedal = np.broadcast_to(positions(design, SCAN)["pedal"], (len(moves), len(SCAN))).mean(axis=1)
        shift = pedal[:, None] * (self.others.sum(axis=1) / leg_length - 1)
        moved = moves.reshape(len(moves), -1, 3) + np.stack([shift.real, -shift.imag, np.zeros(shift.shape)], axis=-1)
        low, high = (np.array(ends) for ends in zip(*SEAT_LIMITS, strict=True))
        seats = np.concatenate([np.zeros((len(moves), 1, 3)), np.clip(moved, low, high)], axis=1).reshape(-1, 3)
        legs = np.vstack([[design.rider.thigh, design.rider.shank], self.others])
        thigh, shank = np.tile(legs, (len(moves), 1)).T[..., None]
        repeated = design.taken(np.repeat(np.arange(design.size), self.count))
        return Seats(*seats.T[..., None]).moved(repeated.with_rider(thigh=thigh, shank=shank))

    def power(self, power: FloatArray) -> FloatArray:
        """The statistic, shape (n, sets), of the powers of all riders, design by design, shape (n * count, sets), W."""
        riders = power.reshape(-1, self.count, power.shape[1])
        return STATISTICS[self.statistic](np.einsum("pr,nrs->nps", self.plane, riders))


ONE_RIDER = People()


def sampled(statistic: str, samples: int, seed: int) -> People:
    """So many men and as many women; the power of the design's own rider, who is none of them, does not count.

    The riders are the centres of clusters of the sample's legs; in between power is a plane over thigh and shank,
    fitted to the riders' by least squares.
    """
    random = np.random.default_rng(seed)
    drawn = [populations()[who].sample(samples, random) for who in PEOPLE.values()]
    legs = np.hstack([(people.thigh, people.shank) for people in drawn]).T
    riders, _ = kmeans2(legs, RIDERS, minit="++", rng=random)
    sample, chosen = (np.insert(lengths - legs.mean(axis=0), 0, 1.0, axis=1) for lengths in (legs, riders))
    plane = sample @ np.linalg.pinv(chosen)
    return People(riders, np.column_stack([np.zeros(len(legs)), plane]), statistic)

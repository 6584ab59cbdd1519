"""The two numbers of a design that a reader may quote: its power as the paper assumes, and that of a rider.

Both are mean crank powers of one leg, and both draw everything that is not known of them. As the paper assumes, joint
moments belong to joint angles, at any speed; of a rider stimulated muscles pull, at their best timing. How strong the
muscles are is hardly known, so that a rider's power per that on the paper's tricycle is surer than its watts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from fes_mj.budget.budget import paper_powers
from fes_mj.budget.unknowns import drawn_designs
from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.turning import batch_turning, leg_reach
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.files import is_of_group
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.power import MuscleTurn
from fes_mj.muscles.pull import pull_each
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.rules import BEST, stimulated
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, activation, widths_up_to
from fes_mj.statics.drive import Drive
from fes_mj.statics.turn import QuasiStatic

HOW_TO_FIT_MUSCLES = "no muscles belong to these moments; `fes_mj moments TRIAL --fit-muscles -o RIDER.npz` finds some"

INTERVAL = (5, 95)  # %, between which a quantity is said to lie


class Estimate(NamedTuple):
    """A quantity, and the interval in which nine of ten of its draws lie."""

    value: float
    low: float
    high: float

    @classmethod
    def of(cls, draws: FloatArray, value: float | None = None) -> "Estimate":
        """Of draws, NaN where a linkage does not turn; value: by default their median."""
        median, low, high = np.nanpercentile(draws, (50, *INTERVAL))
        return cls(float(median if value is None else value), float(low), float(high))

    def text(self, digits: int) -> str:
        """The quantity with its interval in brackets."""
        return f"{self.value:.{digits}f}" + (f" ({self.interval(digits)})" if self.low < self.high else "")

    def interval(self, digits: int) -> str:
        """From where to where it lies."""
        return f"{self.low:.{digits}f} to {self.high:.{digits}f}"


@dataclass(frozen=True, eq=False, repr=False)
class Answer(Brief):
    """Mean crank power of one leg on a design, W: as the paper assumes, shape (draws,), and of riders, (members,).

    paper_mean: with everything as it is known best. trt: the riders on the paper's tricycle under the same timing. What
    is not known is None, and `missing` says why there is no rider, or no tricycle to compare with.
    """

    design: Design
    paper_mean: float | None = None
    paper: FloatArray | None = None
    rider: FloatArray | None = None
    trt: FloatArray | None = None
    missing: str = ""

    @property
    def brief(self) -> str:
        parts = {"as the paper assumes": self.paper_power, "for a rider": self.rider_power, "per TRT": self.rider_ratio}
        numbers = ", ".join(f"{name} {part.value:.2f}" for name, part in parts.items() if part)
        return f"{self.design.name}: {numbers or 'nothing known'}"

    @property
    def paper_power(self) -> Estimate | None:
        """As the paper assumes, W."""
        return None if self.paper is None else Estimate.of(self.paper, self.paper_mean)

    @property
    def rider_power(self) -> Estimate | None:
        """For a rider, W: the mean over the riders."""
        return None if self.rider is None else Estimate.of(self.rider, float(np.nanmean(self.rider)))

    @property
    def rider_ratio(self) -> Estimate | None:
        """For a rider, per the same rider's power on the equally timed TRT."""
        return None if self.rider is None or self.trt is None else Estimate.of(self.rider / self.trt)

    def per(self, other: "Answer") -> tuple[Estimate | None, Estimate | None]:
        """Both powers per another design's, draw by draw: as the paper assumes, and for a rider."""
        paper = rider = None
        if self.paper is not None and other.paper is not None and self.paper_mean and other.paper_mean:
            paper = Estimate.of(self.paper / other.paper, self.paper_mean / other.paper_mean)
        if self.rider is not None and other.rider is not None:
            rider = Estimate.of(self.rider / other.rider)
        return paper, rider

    def summary(self) -> dict[str, Any]:
        """As JSON names and units it; null for what is not known."""
        paper, rider, ratio = self.paper_power, self.rider_power, self.rider_ratio
        return {
            "paper_power_mean_W": self.paper_mean,
            "paper_power_interval_W": paper and paper[1:],
            "rider_power_mean_W": rider and rider.value,
            "rider_power_interval_W": rider and rider[1:],
            "rider_power_per_trt": ratio and ratio.value,
            "rider_power_per_trt_interval": ratio and ratio[1:],
            "rider_draws_that_do_not_turn": None if self.rider is None else int(np.isnan(self.rider).sum()),
            "rider_missing": self.missing or None,
        }


def answer(
    design: Design,
    legs: Sequence[QuasiStatic] = (),
    riders: Riders | None = None,
    cadence: float | None = None,
    duty: float = DUTY,
) -> Answer:
    """Both numbers of a design.

    legs: its quasi-static turns, one, or two that differ. riders: whose muscles; without them there is no rider.
    cadence: rad/s, of the design and of the tricycle it is compared with; by default each at 5.71 km/h. duty: as for
    load_muscles. Raises InputError for a batch, and for a cadence or a duty that is none.

    >>> design, moments = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")
    >>> fes_mj.answer(design, [fes_mj.quasi_static(design, moments)], fes_mj.load_muscles("p1p2").riders)
    <Answer d1: as the paper assumes 31.14, for a rider 10.25, per TRT 0.54>
    """
    crank_speed(design, cadence)
    widths_up_to(duty)
    mean = float(np.mean([leg.power_mean for leg in legs])) if legs else None
    paper = paper_powers(*legs) if legs else None
    if riders is None:
        return Answer(design, mean, paper, missing=HOW_TO_FIT_MUSCLES)
    try:
        rider = rider_powers(design, riders, cadence, duty)
    except InputError as error:
        return Answer(design, mean, paper, missing=str(error))
    try:
        trt = rider_powers(replace(load_design("trt"), rider=design.rider), riders, cadence, duty)
    except InputError as error:
        missing = f"no tricycle to compare with: {error}; `fes_mj fit trt` seats a rider on one, to be named first"
        return Answer(design, mean, paper, rider, missing=missing)
    return Answer(design, mean, paper, rider, trt)


def riders_of(drive: Drive) -> Riders | None:
    """Whose muscles belong to what drives: those of a rider group to its moments, to a user's own none."""
    if isinstance(drive, Muscles):
        return drive.riders
    return load_riders(drive.name) if is_of_group(drive) else None


@lru_cache(maxsize=32)  # the tricycle is compared with every design
def rider_powers(design: Design, riders: Riders, cadence: float | None = None, duty: float = DUTY) -> FloatArray:
    """Mean crank power of one leg of every rider, stimulated as is best in expectation, W, shape (members,).

    Each on a linkage and with legs that are drawn; NaN where these do not turn, or leave the angles for which muscle
    lengths are known. cadence: rad/s, by default the design's. Raises InputError if it does so as it is.
    """
    cadence = design.linkage.cadence if cadence is None else float(cadence)
    windows = stimulated(BEST, riders, design, cadence, duty).windows
    assert windows is not None  # the best rule has them
    motion = kinematics.solve(drawn_designs(design, len(riders)), TURN_ANGLES)
    with np.errstate(invalid="ignore"):
        pulled = pull_each(riders, motion, cadence)
        power = MuscleTurn(pulled, activation(windows, riders, cadence)).power_mean[:, 0]
        reach, swing = leg_reach(motion.design, motion.points["pedal"].value), np.ptp(motion.joint_angle.hip, axis=-1)
        valid = batch_turning(motion.design, reach, swing).turns & anatomy().in_range(riders.flexion_each(motion))[:, 0]
    power = np.where(valid, power, np.nan)
    power.setflags(write=False)
    return power

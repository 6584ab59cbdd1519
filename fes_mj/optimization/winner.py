"""What a found design is worth: simulated, compared with the design it had to beat, sampled for tolerance."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.variables import lengths, with_lengths
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.optimization.assessed import Assessed
from fes_mj.optimization.buildable import Buildability
from fes_mj.optimization.optimize import Optimum
from fes_mj.riding.ride import Ride, steady_ripple
from fes_mj.statics.cycles import cycles, joint_speeds
from fes_mj.statics.turn import difference_sd, quasi_static
from fes_mj.statics.work_table import WorkTable

MANUFACTURING = 0.001  # m, each length and each coordinate of R1 and R7
LEG = 0.05  # m, thigh and shank independently
POWER_SAMPLES = 4000  # the 5th percentile of power is then known to about 1 % of the spread
PERCENTILE = 5.0


class Gain(NamedTuple):
    """Power gained over another design under the same recovered moments, and its standard deviation, W.

    The powers of both are correlated: what counts is the standard deviation of their difference. An optimiser seeks out
    what the evidence leaves open, so its gains have wide ones.
    """

    mean: float
    deviation: float


def gain(power: FloatArray, baseline: FloatArray) -> Gain:
    """Gain of one design over another, both powers by the same work_table.uncertain_table, shape (sets,)."""
    difference = power - baseline
    return Gain(float(difference[0]), float(np.linalg.norm(difference[1:])))


class Tolerance(NamedTuple):
    """Outcome of a sample: share of designs that can still turn, 5th percentile and median of their power, W.

    Those that cannot turn count as no power.
    """

    turning: float
    power_low: float
    power_median: float


def to_manufacturing(design: Design, table: WorkTable, random: np.random.Generator) -> Tolerance:
    """All lengths of the linkage off by up to MANUFACTURING, uniformly and independently."""
    drawn = lengths(design)
    shift = random.uniform(-MANUFACTURING, MANUFACTURING, (POWER_SAMPLES, len(drawn)))
    if design.linkage.kind == "trt":
        shift *= drawn != 0  # R7, R8, R9 and R10 do not exist, and are zero in it
    return _tolerance(with_lengths(design, (drawn + shift).T[..., None]), table)


def to_rider(design: Design, table: WorkTable, random: np.random.Generator) -> Tolerance:
    """Thigh and shank longer or shorter by up to LEG, uniformly and independently."""
    shift = random.uniform(-LEG, LEG, (2, POWER_SAMPLES, 1))
    legs = {"thigh": design.rider.thigh + shift[0], "shank": design.rider.shank + shift[1]}
    return _tolerance(design.with_rider(**legs), table)


def _tolerance(designs: Design, table: WorkTable) -> Tolerance:
    power = cycles(designs, table).power(designs.linkage.cadence)[:, 0]
    turning = np.isfinite(power)
    powers = np.where(turning, power, 0.0)
    return Tolerance(float(turning.mean()), float(np.percentile(powers, PERCENTILE)), float(np.median(powers)))


@dataclass(frozen=True)
class Winner(Assessed):
    """A design with everything that was found out about it under joint moments.

    reversals: of each joint in a turn. ripple: of the crank speed, steady_ripple. gain: over `compared_with` under the
    same moments, None for moments without error bars.
    """

    reversals: PerJoint[int]
    ripple: float
    gain: Gain | None
    manufacturing: Tolerance
    rider: Tolerance

    @property
    def smoothness(self) -> dict[str, float]:
        """How uneven it is, as JSON names and units it: crank power of one leg as simulated, and the crank's speed."""
        power = self.case.simulation.power
        return {
            "simulated_power_lowest_W": float(power.min()),
            "simulated_power_highest_W": float(power.max()),
            "simulated_power_peak_to_peak_W": float(np.ptp(power)),
            "speed_ripple": self.ripple,
        }

    @property
    def notes(self) -> list[str]:
        """What to beware of."""
        notes = []
        if self.gain and 0 < self.gain.mean <= self.gain.deviation:
            notes.append("the gain is within the error bar of the recovered moments; caution 1 looks for a surer one")
        if self.reversals.knee > 2:
            notes.append("the knee swings more than once per turn of the crank; can the muscles follow?")
        return notes

    @property
    def rows(self) -> list[tuple[str, str]]:
        """What was found out, as text."""
        static = self.case.static
        lowest, highest, swing, _ = self.smoothness.values()
        cells = [
            *self.answer_rows,
            ("mean crank power by statics, W", f"{static.power_mean:.3f}"),
            *self.simulated_rows,
            ("work per turn, J", f"{static.work_per_turn:.3f}"),
            *self.speed_rows,
            ("simulated power of one leg, lowest to highest, W", f"{lowest:+.0f} to {highest:+.0f}"),
            ("the same, peak to peak, W", f"{swing:.0f}"),
            ("ripple of the crank speed, two legs, fixed gear, %", f"{100 * self.ripple:.1f}"),
            ("reversals of knee and hip in a turn", f"{self.reversals.knee}, {self.reversals.hip}"),
            *self.build.rows,
        ]
        if self.gain:
            cells.append((f"gain over {self.compared_with.design.name}, W", "{:+.2f} ± {:.2f}".format(*self.gain)))
        for name, tolerance in (("lengths ±1 mm", self.manufacturing), ("thigh, shank ±5 cm", self.rider)):
            cells.append((f"{name}: can turn", f"{100 * tolerance.turning:.1f} %"))
            cells.append((f"{name}: 5th percentile of power, W", f"{tolerance.power_low:.2f}"))
        return cells

    def summary(self, optimum: Optimum) -> dict[str, Any]:
        """As Assessed.summary."""
        content = super().summary(optimum) | {
            "reversals_per_turn": dict(self.reversals.items()),
            **self.smoothness,
            "gain_W": self.gain.mean if self.gain else None,
            "gain_deviation_W": self.gain.deviation if self.gain else None,
            "tolerance_manufacturing": self.manufacturing._asdict(),
            "tolerance_rider": self.rider._asdict(),
        }
        return content | ({"front": optimum.front.as_json()} if optimum.front else {})


def assess(design: Design, compared_with: Design, moments: JointMoments, seed: int = 0) -> Winner:
    """Simulate a design against statics, compare it with another at that one's cadence, sample tolerances."""
    table, random = WorkTable.of(moments), np.random.default_rng(seed)
    turn, other = quasi_static(design, moments), quasi_static(compared_with, moments)
    deviation = difference_sd(turn, other)
    return Winner(
        case=Case(design, moments),
        compared_with=other,
        joint_speed=joint_speeds(design, table),
        reversals=cycles(design, table).joints.map(lambda joint: int(joint.reversals[0])),
        ripple=steady_ripple(Ride(design, moments, transmission="fixed")),
        gain=None if deviation is None else Gain(turn.power_mean - other.power_mean, deviation),
        manufacturing=to_manufacturing(design, table, random),
        rider=to_rider(design, table, random),
        build=Buildability.of(turn),
    )

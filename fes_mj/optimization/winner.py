"""What a found design is worth: simulated, compared with the design it had to beat, sampled for tolerance."""

from dataclasses import dataclass

import numpy as np

from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.optimization.confidence import Gain
from fes_mj.optimization.tolerance import Tolerance, to_manufacturing, to_rider
from fes_mj.riding.reduced import steady_ripple
from fes_mj.riding.ride import Ride
from fes_mj.statics.cycles import WorkTable, cycles, joint_speeds
from fes_mj.statics.turn import difference_sd, quasi_static


@dataclass(frozen=True)
class Winner:
    """A design with everything that was found out about it.

    case: simulated and cross-checked. joint_speed: mean absolute, deg/s. reversals: of each joint in a turn. ripple: of
    the crank speed, reduced.steady_ripple. gain: over `compared_with` under the same moments, None for moments without
    error bars.
    """

    case: Case
    compared_with: Design
    joint_speed: PerJoint[float]
    reversals: PerJoint[int]
    ripple: float
    gain: Gain | None
    manufacturing: Tolerance
    rider: Tolerance

    @property
    def design(self) -> Design:
        return self.case.design

    @property
    def smoothness(self) -> dict[str, float]:
        """How uneven it is, as JSON names and units it: crank power of one leg as simulated, and the crank's speed."""
        power = self.case.simulation.power
        return {
            "power_lowest_W": float(power.min()),
            "power_highest_W": float(power.max()),
            "power_peak_to_peak_W": float(np.ptp(power)),
            "speed_ripple": self.ripple,
        }

    @property
    def notes(self) -> list[str]:
        """What to beware of."""
        notes = []
        if self.gain and self.gain.mean > 0 and not self.gain.beyond_error:
            notes.append("the gain is within the error bar of the recovered moments; --caution 1 looks for a surer one")
        if self.reversals.knee > 2:
            notes.append("the knee swings more than once per turn of the crank; can the muscles follow?")
        return notes

    @property
    def rows(self) -> list[tuple[str, str]]:
        """What was found out, as text."""
        static, run, uneven = self.case.static, self.case.simulation, self.smoothness
        cells = [
            ("mean crank power by statics, W", f"{static.power_mean:.3f}"),
            ("mean crank power simulated, W", f"{run.power_mean:.3f}"),
            ("time step of the simulation, ms", f"{1e3 * run.timestep:.3g}"),
            ("work per turn, J", f"{static.work_per_turn:.3f}"),
            ("cadence, rpm", f"{static.summary()['cadence_rpm']:.1f}"),
            *((f"mean {joint} speed, deg/s", f"{speed:.1f}") for joint, speed in self.joint_speed.items()),
            (
                "simulated power of one leg, lowest to highest, W",
                f"{uneven['power_lowest_W']:+.0f} to {uneven['power_highest_W']:+.0f}",
            ),
            ("the same, peak to peak, W", f"{uneven['power_peak_to_peak_W']:.0f}"),
            ("ripple of the crank speed, two legs, fixed gear, %", f"{100 * self.ripple:.1f}"),
            ("reversals of knee and hip in a turn", f"{self.reversals.knee}, {self.reversals.hip}"),
        ]
        if self.gain:
            gain = f"{self.gain.mean:+.2f} ± {self.gain.deviation:.2f}"
            cells.append((f"gain over {self.compared_with.name}, W", gain))
        for what, tolerance in (("lengths ±1 mm", self.manufacturing), ("thigh, shank ±5 cm", self.rider)):
            cells.append((f"{what}: can turn", f"{100 * tolerance.turning:.1f} %"))
            cells.append((f"{what}: 5th percentile of power, W", f"{tolerance.power_low:.2f}"))
        return cells


def assess(design: Design, compared_with: Design, moments: JointMoments, seed: int = 0) -> Winner:
    """Simulate a design against statics, compare it with another one, sample its tolerances."""
    table, random = WorkTable.of(moments), np.random.default_rng(seed)
    return Winner(
        case=Case(design, moments),
        compared_with=compared_with,
        joint_speed=joint_speeds(design, table),
        reversals=cycles(design, table).reversals.map(lambda count: int(count[0])),
        ripple=steady_ripple(Ride(design, moments, transmission="fixed")),
        gain=gain_over(design, compared_with, moments),
        manufacturing=to_manufacturing(design, table, random),
        rider=to_rider(design, table, random),
    )


def gain_over(design: Design, compared_with: Design, moments: JointMoments) -> Gain | None:
    """Power gained over another design, each at its own cadence; None for moments whose error is not known."""
    own, other = quasi_static(design, moments), quasi_static(compared_with, moments)
    deviation = difference_sd(own, other)
    return None if deviation is None else Gain(own.power_mean - other.power_mean, deviation)

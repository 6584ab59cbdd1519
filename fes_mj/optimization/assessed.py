"""What is said of every found design, whatever drives it: simulated against statics, joint speeds, can it be built."""

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from fes_mj.budget.answer import Answer, answer, riders_of
from fes_mj.common.units import RPM
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.timing import DUTY
from fes_mj.optimization.buildable import COMMON, Buildability
from fes_mj.optimization.optimize import Optimum
from fes_mj.statics.turn import DrivenTurn, QuasiStatic


@dataclass(frozen=True)
class Assessed:
    """A design that was found. case: simulated and cross-checked. joint_speed: mean absolute, deg/s.

    compared_with: the turn of the design that it had to beat.
    """

    case: Case
    joint_speed: PerJoint[float]
    build: Buildability
    compared_with: DrivenTurn

    @property
    def design(self) -> Design:
        return self.case.design

    @cached_property
    def answer(self) -> Answer:
        """Both numbers: as the paper assumes where moments drive, and for a rider whose muscles are known."""
        drive, static = self.case.drive, self.case.static
        legs = [static] if isinstance(static, QuasiStatic) else []
        duty = drive.duty if isinstance(drive, Muscles) else DUTY
        return answer(self.design, legs, riders_of(drive), duty=duty)

    @property
    def answer_rows(self) -> list[tuple[str, str]]:
        """Both numbers as text, with the intervals in which nine of ten draws of what is not known lie."""
        rows = (
            ("as the paper assumes, W (5 to 95 %)", self.answer.paper_power, 2),
            ("for a rider, best timing, W (5 to 95 %)", self.answer.rider_power, 1),
            ("for a rider, per equally timed TRT", self.answer.rider_ratio, 2),
        )
        return [(name, estimate.text(digits)) for name, estimate, digits in rows if estimate]

    @property
    def simulated_rows(self) -> list[tuple[str, str]]:
        """What the simulation says, as text."""
        run = self.case.simulation
        return [
            ("mean crank power simulated, W", f"{run.power_mean:.3f}"),
            ("time step of the simulation, ms", f"{1e3 * run.timestep:.3g}"),
        ]

    @property
    def speed_rows(self) -> list[tuple[str, str]]:
        """How fast crank and joints move, as text."""
        joints = ((f"mean {joint} speed, deg/s", f"{speed:.1f}") for joint, speed in self.joint_speed.items())
        return [("cadence, rpm", f"{self.case.cadence / RPM:.1f}"), *joints]

    def doubts(self, optimum: Optimum) -> list[str]:
        """Why it may not be what was sought: what it leaves of the limits of what can be built, edges of the search."""
        return [*self.build.broken(optimum.problem.limits.build or COMMON).values(), *optimum.edges]

    def summary(self, optimum: Optimum) -> dict[str, Any]:
        """The result as JSON names and units it; optimum: of the search that found the design."""
        case, static = self.case, self.case.static.summary()
        people = {"power_people_W": optimum.power, "riders": optimum.riders} if optimum.problem.people.count > 1 else {}
        return {
            "kind": self.design.linkage.kind,
            "method": optimum.method,
            **{key: static[key] for key in ("group", "power_mean_W", "work_per_turn_J", "cadence_rpm")},
            "feasible": optimum.feasible,
            "violations": optimum.violations,
            "evaluations": optimum.evaluations,
            **{f"mean_{joint}_speed_deg_s": speed for joint, speed in self.joint_speed.items()},
            "simulated_power_mean_W": case.simulation.power_mean,
            "relative_difference": case.relative_difference,
            "timestep_s": case.simulation.timestep,
            "agrees": case.agrees,
            "compared_with": self.compared_with.design.name,
            "design_space": optimum.problem.limits.space,
            **asdict(self.build),
            "doubts": self.doubts(optimum),
            "repair": optimum.repair or None,
            **people,
            **self.answer.summary(),
        }

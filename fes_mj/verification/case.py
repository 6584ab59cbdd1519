"""The measured case of the cross-check with what verification adds: audit, refinement, the paper's printed values."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fes_mj.crosscheck.turn_case import Case
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.verification import energy
from fes_mj.verification.references import MomentCurves, differences, exact_curves
from fes_mj.verification.refinement import refine

if TYPE_CHECKING:
    from fes_mj.crosscheck import ride_case

STEEP = 0.15  # no leg climbs it: the tricycle stops and rolls back
STEEP_DURATION = 3.0  # s
RIDE_DURATION = 5.0  # s: some eight turns; studies/ride_verification.py rides a minute
# Of a summary, what a table of runs shows.
_ROW = (
    *("design", "group", "drive", "timing", "cadence_rpm", "timestep_s", "power_mean_W", "static_power_mean_W"),
    *("relative_difference", "work_per_turn_J", "loop_gap_max_m"),
)


class Expected(NamedTuple):
    """What print says of a design: crank power in W by rider group, joint ranges in deg."""

    power: dict[str, float]
    knee_range: tuple[float, float]
    hip_range: tuple[float, float]


@dataclass(frozen=True, eq=False)
class VerificationCase(Case):
    """A case that is verified.

    expected: printed values, of the paper's designs only. file: that the design was read from. refined: in a full run.
    ride_steps: what takes the place of steps of the rides' cases, by name: a ride with a fault. ride_timesteps: of each
    of the rides in MuJoCo, s, by default chosen by it.
    """

    expected: Expected | None = None
    file: Path | None = None
    refined: bool = False
    ride_steps: Mapping[str, Any] = field(default_factory=dict, kw_only=True)
    ride_timesteps: tuple[float | None, ...] = (None, None, None)

    @cached_property
    def two_legs(self) -> Case:
        """The same with two legs half a turn apart on one crank."""
        return replace(self, legs=2, label=f"{self.name}, two legs")

    @cached_property
    def rides(self) -> "list[ride_case.RideCase]":
        """Short rides launched at the speed of the cadence: flat with either transmission, and rolling back."""
        from fes_mj.crosscheck.ride_case import RideCase  # needs SciPy and numba, which a turn does not
        from fes_mj.riding.ride import TRANSMISSIONS, Ride, Road
        from fes_mj.riding.stimulated import TIMINGS, stimulated_rider

        if isinstance(self.drive, JointMoments):
            ride = Ride(self.design, self.drive, duration=RIDE_DURATION)
        elif self.drive.timing in TIMINGS:
            ride = Ride(self.design, stimulated_rider(self.drive, self.design, self.cadence), duration=RIDE_DURATION)
        else:  # which no stimulator knows on a road
            return []
        ride = replace(ride, launch=self.cadence * ride.travel)
        flat = [replace(ride, transmission=kind) for kind in TRANSMISSIONS]
        steep = replace(ride, transmission="fixed", road=Road(slope=STEEP), duration=STEEP_DURATION)
        kind = type("RideCase", (RideCase,), dict(self.ride_steps))
        return [kind(one, step) for one, step in zip((*flat, steep), self.ride_timesteps, strict=True)]

    audit = cached_property(energy.audit)  # where the work of the joint moments went
    refinement = cached_property(refine)  # the run at other time steps and loop stiffnesses

    @cached_property
    def curves(self) -> dict[str, MomentCurves]:
        """Crank moment by the exact methods beside what was measured, by family, N m."""
        exact = exact_curves(self, self.audit.crank_angle)
        massless = exact_curves(self, self.massless.crank_angle)["massless"]
        measured = {"torque sensor": self.audit.crank_moment, "servo": self.audit.servo_moment}
        return {
            "massless": massless | {"simulation": self.massless.crank_moment},
            "massive": exact["massive"] | measured,
        }

    @property
    def uncertainty(self) -> float:
        """Numerical uncertainty of the mean power, W; NaN without refinement."""
        return self.refinement.uncertainty * self.power_scale if self.refined else math.nan

    def row(self) -> dict[str, Any]:
        """The case as the row of a table of runs."""
        return {key: value for key, value in self.summary().items() if key in _ROW} | {
            "numerical_uncertainty_W": self.uncertainty
        }

    def as_json(self) -> dict[str, Any]:
        """Everything but the curves."""
        return self.row() | {
            "crank_moment_differences_Nm": {
                family: {f"{one} - {other}": value for (one, other), value in differences(curves).items()}
                for family, curves in self.curves.items()
            },
            "energy_J": self.audit.terms,
            "refinement": self.refinement.as_json() if self.refined else None,
        }

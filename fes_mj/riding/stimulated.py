"""Muscles as what drives a ride: one rider, and when a stimulator that knows the crank's angle and speed asks for what.

The windows are those at one cadence. A stimulator in use advances them with the crank's speed w: here by delay w, which
is what the crank turns until the muscles feel it, and by atan(w rise), what the first harmonic of their answer lags,
each less what it is at the cadence of the windows. So the delay drops out: at a crank angle muscles feel what they feel
there at that cadence, given ahead by atan(w rise) - atan(w0 rise). At a stand and rolling back this is as good.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.common.machine_code import machine_code
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.power import MuscleTurn
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import BEST, MEASURED, known_motion
from fes_mj.muscles.step import Stimulus, stimulation
from fes_mj.muscles.timing import TURN_ANGLES, Windows, responded

TIMINGS = (BEST, MEASURED)


class Stimulator(NamedTuple):
    """What muscles are asked for. stimulus: as they feel it at the cadence of the windows. lag: rad, of the first
    harmonic of their answer there. rise, fall: of activation, s.
    """

    stimulus: Stimulus
    lag: float
    rise: float
    fall: float


NO_STIMULATOR = Stimulator(Stimulus(np.zeros(0), np.zeros(0), 1.0), 0.0, 1.0, 1.0)


@dataclass(frozen=True, eq=False, repr=False)
class StimulatedRider(Brief):
    """One rider whose muscles are stimulated in windows at a cadence, rad/s; `riders` has one member."""

    riders: Riders
    windows: Windows
    cadence: float
    timing: str = BEST

    @property
    def brief(self) -> str:
        return f"{self.name}, {self.timing} at {self.cadence / RPM:.1f} rpm"

    @property
    def name(self) -> str:
        return f"{self.riders.name} muscles"

    @property
    def driver(self) -> str:
        """What moves the legs, in a few words, as of Muscles."""
        return f"{self.name}, timing {self.timing}"

    @property
    def measured_on(self) -> ReferenceTricycle:
        """Where the fastest joints were."""
        return PAPER_TRICYCLE

    @property
    def stimulator(self) -> Stimulator:
        """In the form that machine code reads."""
        rise = float(self.riders["rise_s"].item())
        windows = self.windows.shifted(np.degrees(self.cadence * float(self.riders["delay_s"].item())))
        lag, fall = math.atan(self.cadence * rise), float(self.riders.fall.item())
        return Stimulator(Stimulus.of(windows, self.cadence), lag, rise, fall)

    def require_range(self, design: Design) -> None:
        """Raise AssemblyError if a linkage does not turn, InputError where muscle lengths are not known."""
        known_motion(self.riders, design)

    def power_mean(self, design: Design, cadence: float) -> float:
        """Of one leg at a steady cadence, rad/s, W: at the windows' own that of statics."""
        pulled = pull(self.riders, kinematics.solve(design, TURN_ANGLES), cadence)
        active = responded(
            felt_over(self.stimulator, TURN_ANGLES, cadence)[:, None, None], self.riders, np.full((1, 1), cadence)
        )
        return float(MuscleTurn(pulled, active).power_mean.item())

    def summary(self) -> dict[str, Any]:
        """As JSON names and units it."""
        return {
            "drive": "muscles",
            "group": self.riders.name,
            "timing": self.timing,
            "windows_deg": self.windows_deg,
            "windows_at_rpm": self.cadence / RPM,
        }

    @property
    def windows_deg(self) -> dict[str, list[float] | None]:
        """[on, off] by group at the cadence, before delay and activation, deg of crank."""
        return self.windows.by_group()


def stimulated_rider(muscles: Muscles, design: Design, cadence: float | None = None) -> StimulatedRider:
    """The most probable rider, in the windows that are best for all at a cadence in rad/s, by default the design's.

    Raises InputError for a timing without windows, and as rules.stimulated.

    >>> fes_mj.stimulated_rider(fes_mj.load_muscles("p1p2"), fes_mj.load_design("d1"))
    <StimulatedRider p1p2 muscles, best at 96.4 rpm>
    """
    if muscles.timing not in TIMINGS:
        raise InputError(f"timing is {muscles.timing!r}; a ride knows the windows of {' and '.join(TIMINGS)} alone")
    cadence = float(crank_speed(design, cadence))
    one = muscles.simulated(design, cadence)
    assert one.windows is not None
    return StimulatedRider(one.riders, one.windows, cadence, muscles.timing)


@machine_code
def lead(stimulator: Stimulator, crank_speed: float) -> float:
    """By how much ahead of the crank, rad, the stimulation is that muscles feel at a speed in rad/s."""
    return math.atan(crank_speed * stimulator.rise) - stimulator.lag


def felt_over(stimulator: Stimulator, angle: FloatArray, crank_speed: float) -> FloatArray:
    """Stimulation of every group in [0, 1] that its muscles feel at crank angles, shape (groups, angles)."""
    groups, felt = range(len(stimulator.stimulus.on)), (angle + lead(stimulator, crank_speed)).tolist()
    return np.array([[stimulation(stimulator.stimulus, group, at) for at in felt] for group in groups])

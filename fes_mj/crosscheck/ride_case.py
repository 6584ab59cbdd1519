"""A ride by two solvers that share little, MuJoCo and the reduced equation of motion: what is compared, the verdict."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import mujoco
import numpy as np

from fes_mj.common.brief import Brief
from fes_mj.common.checks import LEAST_POWER, Check, check
from fes_mj.common.errors import UnstableError
from fes_mj.common.provenance import versions
from fes_mj.common.writing import csv_text
from fes_mj.riding.differences import speed_difference, work_scale
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.riding.verdict import NO_AGREEMENT, outside_known, sentence, verdict
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.road import RoadRun, ride_on_road
from fes_mj.simulation.road_control import RoadControl, road_control
from fes_mj.simulation.road_step import finer_timestep, ride_timestep, tried_timestep


@dataclass(frozen=True, eq=False, repr=False)
class RideCase(Brief):
    """A ride, computed when it is first asked for, by either solver.

    The methods up to `reference` are its steps; a subclass that replaces one of them is a ride with a fault in one
    solver. timestep: of MuJoCo, s.

    >>> ride = fes_mj.Ride(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), duration=5)
    >>> fes_mj.RideCase(ride).agrees
    True
    """

    ride: Ride
    timestep: float | None = None

    @property
    def brief(self) -> str:
        return self.ride.name

    # The steps.

    record: ClassVar[type[RoadRun]] = RoadRun  # what is made of MuJoCo's sensors

    def edit_model(self, spec: Spec) -> None:
        """Change the MuJoCo model before it is compiled; nothing is changed here."""

    def control(self, model: mujoco.MjModel) -> RoadControl:
        """What muscles and freewheel do in each step of MuJoCo."""
        return road_control(self.ride, model)

    @cached_property
    def reference(self) -> Trace:
        """By the reduced equation of motion."""
        return ride_by_equation(self.ride)

    @cached_property
    def runs(self) -> tuple[RoadRun, RoadRun]:
        """By MuJoCo for as long as the reference rides: a trial run, then one as it shall be.

        The trial's step is twice as long, which says whether the closed form has chosen it well; where that is too long
        for MuJoCo, half of it; beside a step that is given, half of that. A run that fails a check for its step becomes
        the trial of a finer one. Raises UnstableError if it breaks down, InputError for too many steps.
        """
        step = ride_timestep(self.reference) if self.timestep is None else self.timestep
        try:
            trial = self.simulated(2 * step)
        except UnstableError:
            trial = self.simulated(step if self.timestep is None else step / 2)
        if self.timestep is not None:
            return trial, self.simulated(step)
        run, failed = self.simulated(tried_timestep(self.reference, trial)), None
        while finer := finer_timestep(self.reference, run, failed):
            trial = failed = run
            run = self.simulated(finer)
        return trial, run

    @property
    def trial(self) -> RoadRun:
        """The first, which says how exact the second is."""
        return self.runs[0]

    @property
    def simulation(self) -> RoadRun:
        """The second."""
        return self.runs[1]

    def simulated(self, timestep: float) -> RoadRun:
        """By MuJoCo with a time step in s."""
        return ride_on_road(
            self.ride,
            timestep,
            until=float(self.reference.time[-1]),
            edit=self.edit_model,
            control=self.control,
            record=self.record,
        )

    # What is concluded.

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The comparison."""
        run, mine, other = self.simulation, self.simulation.trace, self.reference
        turns_apart = 0.0 if mine.rides and other.rides else abs(mine.turns - other.turns)  # where they stop
        values = {
            "ride_verdict": turns_apart if mine.rides == other.rides else math.inf,
            "ride_speed": speed_difference(mine, other),
            "ride_settled": relative(mine.mean_speed, other.mean_speed),
            "ride_power": self._power_difference(),
            "ride_energy": abs(run.lost) / work_scale(mine),
            "loop_gap": run.loop_gap_max,
        }
        return tuple(check(name, value, self.ride.name) for name, value in values.items())

    def _power_difference(self) -> float:
        """Mean power of MuJoCo's muscles less what the reference's road takes and its motion gains, per the largest."""
        delivered, taken = self.simulation.trace.muscle_power, self.reference.road_power
        gained = self.reference.gained_power
        if delivered is None or taken is None or gained is None:
            return 0.0 if delivered is taken is None else math.inf
        return abs(delivered - taken - gained) / max(abs(delivered), abs(taken), abs(gained), LEAST_POWER)

    @property
    def agrees(self) -> bool:
        return all(check.ok for check in self.checks)

    @cached_property
    def uncertainty(self) -> dict[str, float]:
        """Relative error of the speed (speed_difference) that the steps of each solver leave, by its name.

        MuJoCo's by Richardson's extrapolation from the trial run, at second order. The reduced model's is the whole
        difference from half its steps.
        """
        run, trial = self.simulation, self.trial
        coarser = abs((trial.timestep / run.timestep) ** 2 - 1)
        return {
            "mujoco": speed_difference(trial.trace, run.trace) / coarser,
            "reduced": speed_difference(self.reference, ride_by_equation(self.ride, 2)),
        }

    @property
    def sentence(self) -> str:
        """The verdict in words, with the speed if there is one."""
        if not self.agrees:
            return "Whether it rides, and how fast, is not known."
        return sentence(self.simulation.trace)

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it; none if the solvers do not agree."""
        run, word = self.simulation, verdict(self.simulation.trace)
        results = run.trace.summary() | {
            "verdict": word.word,
            "stopped_because": None if run.trace.rides else word.reason,
        }
        results |= {"outside_known": outside_known(run.trace), "reduced": self.reference.summary()}
        if not self.agrees:
            results = dict.fromkeys(results) | {"verdict": NO_AGREEMENT}
        return self.ride.summary() | {
            **results,
            "agrees": self.agrees,
            "checks": [check.as_json() for check in self.checks],
            "numerical_uncertainty": self.uncertainty,
            "energy_lost_J": run.lost,
            "loop_gap_max_m": run.loop_gap_max,
            "timestep_s": run.timestep,
            "versions": versions("fes-mj", "mujoco", "numpy"),
        }

    def trace_csv(self) -> str:
        """MuJoCo's ride as CSV, a row a time step, with the reference's speed at the same time."""
        mine, other = self.simulation.trace, self.reference
        return csv_text(
            {
                "time_s": mine.time,
                "crank_angle_deg": np.degrees(mine.crank_angle),
                "crank_speed_rad_s": mine.crank_speed,
                "distance_m": mine.distance,
                "speed_m_s": mine.speed,
                "reduced_speed_m_s": np.interp(mine.time, other.time, other.speed),
                "freewheeling": mine.coasting.astype(int),
                "muscle_work_J": mine.muscle_work,
                "road_work_J": mine.road_work,
            }
        )


def relative(one: float | None, other: float | None) -> float:
    """Difference of two values per the second; 0 if there is neither, infinite if there is only one."""
    if one is None or other is None:
        return 0.0 if one is other else math.inf
    return abs(one / other - 1)

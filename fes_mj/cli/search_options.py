"""Options of `fes_mj optimize`: what is searched for, how, and by which limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.errors import InputError
from fes_mj.torque import JointMoments, load_moments

if TYPE_CHECKING:
    from fes_mj.optimization.problem import Problem

Methods = Literal["differential-evolution", "cma-es", "nsga-ii", "random-pursuit"]


@Parameter(name="*")
@dataclass
class SearchOptions:
    """Options of a search.

    Parameters
    ----------
    group
        Rider group whose recovered joint moments are used (default p1p2); nsga-ii weighs both.
    moments
        Your own joint moments instead: a CSV with the header crank_angle_deg,knee_Nm,hip_Nm.
    method
        The method; cma-es and nsga-ii come with the extra `optimize`.
    budget
        Evaluations of each search (default 50,000; random pursuit stops by itself).
    searches
        Independent searches, of which the best counts (nsga-ii makes one).
    seed
        Of the random numbers; the same seed finds the same design, however many jobs.
    start
        A feasible design to start from (trt, r1, ..., or a file); by default random ones.
    speeds_of
        The design whose mean joint speeds are the limits, and whose power is compared.
    knee_speed_limit
        Largest mean absolute knee speed in deg/s instead (107.1 in the TRT).
    hip_speed_limit
        Largest mean absolute hip speed in deg/s instead (69.1 in the TRT).
    caution
        Take so many standard deviations of the gain off it: finds designs that win for sure (not with --moments).
    smooth
        With nsga-ii: also the least coefficient of fluctuation.
    problem
        Your own limits, search ranges and design space: an edited copy of optimization.toml.
    jobs
        Processes; each search is a task.
    cluster
        Dask scheduler, tcp://host:port, to send the searches to.
    """

    group: Literal["p1p2", "p1p3"] | None = None
    moments: Path | None = None
    method: Methods = "differential-evolution"
    budget: int | None = None
    searches: int = 4
    seed: int = 0
    start: str | None = None
    speeds_of: str = "trt"
    knee_speed_limit: float | None = None
    hip_speed_limit: float | None = None
    caution: float = 0.0
    smooth: Annotated[bool, Parameter(negative="")] = False
    problem: Path | None = None
    jobs: int = 1
    cluster: str | None = None

    def check(self) -> None:
        """Refuse unusable options before anything runs."""
        if self.group and self.moments:
            raise InputError("--group and --moments exclude each other; a file of moments is a group of its own")
        if self.budget is not None and self.budget < 1000:
            raise InputError(f"--budget is {self.budget}; it must be at least 1000 evaluations (a second makes 50,000)")
        if self.searches < 1:
            raise InputError(f"--searches is {self.searches}; it must be at least 1")
        if self.seed < 0:
            raise InputError(f"--seed is {self.seed}; it must not be negative")
        if not 0 <= self.caution <= 10:
            raise InputError(f"--caution is {self.caution:g}; it must be from 0 to 10 standard deviations")
        if self.caution and (self.moments or self.method == "nsga-ii"):
            raise InputError(
                "--caution needs the error bars of one group's recovered moments: not with --moments or nsga-ii"
            )
        if self.smooth and self.method != "nsga-ii":
            raise InputError("--smooth is an objective of its own: it needs --method nsga-ii")

    def load_moments(self) -> JointMoments:
        """The joint moments that the options name."""
        return load_moments(self.moments or self.group or "p1p2")

    def load_start(self, kind: str) -> Design | None:
        """The design to start from, if one is given. Raises InputError if it is of another kind."""
        first = load_design(self.start) if self.start else None
        if first and first.linkage.kind != kind:
            raise InputError(
                f"--start {self.start} is a {first.linkage.kind}, not a {kind}; start from a design of that kind"
            )
        return first

    def task(self, kind: str, moments: JointMoments, rival: Design, start: Design | None) -> Problem:
        """The problem that the options describe."""
        from fes_mj.optimization.confidence import uncertain_table
        from fes_mj.optimization.cycles import WorkTable, cycles, joint_speeds
        from fes_mj.optimization.problem import Problem
        from fes_mj.optimization.problem_file import DEFAULT, load_limits

        limits = load_limits(self.problem or DEFAULT)
        table = uncertain_table(moments) if self.caution else WorkTable.of(moments)
        # the rider, seat and coupler angle of the start, or of the printed six-bars
        template = start or load_design("r1" if kind == "crt" else "d1")
        own, given = joint_speeds(rival, table), {"knee": self.knee_speed_limit, "hip": self.hip_speed_limit}
        # a hair above, so that the design itself is within its own limits
        knee, hip = (own[joint] * (1 + 1e-9) if limit is None else limit for joint, limit in given.items())
        baseline = cycles(rival, table).work[0] * rival.linkage.cadence / (2 * math.pi)
        return Problem(template, table, limits, knee, hip, self.caution, baseline)

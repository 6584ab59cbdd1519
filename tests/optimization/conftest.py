"""The paper's problem, which tests of every method solve."""

from dataclasses import replace

import fes_mj
from fes_mj.optimization.limits import load_limits
from fes_mj.optimization.problem import Problem
from fes_mj.statics.cycles import joint_speeds
from fes_mj.statics.work_table import WorkTable

TABLE = WorkTable.of(fes_mj.load_moments("p1p2"))


def problem_of(name: str, grashof_min: float = 0.0) -> Problem:
    """The paper's problem with the joint speeds of one of its designs."""
    design = fes_mj.load_design(name)
    speeds = joint_speeds(design, TABLE)
    limits = replace(load_limits(), grashof_min=grashof_min)
    return Problem(design, TABLE, limits, speeds.map(lambda speed: speed * (1 + 1e-9)))

"""A case of the cross-check as JSON and CSV name and unit it."""

from importlib.metadata import version
from typing import Any

import numpy as np

from fes_mj.common.writing import csv_text
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.turning import FROM_TOP, turning
from fes_mj.statics.characteristics import power_characteristics


def turn_summary(case: Case) -> dict[str, Any]:
    """The result, for JSON."""
    run = case.simulation
    static = case.static.summary() | case.joint_forces.summary()
    return static | {
        "power_mean_W": run.power_mean,
        "work_per_turn_J": 2 * np.pi * run.power_mean / run.cadence,
        "knee_range_deg": run.joint_range_deg.knee,
        "hip_range_deg": run.joint_range_deg.hip,
        **power_characteristics(run.power, run.turns),
        "power_sd_W": case.statics.power_sd,
        "static_power_mean_W": case.static_power_mean,
        "relative_difference": case.relative_difference,
        "loop_gap_max_m": run.loop_gap_max,
        "cadence_ripple": run.cadence_ripple,
        "agrees": case.agrees,
        "checks": [check.as_json() for check in case.checks],
        "legs": len(run.legs),
        "turns": run.turns,
        "timestep_s": run.timestep,
        "loop_force_max_N": {loop: float(np.abs(force).max()) for loop, force in run.loop_force.items()},
        "energy_J": run.energy.as_json(),
        "versions": {name: version(name) for name in ("fes-mj", "mujoco", "numpy")},
    }


def cycle_csv(case: Case) -> str:
    """The measured turns as CSV, a row a time step."""
    run = case.simulation
    return csv_text(
        {
            "crank_angle_deg": np.degrees(run.crank_angle),
            FROM_TOP: turning(case.design).degrees_from_top(run.crank_angle),
            "crank_power_W": run.power,
            "inverse_dynamics_power_W": case.reference_power(),
            "quasi_static_power_W": case.reference_power(mass_scale=0.0),
            **{f"{name}_deg": np.degrees(angle) for name, angle in run.joint_angle.items()},
            **{f"{name}_Nm": moment for name, moment in run.joint_moment.items()},
            **{f"{name}_gap_m": gap for name, gap in run.loop_gap.items()},
        }
    )

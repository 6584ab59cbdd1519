"""What a sweep finds out about each of its points: statics in a batch, a turn of riders and a simulated turn each."""

from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError, UnstableError
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve, uniform_turn
from fes_mj.linkage.legs import all_legs
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.linkage.variables import COMPONENTS, crank_speed, replaced
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import TorqueMap, torque_map
from fes_mj.muscles.drive import Muscles
from fes_mj.statics.characteristics import motion_characteristics, power_characteristics
from fes_mj.statics.cycles import Cycles, cycles
from fes_mj.statics.drive import Drive, torque_source
from fes_mj.statics.equilibrium import virtual_work
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import turn_points
from fes_mj.statics.validity import obstacles
from fes_mj.statics.work_table import WorkTable, uncertain_table
from fes_mj.sweep.study import NAMES, Study

Columns: TypeAlias = dict[str, NDArray[Any]]

_STATIC = {
    "cadence_rpm": float,
    "turns": bool,
    "why": str,
    "power_mean_W": float,
    "power_sd_W": float,
    "extrapolated_share": float,
    "work_per_turn_J": float,
    **{name.format(joint): float for joint in JOINTS for name in ("{}_min_deg", "{}_max_deg", "mean_{}_speed_deg_s")},
}
_CHARACTERISTICS = (
    *("inactive_zone_share", "power_peak_to_peak_W", "power_peak_to_mean", "energy_fluctuation"),
    *("transmission_angle_min_deg", "length_m", "height_m"),
)
_AT_ONCE = 50  # designs, for whose power over the turn arrays of a few megabytes are needed
_OF_MUSCLES = ("power_mean_W", "power_sd_W", "work_per_turn_J", "extrapolated_share")  # another power than the moments'
_DYNAMIC = {"simulated_power_mean_W": float, "loop_gap_max_m": float, "cadence_ripple": float, "timestep_s": float}


def column_types(study: Study) -> dict[str, type]:
    """Name and type of every column of the results, in their order: point, axes, results.

    why: None, or why there is no power. A cadence that is varied is a result as well: the same column.
    """
    axes = {axis: str if axis in NAMES else float for axis in (*study.grid, *study.sample)}
    more = dict.fromkeys(_more(study), float)
    return {"point": int} | axes | _STATIC | more | (_DYNAMIC if study.analysis == "dynamic" else {})


def _more(study: Study) -> list[str]:
    """Quasi-static results beyond the usual: of muscles in motion the power of the rider who is simulated."""
    simulated = [*(["power_mode_W"] if study.muscles and study.analysis == "dynamic" else ())]
    return [*(_CHARACTERISTICS if study.characteristics else ()), *simulated]


def evaluate(study: Study, chunk: int) -> Columns:
    """Results of the points of a chunk, a column each as column_types says; NaN and None for what is not known."""
    columns = study.rows(chunk)
    varied = {name: values for name, values in columns.items() if name in COMPONENTS}
    count = len(columns["point"])
    for name, kind in column_types(study).items():
        if name not in columns:
            columns[name] = np.empty(count, object if kind is str else kind)
    for label, design in study.designs.items():
        for name, moments in study.moments.items():
            rows = np.flatnonzero((columns["design"] == label) & (columns["moments"] == name))
            if rows.size:
                values = {variable: column[rows] for variable, column in varied.items()}
                batch = replaced(design, {variable: column[:, None] for variable, column in values.items()})
                chosen_rpm = values.get("cadence_rpm")
                rpm = np.broadcast_to(
                    np.ravel(batch.linkage.cadence) / RPM if chosen_rpm is None else chosen_rpm, rows.shape
                )
                results = _static(batch, rpm, moments)
                drive = study.muscles[name] if study.muscles else moments
                if isinstance(drive, Muscles):
                    results |= _by_muscles(batch, rpm, drive, study)
                elif study.characteristics:
                    results |= _characteristics(batch, rpm, drive, study.legs, results["why"])
                if study.analysis == "dynamic":
                    results |= _dynamic(batch, chosen_rpm, drive, study, results["why"])
                for key, column in results.items():
                    columns[key][rows] = column
    columns["why"][columns["why"] == ""] = None
    return columns


def _static(batch: Design, rpm: FloatArray, moments: JointMoments) -> Columns:
    """Quasi-static results of the points of a batch at their cadences, shape (points,)."""
    certain = moments.covariance is None
    turn = cycles(batch, WorkTable.of(moments) if certain else uncertain_table(moments))
    turns_per_s, why = turns_per_second(rpm * RPM), _reasons(turn, rpm)
    work, power = (np.where((why == "")[:, None], values, np.nan) for values in (turn.work, turn.power(rpm * RPM)))
    deviation = np.hypot(np.linalg.norm(power[:, 1:], axis=1), turn.outside_sd * turns_per_s)
    result: dict[str, Any] = {
        "cadence_rpm": rpm,
        "turns": turn.turns,
        "why": why,
        "power_mean_W": power[:, 0],
        "power_sd_W": np.nan if certain else deviation,
        "extrapolated_share": turn.outside[0],
        "work_per_turn_J": work[:, 0],
    }
    for joint in JOINTS:
        result |= {
            f"{joint}_min_deg": np.degrees(turn.joints[joint].low),
            f"{joint}_max_deg": np.degrees(turn.joints[joint].high),
            f"mean_{joint}_speed_deg_s": np.degrees(turn.joints[joint].travel) * turns_per_s,
        }
    return result


def _characteristics(
    batch: Design, rpm: FloatArray, moments: JointMoments, legs: int, why: NDArray[np.object_]
) -> Columns:
    """Of the points of a batch that have a power, of all legs together."""
    torque, rows = torque_map(moments), np.flatnonzero(why == "")
    result = {name: np.full(len(why), np.nan) for name in _CHARACTERISTICS}
    for start in range(0, len(rows), _AT_ONCE):
        block = rows[start : start + _AT_ONCE]
        motion, cadence = solve(batch.taken(block)), rpm[block, None] * RPM
        power = all_legs(np.atleast_2d(cadence * virtual_work(motion, torque.along(motion, cadence))), legs)
        for name, value in (power_characteristics(power) | motion_characteristics(motion)).items():
            result[name][block] = value
    return result


def _reasons(turn: Cycles, rpm: FloatArray) -> NDArray[np.object_]:
    """Why `fes_mj static` refuses each of the points: the first reason that holds, "" if none does."""
    why = np.full(len(rpm), "", object)
    for reason, hindered in reversed(obstacles(turn, rpm * RPM)):
        why[np.broadcast_to(hindered, len(rpm))] = reason
    return why


def _by_muscles(batch: Design, rpm: FloatArray, muscles: Muscles, study: Study) -> Columns:
    """Results of the points of a batch that muscles drive, one after the other: each is a turn of every rider."""
    result: Columns = {key: np.full(len(rpm), np.nan) for key in (*_OF_MUSCLES, *_more(study))}
    why = np.full(len(rpm), "", object)
    for row, speed in enumerate(rpm.tolist()):
        design = batch.single(row)
        try:
            turn = MuscleStatic.solve(design, muscles.riders, speed * RPM, muscles.timing, muscles.duty, study.legs)
        except InputError as error:
            why[row] = str(error).removeprefix(f"{design.name}: ")
            continue
        summary = turn.summary()
        for key, column in result.items():
            column[row] = summary[key]
    return result | {"why": why}


def _dynamic(batch: Design, rpm: FloatArray | None, drive: Drive, study: Study, why: NDArray[np.object_]) -> Columns:
    """One simulated turn of every point that has a power, the loop under a torque map in machine code.

    rpm: cadences, if they are not the designs' own. Of muscles it is the most probable rider. Why a run breaks down, is
    refused or does not agree with statics goes to `why`.
    """
    from fes_mj.simulation.bench import BenchOptions, simulate

    result = {name: np.full(len(why), np.nan) for name in _DYNAMIC}
    for row in np.flatnonzero(why == ""):
        design = batch.single(int(row))
        speed = crank_speed(design, None if rpm is None else float(rpm[row]) * RPM)
        try:
            torque = torque_source(drive, design, speed)
            static, options = _power(design, torque, speed), BenchOptions(torque=torque)
            if isinstance(torque, TorqueMap):
                from fes_mj.simulation.compiled import compiled_loop

                options = replace(options, make_loop=compiled_loop)
            run = simulate(design, drive, cadence=speed, timestep=study.timestep, legs=study.legs, options=options)
        except (UnstableError, InputError) as error:  # it breaks down, or needs more steps than there may be
            why[row] = str(error).removeprefix(f"{design.name}: ")
            continue
        if failed := [check.name for check in run.checks(static) if not check.ok]:
            why[row] = f"dynamic and static do not agree: {', '.join(failed)}"
            continue
        measured = (run.power_mean, run.loop_gap_max, run.cadence_ripple, run.timestep)
        for name, value in zip(result, measured, strict=True):
            result[name][row] = value
    return result


def _power(design: Design, torque: TorqueSource, cadence: float) -> float:
    """Quasi-static mean crank power of one leg, W; cadence: rad/s."""
    motion = solve(design, uniform_turn(turn_points(design)))
    return float(np.mean(cadence * virtual_work(motion, torque.along(motion, cadence))))

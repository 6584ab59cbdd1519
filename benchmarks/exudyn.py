"""One turn of D1 and R2 in EXUDYN and in the project: time against the error of the instantaneous crank power.

The same bodies under the same torque map, models assembled, the error against the exact inverse dynamics. Runs
alternate in one process, the median time counts. EXUDYN integrates by the trapezium rule on index 2, which beats its
generalised-alpha method on index 3 here, its torques come from a Python function. Each takes the fewest steps of a list
that reach the error asked for. Needs the group "benchmark"; writes results/benchmarks/exudyn.json.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

sys.exudynFast = True  # type: ignore[attr-defined]  # EXUDYN's build without range checks
import exudyn as exu  # noqa: E402
from exudyn import itemInterface as items  # noqa: E402, N813

import fes_mj  # noqa: E402
from benchmarks import record  # noqa: E402
from fes_mj.common.console import print_table  # noqa: E402
from fes_mj.linkage.inertia import GRAVITY, inertias  # noqa: E402
from fes_mj.linkage.kinematics import solve  # noqa: E402
from fes_mj.linkage.legs import ONE_LEG  # noqa: E402
from fes_mj.moments.torque_map import torque_map  # noqa: E402
from fes_mj.simulation.compiled import compiled_loop  # noqa: E402
from fes_mj.simulation.mjcf import UNDRAWN, build_mjcf  # noqa: E402
from fes_mj.simulation.stepping import (  # noqa: E402
    PRE_ROLL,
    Sensors,
    feedback_loop,
    run_loop,
)
from fes_mj.statics.equilibrium import crank_moment  # noqa: E402

DESIGNS, ASKED, REPETITIONS = ("d1", "r2"), 0.005, 15  # W rms
STEPS, MOMENTS = [round(200 * 2 ** (k / 8)) for k in range(33)], fes_mj.load_moments("p1p2")  # a turn
# Runs a turn of so many steps; gives crank angle (rad) and power (W) at each.
Turn: TypeAlias = Callable[[int], tuple[Any, Any]]


def exudyn_turn(design: fes_mj.Design) -> Turn:
    """Links in absolute coordinates, pins as joints, the crank's speed as a constraint whose force is measured."""
    mbs, cadence, motion = exu.SystemContainer().AddSystem(), design.linkage.cadence, solve(design, np.zeros(1))
    frames = {"frame": (mbs.AddObject(items.ObjectGround()), 0j, 1 + 0j)}  # object, origin, direction of x
    still = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0))
    angle, turning = {}, {}
    for body, inertia in inertias(design).items():
        centre, along = motion.body_point(body, inertia.centre), complex(*motion.direction(body))
        place, speed, angle[body] = complex(*np.ravel(centre.value)), complex(*centre.first), float(np.angle(along))
        rates = cadence * np.array([speed.real, speed.imag, *motion.rotation[body].first])
        pose = [place.real, place.imag, angle[body]]
        node = mbs.AddNode(items.NodeRigidBody2D(initialCoordinates=pose, initialVelocities=rates))
        link = mbs.AddObject(items.RigidBody2D(mass=inertia.mass, inertia=inertia.moment, nodeNumber=node))
        weight = mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=link))
        mbs.AddLoad(items.Force(markerNumber=weight, loadVector=[0, -inertia.mass * GRAVITY, 0]))
        frames[body] = (link, place, along)
        turning[body] = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    for pin, bodies in design.linkage.architecture.joints.items():
        markers = []
        for link, place, along in (frames[body] for body in bodies):
            local = (complex(*np.ravel(motion.points[pin].value)) - place) / along
            at = items.MarkerBodyPosition(bodyNumber=link, localPosition=[local.real, local.imag, 0])
            markers.append(mbs.AddMarker(at))
        mbs.AddObject(items.RevoluteJoint2D(markerNumbers=markers))
    bent = float(*motion.joint_angle.knee) - angle["thigh"] + angle["shank"]
    drive(mbs, "hip", [still, turning["thigh"]], float(*motion.joint_angle.hip) - angle["thigh"])
    drive(mbs, "knee", [turning["shank"], turning["thigh"]], bent)
    hold = {"markerNumbers": [still, turning["crank"]], "velocityLevel": True, "offset": cadence}
    servo, force = mbs.AddObject(items.CoordinateConstraint(**hold)), exu.OutputVariableType.Force
    sensor = mbs.AddSensor(items.SensorObject(objectNumber=servo, outputVariableType=force, storeInternal=True))
    mbs.Assemble()

    def turn(steps: int) -> tuple[Any, Any]:
        count, step, settings = steps + PRE_ROLL, 2 * np.pi / cadence / steps, exu.SimulationSettings()
        run, newmark = settings.timeIntegration, settings.timeIntegration.generalizedAlpha
        run.numberOfSteps, run.endTime, run.verboseMode, run.adaptiveStep = count, count * step, 0, False
        newmark.useNewmark = newmark.useIndex2Constraints = run.newton.useModifiedNewton = True
        settings.solution.file.write, settings.solution.sensors.writePeriod = False, step / 2
        mbs.SolveDynamic(settings)
        moments = np.asarray(mbs.GetSensorStoredData(sensor))[-steps:]
        return cadence * moments[:, 0], cadence * moments[:, 1]

    return turn


def drive(mbs: Any, joint: str, markers: list[int], zero: float) -> None:
    """The torque map between two angles; their difference plus `zero` (rad) is the joint's angle."""
    moment = torque_map(MOMENTS).feedback(joint)

    def force(mbs: Any, t: float, item: int, turn: float, rate: float, *rest: float) -> float:
        return -moment(turn + zero, rate)

    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=markers, springForceUserFunction=force))


def our_turn(design: fes_mj.Design, make_loop: Any) -> Turn:
    """The project's own run, its model compiled."""
    cadence, loop = design.linkage.cadence, make_loop(torque_map(MOMENTS), ONE_LEG)
    model = build_mjcf(design, options=UNDRAWN).compile()

    def turn(steps: int) -> tuple[Any, Any]:
        model.opt.timestep = 2 * np.pi / cadence / steps
        rows = Sensors(model, run_loop(model, loop, steps).sensors[1:-1])
        return rows["crank_angle"], cadence * rows.crank_moment()

    return turn


def error(design: fes_mj.Design, turn: Turn, steps: int) -> float:
    """Rms of the crank power against the exact inverse dynamics, W."""
    (angle, power), cadence = turn(steps), design.linkage.cadence
    return float(
        np.sqrt(np.mean((power - cadence * crank_moment(solve(design, angle), torque_map(MOMENTS), cadence)) ** 2))
    )


def measure(name: str) -> dict[str, dict[str, float]]:
    """Steps, error (W rms) and median time (s) of each program where it reaches ASKED, runs alternating."""
    design, loops = fes_mj.load_design(name), {"ours": feedback_loop, "ours, compiled": compiled_loop}
    turns = {"exudyn": exudyn_turn(design), **{who: our_turn(design, loop) for who, loop in loops.items()}}
    steps = {who: next(n for n in STEPS if error(design, turn, n) <= ASKED) for who, turn in turns.items()}
    times: dict[str, list[float]] = {who: [] for who in turns}
    for who in [*turns] * REPETITIONS:
        start = time.perf_counter()
        turns[who](steps[who])
        times[who].append(time.perf_counter() - start)
    seconds = {who: float(np.median(runs)) for who, runs in times.items()}
    return {
        who: {"steps": n, "rms_W": error(design, turns[who], n), "seconds": seconds[who]} for who, n in steps.items()
    }


def main() -> None:
    """Measure, print, write."""
    results = {name: measure(name) for name in DESIGNS}
    rows = [
        (name, who, str(row["steps"]), f"{row['rms_W']:.4f}", f"{row['seconds'] / programs['exudyn']['seconds']:.2f}")
        for name, programs in results.items()
        for who, row in programs.items()
    ]
    columns = ("design", "program", "steps", "W rms", "time per EXUDYN's")
    print_table(f"Fewest steps that reach {ASKED} W rms of the crank power", columns, rows)
    record("exudyn", results, packages=["exudyn"])


if __name__ == "__main__":
    main()

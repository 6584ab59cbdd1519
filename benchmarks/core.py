"""Speed in ratios within one run: kinematics beside a four-bar in plain numpy and pylinkage; simulate beside mj_step.

Needs the group "benchmark". Prints a table and writes results/benchmarks/core.json.
"""

import time
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from benchmarks import record
from fes_mj.common.console import print_table
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import positions
from fes_mj.linkage.legs import ONE_LEG
from fes_mj.moments.files import load_moments
from fes_mj.moments.torque_map import torque_map
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.stepping import feedback_loop, run_loop
from fes_mj.simulation.time_step import steps_per_turn

ANGLES = np.linspace(0, 2 * np.pi, 360, endpoint=False)
ROUNDS = 15  # of all candidates in turn; medians and ratios are over rounds


def batch(design: Design, count: int) -> Design:
    """The same linkage `count` times over, as a batch."""
    ones = np.ones((count, 1))
    names = ("ground", "crank", "foot", "pivot_to_crank", "pedal_arm", "coupler", "rocker", "coupler_angle")
    numbers = {name: getattr(design.linkage, name) * ones for name in names}
    return design.with_linkage(**numbers)


def four_bar(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A four-bar's output joint in plain numpy, as one would write it: two circles meet."""
    x, y = 0.16 * np.cos(angle), 0.16 * np.sin(angle)
    dx, dy = 0.38 - x, -0.09 - y
    square = dx * dx + dy * dy
    along = (square + 0.34**2 - 0.22**2) / (2 * square)
    across = np.sqrt(0.34**2 / square - along * along)
    return x + along * dx - across * dy, y + along * dy + across * dx


def pylinkage_six_bar(design: Design) -> Callable[[int], object]:
    """The same CDT in pylinkage, whose compiled solver steps it through `iterations` crank angles."""
    from pylinkage import Crank, FixedDyad, Ground, Linkage, RRRDyad

    linkage, start = design.linkage, {name: complex(np.ravel(p)[0]) for name, p in positions(design, ANGLES).items()}
    hip, pivot, centre = (
        Ground(point.real, point.imag) for point in (0j, linkage.ground, complex(linkage.crank_centre))
    )
    crank = Crank(centre, linkage.crank, angular_velocity=ANGLES[1])

    def dyad(name: str, first: Any, second: Any, length1: float, length2: float) -> RRRDyad:
        return RRRDyad(first, second, length1, length2, x=start[name].real, y=start[name].imag)

    joint = dyad("rocker_joint", pivot, crank.output, linkage.rocker, linkage.coupler)
    pedal = FixedDyad(joint, crank.output, linkage.pedal_arm, linkage.coupler_angle)
    knee = dyad("knee", hip, pedal, design.rider.thigh, float(design.knee_to_pedal))
    model = Linkage([hip, pivot, centre, crank, joint, pedal, knee])
    path = np.asarray(model.step_fast(iterations=len(ANGLES)))
    ours = positions(design, ANGLES + ANGLES[1])["knee"]
    assert np.abs(path[:, -1, 0] + 1j * path[:, -1, 1] - ours).max() < 1e-9, "not the same linkage"
    return lambda iterations: model.step_fast(iterations=iterations)


def repeated(call: Callable[[], object], times: int) -> Callable[[], None]:
    """The call so many times; results are dropped at once, as memory that is kept would be timed as well."""

    def run() -> None:
        for _ in range(times):
            call()

    return run


def rates(candidates: dict[str, tuple[int, Callable[[], object]]], rounds: int = ROUNDS) -> dict[str, np.ndarray]:
    """Items per second of each candidate (items, call) in each round, the candidates in turn; one warm-up round."""
    collected: dict[str, list[float]] = {name: [] for name in candidates}
    for _ in range(rounds + 1):
        for name, (items, call) in candidates.items():
            start = time.perf_counter()
            call()
            collected[name].append(items / (time.perf_counter() - start))
    return {name: np.array(values[1:]) for name, values in collected.items()}


def kinematics() -> dict[str, np.ndarray]:
    """Crank positions per second of a six-bar: ours in blocks that stay in the cache, pylinkage, a numpy four-bar."""
    design, block, repeats = load_design("d1"), 16, 100
    designs, long_turn = batch(design, block), np.tile(ANGLES, block)
    size, step_fast = block * len(ANGLES) * repeats, pylinkage_six_bar(design)
    return rates(
        {
            "six-bar, ours, 16 designs x 360 angles": (
                size,
                repeated(lambda: positions(designs, ANGLES), repeats),
            ),
            "six-bar, ours, 1 design x 5760 angles": (
                size,
                repeated(lambda: positions(design, long_turn), repeats),
            ),
            "six-bar, pylinkage step_fast": (size, lambda: step_fast(size)),
            "four-bar, plain numpy": (size, repeated(lambda: four_bar(long_turn), repeats)),
        }
    )


def simulation(name: str) -> dict[str, np.ndarray]:
    """Steps per second of simulate's loop, with feedback and all records, and of a bare mj_step loop on its model."""
    design, torque = load_design(name), torque_map(load_moments("p1p2"))
    model, steps = build_mjcf(design).compile(), 2 * steps_per_turn(design, design.linkage.cadence)
    loop = feedback_loop(torque, ONE_LEG)

    def bare() -> None:
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        step = mujoco.mj_step
        for _ in range(steps):
            step(model, data)

    return rates(
        {
            f"{name}: simulate": (steps, lambda: run_loop(model, loop, steps)),
            f"{name}: bare mj_step": (steps, bare),
        }
    )


def main() -> None:
    """Run everything, print a table, write results/benchmarks/core.json."""
    report, rows = {}, []
    for unit, measured in (
        ("positions/s", kinematics()),
        *(("steps/s", simulation(name)) for name in ("trt", "r2", "d1")),
    ):
        base = measured[next(reversed(measured))]  # the last candidate is the yardstick
        for name, values in measured.items():
            ratio = float(np.median(values / base))
            report[name] = {"median_per_s": float(np.median(values)), "ratio_to_last_of_group": ratio}
            rows.append((name, f"{np.median(values):.3g} {unit}", f"{ratio:.2f}"))
    print_table("Speed on one core, medians of one run", ("candidate", "rate", "ratio"), rows)
    record("core", {"rates": report})


if __name__ == "__main__":
    main()

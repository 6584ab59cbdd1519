"""Speed of a ride in ratios within one run: MuJoCo's loop beside a bare mj_step loop, the reduced model beside MuJoCo.

Prints a table and writes results/benchmarks/ride.json.
"""

from itertools import product

import mujoco
import numpy as np

from benchmarks import core, record
from fes_mj.common.console import print_table
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.muscles.drive import load_muscles
from fes_mj.riding.ride import Ride
from fes_mj.riding.stimulated import stimulated_rider
from fes_mj.riding.trace import ride as ride_by_equation
from fes_mj.simulation.mjcf import UNDRAWN
from fes_mj.simulation.road import ride_on_road
from fes_mj.simulation.road_mjcf import build_road_mjcf

DURATION = 60.0  # s of riding
DESIGNS = ("trt", "d1")
DRIVES = ("moments", "muscles")
ROUNDS = 3  # of half a minute


def rates(name: str, drive: str) -> dict[str, np.ndarray]:
    """Seconds of riding per second by the reduced model, MuJoCo with all records, a bare mj_step loop on its model."""
    design = load_design(name)
    moving = load_moments("p1p2") if drive == "moments" else stimulated_rider(load_muscles("p1p2"), design)
    ride, name = Ride(design, moving, duration=DURATION), f"{name} by {drive}"
    step = RideCase(ride).simulation.timestep
    model, steps = build_road_mjcf(ride, step, options=UNDRAWN).compile(), round(DURATION / step)

    def bare() -> None:
        data, step = mujoco.MjData(model), mujoco.mj_step
        mujoco.mj_resetDataKeyframe(model, data, 0)
        for _ in range(steps):
            step(model, data)

    measured = core.rates(
        {
            f"{name}: reduced": (1, lambda: ride_by_equation(ride)),
            f"{name}: MuJoCo, everything recorded": (1, lambda: ride_on_road(ride, step)),
            f"{name}: bare mj_step": (1, bare),
        },
        ROUNDS,
    )
    return {candidate: DURATION * values for candidate, values in measured.items()}


def main() -> None:
    """Run everything, print a table, write results/benchmarks/ride.json."""
    report, rows = {}, []
    for name, drive in product(DESIGNS, DRIVES):
        measured = rates(name, drive)
        fast, recorded, bare = measured.values()
        ratios = {"reduced_per_mujoco": fast / recorded, "mujoco_time_per_bare": bare / recorded}
        report[f"{name} by {drive}"] = {candidate: float(np.median(values)) for candidate, values in measured.items()}
        report[f"{name} by {drive}"] |= {ratio: float(np.median(values)) for ratio, values in ratios.items()}
        rows += [(key, f"{value:.3g}") for key, value in report[f"{name} by {drive}"].items()]
    print_table("Seconds of riding per second, and ratios; medians of one run", ("", ""), rows)
    record("ride", {"rates": report})


if __name__ == "__main__":
    main()

"""Speed of muscles in ratios within one run, beside that of joint moments.

Best-timed power of a batch beside cycles at as many angles; `fes_mj simulate --drive muscles` beside `fes_mj simulate`,
whole processes and the checks alone. Prints a table and writes results/benchmarks/muscles.json.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks import core, record, start
from fes_mj.common.console import print_table
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.muscles.drive import load_muscles
from fes_mj.muscles.power import best_power
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.timing import TURN_POINTS
from fes_mj.simulation.bench import simulate as simulated
from fes_mj.statics.cycles import cycles
from fes_mj.statics.drive import Drive
from fes_mj.statics.work_table import WorkTable
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import verify

COUNT = 256  # designs in a batch
ROUNDS = 7  # of simulations


def simulate() -> dict[str, float]:
    """Time under muscles per time under moments: of the command, of its checks in one process, of a longer run."""
    design = load_design("d1")
    # riders are read anew each time, as their best windows are kept
    drives: dict[str, Callable[[], Drive]] = {
        "moments": partial(load_moments, "p1p2"),
        "muscles": partial(load_muscles, "p1p2"),
    }

    def ratio(call: Callable[[str], object]) -> float:
        measured = core.rates({name: (1, partial(call, name)) for name in drives}, ROUNDS)
        return float(np.median(measured["moments"] / measured["muscles"]))

    command = [start.COMMAND, "simulate", "d1", "--drive"]
    return {
        "fes_mj simulate d1": ratio(lambda name: start.seconds([*command, name])),
        "its checks": ratio(lambda name: list(verify(VerificationCase(design, drives[name]())))),
        "a run of ten turns": ratio(lambda name: simulated(design, drives[name](), turns=10)),
    }


def main() -> None:
    """Run everything, print a table, write results/benchmarks/muscles.json."""
    rider, table = load_riders("p1p2").most_probable, WorkTable.of(load_moments("p1p2"))
    design = load_design("d1")
    same = core.batch(design, COUNT)
    batches = {"one cadence": same, "a cadence each": same.with_linkage(gear_ratio=np.linspace(2, 2.2, COUNT)[:, None])}
    report = {}
    for name, batch in batches.items():
        measured = core.rates(
            {
                "muscles": (COUNT, partial(best_power, rider, batch)),
                "cycles": (COUNT, partial(cycles, batch, table, TURN_POINTS)),
            }
        )
        times = float(np.median(measured["cycles"] / measured["muscles"]))
        report[name] = {"designs_per_s": float(np.median(measured["muscles"])), "times_of_cycles": times}
    beside = simulate()
    rows = [(name, f"{row['designs_per_s']:.0f}", f"{row['times_of_cycles']:.1f}") for name, row in report.items()]
    print_table("Best-timed power of a batch", ("batch", "designs/s", "times the time of cycles"), rows)
    print_table("Simulated muscles", ("what", "times of moments"), [(k, f"{v:.2f}") for k, v in beside.items()])
    record("muscles", {"rates": report, "simulate_per_that_of_moments": beside})


if __name__ == "__main__":
    main()

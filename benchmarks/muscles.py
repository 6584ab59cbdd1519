"""Speed of muscles in ratios within one run: best-timed power of a batch beside moment-driven cycles at as many angles.

Prints a table and writes results/benchmarks/muscles.json.
"""

from functools import partial

import numpy as np

from benchmarks import core, record
from fes_mj.common.console import print_table
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.muscles.power import best_power
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.timing import POINTS
from fes_mj.statics.cycles import cycles
from fes_mj.statics.work_table import WorkTable

COUNT = 256  # designs in a batch


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
                "cycles": (COUNT, partial(cycles, batch, table, POINTS)),
            }
        )
        times = float(np.median(measured["cycles"] / measured["muscles"]))
        report[name] = {"designs_per_s": float(np.median(measured["muscles"])), "times_of_cycles": times}
    rows = [(name, f"{row['designs_per_s']:.0f}", f"{row['times_of_cycles']:.1f}") for name, row in report.items()]
    print_table("Best-timed power of a batch", ("batch", "designs/s", "times the time of cycles"), rows)
    record("muscles", {"rates": report})


if __name__ == "__main__":
    main()

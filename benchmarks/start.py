"""How long commands take to answer, in starts of a bare interpreter; ratios of one run, commands in turn.

Prints a table and writes results/benchmarks/start.json.
"""

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import record
from fes_mj.common.console import print_table

ROUNDS = 15
PYTHON, COMMAND = sys.executable, str(Path(sys.executable).with_name("fes_mj"))
MEASURE = """
import time; import numpy, mujoco; from fes_mj import Case, load_design, load_moments
d1, p1p2 = load_design("d1"), load_moments("p1p2"); start = time.perf_counter(); Case(d1, p1p2).checks
print(time.perf_counter() - start)
"""
CANDIDATES = {
    "bare interpreter": [PYTHON, "-c", "pass"],
    "fes_mj --version": [COMMAND, "--version"],
    "fes_mj --help": [COMMAND, "--help"],
    "fes_mj static d1": [COMMAND, "static", "d1"],
    "import numpy": [PYTHON, "-c", "import numpy"],
    "import mujoco": [PYTHON, "-c", "import mujoco"],
    "fes_mj simulate d1": [COMMAND, "simulate", "d1"],
}


# compiling the modules is the first start's work, never the later ones'
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def seconds(command: list[str]) -> float:
    """Wall time of a whole process."""
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True, env=ENVIRONMENT)
    return time.perf_counter() - start


def main() -> None:
    """Measure in turn, print, write."""
    rounds = [{name: seconds(command) for name, command in CANDIDATES.items()} for _ in range(ROUNDS + 1)][1:]
    check = [float(subprocess.run([PYTHON, "-c", MEASURE], check=True, capture_output=True).stdout) for _ in range(3)]
    bare = np.array([times["bare interpreter"] for times in rounds])
    ratio = {name: float(np.median([times[name] for times in rounds] / bare)) for name in CANDIDATES}
    simulation = float(np.median(check) / np.median(bare))
    # importing mujoco imports numpy
    parts = ratio["import mujoco"] + simulation
    report: dict[str, Any] = {
        "starts_of_a_bare_interpreter": ratio | {"the cross-check alone": simulation},
        "simulate_per_its_parts": ratio["fes_mj simulate d1"] / parts,
    }
    rows = [(name, f"{value:.1f}") for name, value in report["starts_of_a_bare_interpreter"].items()]
    rows.append(("simulate, per numpy + mujoco + cross-check", f"{report['simulate_per_its_parts']:.2f}"))
    print_table("Starts of a bare interpreter", ("command", "ratio"), rows)
    record("start", report)


if __name__ == "__main__":
    main()

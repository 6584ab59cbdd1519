"""The environment of examples/ride_env.py under a table of stimulation and under chance: results/ride_env.*, a picture.

python -m studies.ride_env
"""

from __future__ import annotations

import runpy
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.style import BY_DESIGN, FAINT, SERIES, STYLE
from fes_mj.common.units import KMH
from fes_mj.common.writing import json_text, replacing, write_text
from fes_mj.linkage.design_file import DESIGNS

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
EXAMPLE = runpy.run_path(str(ROOT / "examples" / "ride_env.py"))
DRAWN = ("trt", "r2", "d1")  # in the left picture
EPISODES = 5  # of each; they differ by launch speed and by chance
TRANSMISSIONS = {"freewheel": ("ride",), "fixed": ("ride", "fixed-gear")}
POLICIES = ("table", "random")


def main() -> None:
    cases = [(name, transmission, policy) for name in DESIGNS for transmission in TRANSMISSIONS for policy in POLICIES]
    rows, speeds = [], {}
    for name, transmission, policy in track(cases, "episodes"):
        env = EXAMPLE["RideEnv"](name, variants=TRANSMISSIONS[transmission])
        env.action_space.seed(0)
        runs = [EXAMPLE["roll_out"](env, EXAMPLE[f"{policy}_policy"](env), seed) for seed in range(EPISODES)]
        ends = {key: np.mean([run[key][-1] for run in runs]) for key in ("distance", "effort", "time", "speed")}
        returns = [float(run["reward"].sum()) for run in runs]
        described = (
            ends["distance"],
            ends["time"],
            ends["speed"] / KMH,
            ends["effort"],
            ends["distance"] / ends["effort"],
        )
        rows.append((name.upper(), transmission, policy, *described, float(np.mean(returns)), float(np.std(returns))))
        speeds[name, transmission, policy] = runs[0]
    table = Table("", COLUMNS, rows)
    write_text(RESULTS / "ride_env.json", json_text({"provenance": provenance(), "rows": table.records()}))
    write_text(RESULTS / "ride_env.md", HEADING + table.markdown())
    _draw(rows, speeds)


def _draw(rows: Sequence[tuple[Any, ...]], runs: dict[tuple[str, str, str], dict[str, np.ndarray]]) -> None:
    """Speed over time of some designs, and the return of all, with the freewheel."""
    with mpl.rc_context(STYLE), replacing(RESULTS / "ride-environment.png") as beside:
        figure = Figure(figsize=(9.6, 3.8), layout="constrained")
        over_time, returns = figure.subplots(1, 2, width_ratios=[1.5, 1])
        for name in DRAWN:
            for policy, style in zip(POLICIES, ("-", ":"), strict=True):
                run = runs[name, "freewheel", policy]
                label = f"{name.upper()}, {policy}"
                over_time.plot(run["time"], run["speed"] / KMH, style, color=BY_DESIGN[name], label=label)
        over_time.set(xlabel="time, s", ylabel="speed of the tricycle, km/h", ylim=(0, None))
        over_time.set_title("stimulated by table (solid) and by chance (dotted), freewheel", loc="left")
        over_time.legend(ncols=3)
        place = np.arange(len(DESIGNS))
        for number, (policy, colour) in enumerate(zip(POLICIES, (SERIES[0], FAINT), strict=True)):
            heights = [row[-2] for row in rows if row[1:3] == ("freewheel", policy)]
            returns.bar(place + 0.4 * number - 0.2, heights, 0.38, color=colour, label=policy)
        returns.set_xticks(place, [name.upper() for name in DESIGNS])
        returns.set_title("return of an episode, m", loc="left")
        returns.legend()
        figure.savefig(beside, dpi=150)


COLUMNS = {
    "design": "",
    "transmission": "",
    "policy": "",
    "distance, m": ".1f",
    "time, s": ".1f",
    "speed at the end, km/h": ".1f",
    "effort, s": ".2f",
    "distance per effort, m/s": ".1f",
    "return, m": ".1f",
    "sd": ".1f",
}
HEADING = f"""# Baselines of the ride environment

Written by `python -m studies.ride_env`: examples/ride_env.py with its defaults (flat road, muscles of the most probable
rider of group p1p2), means of {EPISODES} episodes. *table*: each muscle group in its best window
(`fes_mj stimulation`), led for the actual speed; *random*: each group on or off by chance at 50 Hz.
Switched on and off without the ramps of `fes_mj ride`: with a freewheel R2 is then faster than the TRT, with them it
is not.
An episode ends when the tricycle stops. *sd*: of the return, over episodes.

"""


if __name__ == "__main__":
    main()

"""Table 1 of the paper beside ours, and what it lacks: work per turn, cadence, joint speeds, the split of each gain."""

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.paper.captions import captioned
from fes_mj.paper.printed import SIX_BARS, table1
from fes_mj.paper.runs import Runs, joint_speed
from fes_mj.statics.turn import ratio_sd

POWER_ROUNDING = 0.005  # W, Table 1 is rounded to 0.01 W


def power_table(runs: Runs) -> Table:
    """Mean crank power of one leg: paper, printed and identified dimensions, dynamic, and what the difference means."""
    rows = []
    for (name, group), static in runs.static.items():
        said, deviation = table1()[name].power[group], static.power_sd
        assert deviation is not None
        printed, dynamic = runs.printed[name, group], runs.dynamic[name, group, 1].simulation
        difference = dynamic.power_mean - said
        rows.append(
            (
                name.upper(),
                group,
                said,
                "cannot turn" if printed is None else f"{printed.power_mean:.2f}",
                static.power_mean,
                deviation,
                dynamic.power_mean,
                difference,
                explained_by(difference, deviation),
            )
        )
    return captioned("power", rows)


def explained_by(difference: float, deviation: float) -> str:
    """In which of rounding, one and two standard deviations a difference in W lies."""
    limits = {"rounding": POWER_ROUNDING, "1 sd": deviation, "2 sd": 2 * deviation}
    return next((name for name, limit in limits.items() if abs(difference) <= limit), "none: beyond 2 sd")


def gain_table(runs: Runs) -> Table:
    """Power of every six-bar per the TRT's: paper, ours, and the split into cadence and work per turn."""
    rows = []
    for name in SIX_BARS:
        for group in GROUPS:
            result, trt = runs.static[name, group], runs.static["trt", group]
            said = table1()[name].power[group] / table1()["trt"].power[group]
            gain = result.power_mean / trt.power_mean
            cadence, work = result.cadence / trt.cadence, result.work_per_turn / trt.work_per_turn
            rows.append((name.upper(), group, said, gain, ratio_sd(result, trt), cadence, work))
    return captioned("gain", rows)


def motion_table(runs: Runs) -> Table:
    """Cadence, work per turn, and joint speeds of every design."""
    rows = []
    for name in table1():
        results = [runs.static[name, group] for group in GROUPS]
        knee, hip = (np.degrees(joint_speed(results[0], joint)) for joint in ("knee", "hip"))
        rpm = results[0].cadence / RPM
        rows.append((name.upper(), rpm, *(result.work_per_turn for result in results), *knee, *hip))
    return captioned("motion", rows, group=GROUPS)


def check_table(runs: Runs) -> Table:
    """The limits of the cross-check and how near each simulation came to them."""
    rows = []
    for (name, group, legs), case in runs.dynamic.items():
        run = case.simulation
        worst = max(case.checks, key=lambda check: check.factor)
        share = f"{worst.name.replace('_', ' ')}: {100 * worst.factor:.0f} %"
        measured = (100 * case.relative_difference, 1e6 * run.loop_gap_max, 1e12 * run.cadence_ripple)
        cells = (str(legs), 1e3 * run.timestep, *measured, share, "yes" if case.agrees else "NO")
        rows.append((name.upper(), group, *cells))
    return captioned("check", rows)

"""Table 1 of the paper beside ours, and what it lacks: work, cadence, joint speeds, the split of each gain, people."""

from itertools import product

import numpy as np

from fes_mj.budget.answer import Answer
from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.fit.population import GRADES, PEOPLE, SEATS, PopulationFit
from fes_mj.linkage.design import Rider
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.linkage.riders import populations
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.paper.captions import Rows, captioned, table
from fes_mj.paper.printed import table1
from fes_mj.paper.runs import Runs, joint_speed
from fes_mj.statics.turn import ratio_sd

POWER_ROUNDING = 0.005  # W, Table 1 is rounded to 0.01 W


@table("answer")
def answer_table(runs: Runs) -> Rows:
    """Both numbers of every design, each with its interval, and how probably a rider has more than elsewhere."""
    for (name, group), answer in runs.answers.items():
        trt, r1 = (runs.answers[other, group] for other in ("trt", "r1"))
        estimates = ((answer.paper_power, 2), (answer.per(trt)[0], 2), (answer.rider_power, 1), (answer.rider_ratio, 2))
        more = (None if other is answer else _share_above(answer, other) for other in (trt, r1))
        yield name.upper(), group, *(estimate and estimate.text(digits) for estimate, digits in estimates), *more


def _share_above(one: Answer, other: Answer) -> float:
    """Of the riders, those who have more power on one design than on the other, %; who cannot turn has none."""
    assert one.rider is not None
    assert other.rider is not None
    return float(100 * np.mean(np.nan_to_num(one.rider) > np.nan_to_num(other.rider)))


@table("power")
def power_table(runs: Runs) -> Rows:
    """Mean crank power of one leg: paper, printed and identified dimensions, dynamic, and what the difference means."""
    for (name, group), static in runs.static.items():
        paper, deviation = table1()[name].power[group], static.power_sd
        assert deviation is not None
        printed, dynamic = runs.printed.get((name, group)), runs.dynamic[name, group, 1].simulation
        difference, of_print = dynamic.power_mean - paper, f"{printed.power_mean:.2f}" if printed else "cannot turn"
        powers = (paper, of_print, static.power_mean, deviation, dynamic.power_mean, difference)
        yield name.upper(), group, *powers, explained_by(difference, deviation)


def explained_by(difference: float, deviation: float) -> str:
    """In which of rounding, one and two standard deviations a difference in W lies."""
    limits = {"rounding": POWER_ROUNDING, "1 sd": deviation, "2 sd": 2 * deviation}
    return next((name for name, limit in limits.items() if abs(difference) <= limit), "none: beyond 2 sd")


@table("gain")
def gain_table(runs: Runs) -> Rows:
    """Power of every six-bar per the TRT's: paper, ours, and the split into cadence and work per turn."""
    for name, group in product(SIX_BARS, RIDER_GROUPS):
        result, trt = runs.static[name, group], runs.static["trt", group]
        paper = table1()[name].power[group] / table1()["trt"].power[group]
        gain = result.power_mean / trt.power_mean
        cadence, work = result.cadence / trt.cadence, result.work_per_turn / trt.work_per_turn
        yield name.upper(), group, paper, gain, ratio_sd(result, trt), cadence, work


@table("motion", group=RIDER_GROUPS)
def motion_table(runs: Runs) -> Rows:
    """Cadence, work per turn, and joint speeds of every design."""
    for name in table1():
        results = [runs.static[name, group] for group in RIDER_GROUPS]
        knee, hip = (np.degrees(joint_speed(results[0], joint)) for joint in ("knee", "hip"))
        yield name.upper(), results[0].cadence / RPM, *(result.work_per_turn for result in results), *knee, *hip


@table("check")
def check_table(runs: Runs) -> Rows:
    """The limits of the cross-check and how near each simulation came to them."""
    for (name, group, legs), case in runs.dynamic.items():
        run = case.simulation
        worst = max(case.checks, key=lambda check: check.factor)
        share = f"{worst.name.replace('_', ' ')}: {100 * worst.factor:.0f} %"
        measured = (100 * case.relative_difference, 1e6 * run.loop_gap_max, 1e12 * run.cadence_ripple)
        yield name.upper(), group, str(legs), 1e3 * run.timestep, *measured, share, "yes" if case.agrees else "NO"


@table("people")
def percentile_table() -> Rows:
    """Thigh and shank of people beside the paper's."""
    for who, people in populations().items():
        riders = (people.rider(percentile) for percentile in (5, 50, 95))
        legs = (100 * length for rider in riders for length in (rider.thigh, rider.shank))
        yield who, *legs, people.correlation
    yield "the paper's", None, None, 100 * Rider.thigh, 100 * Rider.shank, None, None, None


def population_table(fits: dict[str, PopulationFit]) -> Table:
    """Share of people who can ride, and their power, with the seat as drawn and moved; by design."""
    results, rows = {name: fit.summary() for name, fit in fits.items()}, []
    seats = zip(SEATS, ("as drawn", "moved"), strict=True)
    for (name, result), who, (seat, moved) in product(results.items(), PEOPLE, seats):
        powers = (result[f"power_{which}_{seat}_W"][who] for which in ("mean", "p10"))
        shares = (100 * result[f"{grade}_{seat}"][who] for grade in GRADES)
        rows.append((name.upper(), who, moved, *shares, *powers))
    error = max(fit.map_error for fit in fits.values())
    sizes = {str(result["samples"]) for result in results.values()}
    return captioned("population", rows, samples=", ".join(sizes), error=f"{error:.2f}")

"""What the verdict hangs on: what was learned of riders, what their gains follow from, what would turn them round."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import SIX_BARS, load_design
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.anatomy import Anatomy
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.timing import TURN_ANGLES, activation, best_windows
from fes_mj.muscles.trial import quantities
from studies.muscles.gains import probability, quantiles

# Quantities that a rider can be given another value of without ceasing to fit the measured power badly.
CHANGED = (
    "rise_s", "fall_per_rise", "delay_s", "max_speed", "rectus_recruitment", "hip_offset_deg",
    "quadriceps_fibre_shift", "hamstrings_fibre_shift", "gluteus_fibre_shift",
)  # fmt: skip
LEARNED = ("residual_sd_Nm", "passive_included", "quadriceps_strength", "hamstrings_strength", "gluteus_strength")


def power(riders: Riders, name: str, rpm: float | None = None, muscles: Anatomy | None = None) -> FloatArray:
    """Mean power of one leg of every rider, stimulated as is best in expectation, W; by default at the paper's gear."""
    design = load_design(name)
    cadence = design.linkage.cadence if rpm is None else rpm * RPM
    if muscles is None:
        return best_turn(riders, design, cadence)[0].power_mean[:, 0]
    pulled = pull(riders, kinematics.solve(design, TURN_ANGLES), cadence, muscles)
    windows, _ = best_windows(pulled.power, riders, cadence)
    return np.asarray(np.mean(activation(windows, riders, cadence) * pulled.power, axis=-1).sum(axis=0)[:, 0])


def gain(riders: Riders, name: str, muscles: Anatomy | None = None) -> FloatArray:
    return power(riders, name, muscles=muscles) / power(riders, "trt", muscles=muscles)


def changed(riders: Riders, **values: float) -> Riders:
    """The same riders with quantities at one value."""
    constant = {name: np.full(len(riders), value) for name, value in values.items()}
    return replace(riders, values=dict(riders.values) | constant)


def posterior_rows() -> Iterator[tuple[Any, ...]]:
    """Prior beside posterior of every quantity, and its share of the variance of D1's gain."""
    groups = [(riders, quantities(riders), gain(riders, "d1")) for riders in map(load_riders, RIDER_GROUPS)]
    for number, first in enumerate(groups[0][1]):
        cells: list[Any] = [first.name, first.unit, *first.prior]
        for riders, rows, gains in groups:
            row = rows[number]
            narrowed = f"{row.narrowed_to:.2f}" if row.identified else "not identified"
            variance = 100 * float(np.corrcoef(riders.values[row.name], gains)[0, 1] ** 2)
            cells += [*row.posterior, narrowed, variance]
        yield tuple(cells)


def sensitivity_rows() -> Iterator[tuple[Any, ...]]:
    """Median gains with a quantity at either end of its prior, or in the thirds of riders with least and most of it."""
    ends = {
        name: np.quantile(values, (0.05, 0.95)) for name, values in prior_draws(4001, np.random.default_rng(2)).items()
    }
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        for name in CHANGED:
            both = [changed(riders, **{name: float(end)}) for end in ends[name]]
            gains = [float(np.median(gain(other, design))) for design in ("r1", "d1") for other in both]
            yield group, name, "set to its prior's 5 and 95 %", *map(float, ends[name]), *gains
        for name in LEARNED:
            order = np.argsort(riders.values[name], kind="stable")
            thirds = [riders.taken(part) for part in (order[: len(order) // 3], order[-(len(order) // 3) :])]
            middle = [float(np.median(part.values[name])) for part in thirds]
            gains = [float(np.median(gain(part, design))) for design in ("r1", "d1") for part in thirds]
            yield group, name, "riders with least and most of it", *middle, *gains


def anatomy_rows(title: str, muscles: Anatomy | None) -> Iterator[tuple[Any, ...]]:
    """Gains of the same riders with the lengths and parameters of an anatomy."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        for name in SIX_BARS:
            gains = gain(riders, name, muscles)
            yield title, group, name.upper(), *quantiles(gains), probability(gains > 1)


def reversal_rows() -> Iterator[tuple[Any, ...]]:
    """D1's gain among riders of whom more is known, and with what else were true."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        trt, d1 = (power(riders, name) for name in ("trt", "d1"))
        quantities = {name: riders.values[name] for name in ("rise_s", "max_speed")}
        fast = power(riders, "trt", 96) / power(riders, "trt", 60)
        cases: dict[str, Any] = {
            "all riders": np.ones(len(riders), bool),
            "who rise within 0.05 s": quantities["rise_s"] < 0.05,
            "who rise within 0.05 s and shorten by more than 9 a second": (quantities["rise_s"] < 0.05)
            & (quantities["max_speed"] > 9),
            "whose P96/P60 is above 0.8": fast > 0.8,
            "whose P96/P60 is above 0.9": fast > 0.9,
        }
        for case, row in cases.items():
            yield group, case, int(row.sum()), *quantiles(d1[row] / trt[row]), probability(d1[row] > trt[row])
        # no force-velocity to speak of; and activation that is as good as at once
        for case, values in {
            "rise of 0.03 s and an equal fall": {"rise_s": 0.03, "fall_per_rise": 1.0},
            "largest speed of 100 a second": {"max_speed": 100.0},
            "both": {"rise_s": 0.03, "fall_per_rise": 1.0, "max_speed": 100.0},
            "both, and a rise of 0.01 s": {"rise_s": 0.01, "fall_per_rise": 1.0, "max_speed": 100.0},
        }.items():
            gains = gain(changed(riders, **values), "d1")
            yield group, f"all, with {case}", len(riders), *quantiles(gains), probability(gains > 1)
        slow = [power(riders, name, 60) for name in ("trt", "d1")]
        gains = slow[1] / slow[0]
        yield group, "all, geared to 60 rpm", len(riders), *quantiles(gains), probability(gains > 1)


def experiment_rows() -> Iterator[tuple[Any, ...]]:
    """How well the power of a standard tricycle at two cadences predicts D1's gain."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        fast, slow = (power(riders, "trt", rpm) for rpm in (96, 60))
        gains = power(riders, "d1") / slow
        slope, level = np.polyfit(fast / slow, gains, 1)
        yield group, *quantiles(fast / slow), float(np.corrcoef(fast / slow, gains)[0, 1]), float(level), float(slope)

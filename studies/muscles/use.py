"""How riders do best: by cadence, and over half an hour with fatigue."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.fatigue import AT, HALF_AN_HOUR, LEFT, force_factor, power_over_time, recoveries
from fes_mj.muscles.power import MuscleTurn, best_turn
from fes_mj.muscles.riders import Riders, load_riders
from studies.muscles.gains import WIDTHS, probability, quantiles
from studies.muscles.unknowns import power

CADENCES = (20, 30, 40, 50, 60, 70, 80, 90, 100)  # rpm
MINUTES = np.arange(0.0, 30.5, 0.5)


def by_cadence(riders: Riders) -> FloatArray:
    """Mean power of one leg, W, shape (designs, cadences, riders), in the order of DESIGNS."""
    return np.array([[power(riders, name, rpm) for rpm in CADENCES] for name in DESIGNS])


def cadence_rows() -> Iterator[tuple[Any, ...]]:
    """Expected power of both legs by cadence, and how probably D1 beats the TRT."""
    for group in RIDER_GROUPS:
        powers = by_cadence(load_riders(group))
        names = list(DESIGNS)
        trt, d1 = powers[names.index("trt")], powers[names.index("d1")]
        top = trt[trt.mean(axis=1).argmax()]  # each rider's, at the cadence that is best in expectation
        for place, rpm in enumerate(CADENCES):
            beats = probability(d1[place] > trt[place]), probability(d1[place] > top)
            yield group, rpm, *(2 * float(design[place].mean()) for design in powers), *beats


def best_cadence_rows() -> Iterator[tuple[Any, ...]]:
    """Every design at the cadence that is best in expectation, per the TRT at its own."""
    for group in RIDER_GROUPS:
        powers = by_cadence(load_riders(group))
        best = {name: values[values.mean(axis=1).argmax()] for name, values in zip(DESIGNS, powers, strict=True)}
        for name, values in zip(DESIGNS, powers, strict=True):
            gains = best[name] / best["trt"]
            cadence = CADENCES[int(values.mean(axis=1).argmax())]
            yield group, name.upper(), cadence, 2 * float(best[name].mean()), *quantiles(gains), probability(gains > 1)


def tired(turn: MuscleTurn, recovery: float) -> FloatArray:
    """Expected power of both legs at MINUTES, W."""
    return np.asarray(2 * power_over_time(turn, 60 * MINUTES, recovery)[..., 0].mean(axis=1))


def fatigue_rows() -> Iterator[tuple[Any, ...]]:
    """Power over half an hour at the paper's gears; best stimulation, of a few widths on the TRT."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        for name, width in [*(("trt", width) for width in WIDTHS), *((name, 100) for name in ("r1", "r2", "d1", "d2"))]:
            turn, windows = best_turn(riders, load_design(name), duty=width / 360)
            active = turn.activation.mean(axis=-1)[..., 0]
            for title, recovery in recoveries().items():
                course = tired(turn, recovery)
                factors = force_factor(active, HALF_AN_HOUR, recovery).mean(axis=1)
                at = [float(course[int(np.searchsorted(MINUTES, minute))]) for minute in (0, 2, 30)]
                share = float(windows.width.max() / 360)
                yield group, name.upper(), width, title, share, *at, float(course.mean()), *map(float, factors)


def fatigue_check() -> Iterator[tuple[Any, ...]]:
    """What the two recoveries leave at a duty of a half, beside what was measured."""
    for title, recovery in recoveries().items():
        yield title, recovery, 100 * (float(force_factor(AT, 1e6, recovery)) - 1), 100 * (LEFT - 1)

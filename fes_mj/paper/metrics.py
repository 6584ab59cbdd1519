"""The criteria of the paper's Section 7, which it discusses in words, as numbers for all five designs."""

import itertools
from collections.abc import Callable

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.linkage.assembly import transmission_angles
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.uncertainty import instant_power_weights, with_sd
from fes_mj.paper.captions import Rows, captioned, table
from fes_mj.paper.evidence import of_joint
from fes_mj.paper.runs import Runs
from fes_mj.statics.characteristics import extent, inactive_share
from fes_mj.statics.turn import QuasiStatic

WIDTHS = (2.0, 5.0, 10.0)  # deg over which a jump of the torque map is smoothed
_DRAWS = 20_000  # of the criteria's weights
_SEED = 2022


@table("size")
def size_table(runs: Runs) -> Rows:
    """Section 7.1: where the crank lies, how large the mechanism is, how well it transmits."""
    for name, result in _by_design(runs).items():
        sizes = (100 * length for length in (abs(result.design.linkage.crank_centre), *extent(result.motion)))
        angles = transmission_angles(result.motion)
        yield name.upper(), *sizes, angles["knee"], angles.get("rocker_joint")


@table("continuity", width=[f"{width:g}" for width in WIDTHS])
def continuity_table(runs: Runs) -> Rows:
    """Section 7.2: the jump of the torque map at each end of travel, and what smoothing it costs in mean power."""
    for (name, group), result in runs.static.items():
        weights = [*jump_weights(result), *(smoothing_weights(result, np.radians(width)) for width in WIDTHS)]
        posterior = runs.known.text.posteriors[group]
        yield name.upper(), group, *(with_sd(*posterior.predict(functional), digits=1) for functional in weights)


@table("distribution")
def distribution_table(runs: Runs) -> Rows:
    """Section 7.3: how power is spread over the turn, by the joint moments alone: of the mean curves, and sampled."""
    for (name, group), result in runs.static.items():
        weights = instant_power_weights(result.motion, result.cadence, result.torque.reference)
        sampled = distribution(runs.known.text.curves[group] @ weights.T)
        cells = [
            (float(of_mean), with_sd(float(values.mean()), float(values.std()), digits))
            for of_mean, values, digits in zip(distribution(result.power), sampled, (1, 1, 1, 2), strict=True)
        ]
        yield name.upper(), group, *itertools.chain(*cells)


def distribution(power: FloatArray) -> tuple[FloatArray, ...]:
    """Inactive zone in % of the turn, lowest and highest power, peak per mean; power: over the turn, last axis."""
    lowest, highest = power.min(axis=-1), power.max(axis=-1)
    return 100 * inactive_share(power), lowest, highest, highest / power.mean(axis=-1)


def ranking_table(runs: Runs) -> Table:
    """A ranking with stated weights, and how much it depends on them."""
    results = {name: [runs.static[name, group] for group in RIDER_GROUPS] for name in _by_design(runs)}

    def smoothing_loss(pair: list[QuasiStatic]) -> float:
        costs = (
            runs.known.text.posteriors[r.moments.name].predict(smoothing_weights(r, np.radians(5.0)))[0] / r.power_mean
            for r in pair
        )
        return -float(np.mean([*costs]))

    criteria: dict[str, Callable[[list[QuasiStatic]], float]] = {  # large is good
        "power: mean of both groups": lambda pair: float(np.mean([r.power_mean for r in pair])),
        "size: length x height": lambda pair: -float(np.prod(extent(pair[0].motion))),
        "transmission: smallest angle": lambda pair: float(min(transmission_angles(pair[0].motion).values())),
        "continuity: loss by 5 deg of smoothing": smoothing_loss,
        "inactive zone": lambda pair: -float(np.mean([inactive_share(r.power) for r in pair])),
        "peak per mean": lambda pair: -float(np.mean([r.power.max() / r.power_mean for r in pair])),
    }
    values = np.array([[value(pair) for value in criteria.values()] for pair in results.values()])
    scores = (values - values.min(axis=0)) / np.ptp(values, axis=0)
    draws = np.random.default_rng(_SEED).dirichlet(np.ones(len(criteria)), _DRAWS)
    wins = np.bincount(np.argmax(draws @ scores.T, axis=1), minlength=len(results)) / _DRAWS
    total = scores.mean(axis=1)
    rows = [
        (name.upper(), *scores[i], total[i], str(1 + int(np.sum(total > total[i]))), 100 * wins[i])
        for i, name in enumerate(results)
    ]
    return captioned("ranking", rows, criterion=[*criteria], count=str(len(criteria)))


def jump_weights(result: QuasiStatic) -> list[FloatArray]:
    """Jumps of the torque map, extension less flexion, as functionals of the curves: knee bent, extended, then hip."""
    weights, source = [], result.torque.source_angle
    for joint, angle in result.joint_angle.items():
        for end in (angle.min(), angle.max()):
            jump = fourier(source(joint, end, 1.0)) - fourier(source(joint, end, -1.0))
            weights.append(of_joint(joint, jump))
    return weights


def smoothing_weights(result: QuasiStatic, width: float) -> FloatArray:
    """Mean power lost by smoothing the jumps over `width` (rad) at each end, as a functional of the curves."""
    parts = []
    for joint, angle in result.joint_angle.items():
        rate = result.motion.joint_rate[joint]
        from_end = np.minimum(angle - angle.min(), angle.max() - angle)
        lost = (1 - np.clip(from_end / width, 0, 1)) / 2  # of the difference to the other branch
        same, opposite = (fourier(result.torque.source_angle(joint, angle, sign * rate)) for sign in (1, -1))
        parts.append((rate * lost) @ (same - opposite) / rate.size)
    return result.cadence * np.concatenate(parts)


def _by_design(runs: Runs) -> dict[str, QuasiStatic]:
    """One result a design, for what does not depend on the moments."""
    return {name: result for (name, group), result in runs.static.items() if group == RIDER_GROUPS[0]}

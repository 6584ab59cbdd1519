"""How far the recovered moments can be trusted: residuals, predictions of what was left out, sensitivity, checks."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.fourier import fourier
from fes_mj.geometry import joint_ranges
from fes_mj.joints import JOINTS
from fes_mj.kinematics import FULL_TURN, solve
from fes_mj.moments import GROUPS
from fes_mj.paper.captions import captioned
from fes_mj.paper.evidence import Evidence, functional
from fes_mj.paper.identification import LENGTH_ROUNDING
from fes_mj.paper.printed import SIX_BARS, table1
from fes_mj.paper.reconstruction import Posterior, Reconstruction, condition
from fes_mj.reference_tricycle import PAPER_TRICYCLE
from fes_mj.table import Table
from fes_mj.uncertainty import power_weights, with_sd
from fes_mj.variables import lengths, with_lengths

_SAMPLES = 2000  # of the posterior, for shares that no formula gives
_SEED = 2022
# A zero of the paper's figures is read from a line: less than this, per peak power, does not look negative.
VISIBLE = 0.03


def evidence_table(evidence: list[Evidence], recovered: Reconstruction) -> Table:
    """Every row: value, what the curves give, and what they would give had the row been left out."""
    rows = []
    for row in evidence:
        weights, value, error = functional(row)
        fitted = recovered.posteriors[row.group].predict(weights)
        others = condition(_group(evidence, row.group, without={row.name}), recovered.hyperparameters)
        left_out = others.predict(weights)
        rows.append(
            (
                row.name,
                with_sd(value, error),
                with_sd(*fitted),
                (fitted[0] - value) / error,
                with_sd(*left_out),
                (left_out[0] - value) / np.hypot(left_out[1], error),
                "W, part - share x whole" if row.quantity == "work_share" else row.unit,
            )
        )
    return captioned("evidence", rows)


def left_out_table(evidence: list[Evidence], recovered: Reconstruction) -> Table:
    """Leave-one-out prediction of every printed power; the TRT's with and without its twin, the 15 W item."""
    rows = []
    for row in (row for row in evidence if row.quantity == "power"):
        twins = {other.name for other in evidence if other.group == row.group and other.quantity == "crank_power"}
        cases = [("itself", {row.name})] + [("itself and the 15 W item", {row.name} | twins)] * (row.design == "trt")
        for title, without in cases:
            posterior = condition(_group(evidence, row.group, without), recovered.hyperparameters)
            mean, deviation = posterior.predict(functional(row)[0])
            relative = 100 * (mean - row.value) / row.value
            sigmas = (mean - row.value) / np.hypot(deviation, row.error)
            cells = (row.group, row.design.upper(), title, row.value, mean, deviation, relative, sigmas)
            rows.append(cells)
    return captioned("left_out", rows)


def sensitivity_table(evidence: list[Evidence], recovered: Reconstruction) -> Table:
    """The curves' smoothness chosen otherwise: likelihood, fit, and D1's gain over the TRT."""
    chosen = recovered.hyperparameters
    cases = {"chosen": chosen}
    cases |= {f"length {length:g}": replace(chosen, length=length) for length in (0.3, 0.5, 1.2, 1.6)}
    cases |= {f"amplitude {factor:g} x": replace(chosen, amplitude=factor * chosen.amplitude) for factor in (0.5, 2.0)}
    rows = []
    for title, hyperparameters in cases.items():
        posteriors = {group: condition(_group(evidence, group), hyperparameters) for group in GROUPS}
        likelihood = sum(posterior.log_likelihood for posterior in posteriors.values())
        worst = max(
            abs(posteriors[row.group].predict(weights)[0] - value) / error
            for row in evidence
            for weights, value, error in (functional(row),)
        )
        gains = [_gain(posterior) for posterior in posteriors.values()]
        rows.append((title, hyperparameters.length, hyperparameters.amplitude, likelihood, worst, *gains))
    return captioned("sensitivity", rows, group=GROUPS)


def predictive_table(recovered: Reconstruction) -> Table:
    """What the text says of the figures, and how probable the recovered curves find it."""
    rows: list[tuple[Any, ...]] = []
    for joint, direction, said in (("knee", 1.0, 20.0), ("knee", -1.0, -1.0)):
        moment = fourier(PAPER_TRICYCLE.source_angle(joint, np.radians(73.0), direction))
        for group, posterior in recovered.posteriors.items():
            mean, deviation = posterior.predict(np.concatenate([moment, 0 * moment]))
            name = "extending" if direction > 0 else "flexing"
            used = "used" if group == "p1p2" else "not used"
            rows.append((f"7.2: knee {name} at 73 deg, {group}", f"{said:.0f} N m", with_sd(mean, deviation, 1), used))
    for name in ("r2", "d1"):
        share, deviation, probability = _negative_share(load_design(name), recovered.posteriors["p1p2"])
        rows.append(
            (
                f"7.3: {name.upper()}'s power stays at or above 0 outside its peak, p1p2",
                "0 % of the turn negative",
                f"{100 * share:.0f} +- {100 * deviation:.0f} % below -{100 * VISIBLE:.0f} % of the peak",
                f"not used; probability {probability:.2f}",
            )
        )
        second = _second_peak(load_design(name), recovered.posteriors["p1p2"])
        rows.append((f"7.3: {name.upper()}'s power has one high peak, p1p2", "one", second, "not used"))
    share, deviation, _ = _negative_share(load_design("trt"), recovered.posteriors["p1p2"])
    cell = f"{100 * share:.0f} +- {100 * deviation:.0f} % below -{100 * VISIBLE:.0f} % of the peak"
    rows.append(("7.3: the TRT's power turns negative in its second half, p1p2", "negative", cell, "not used"))
    return captioned("predictive", rows)


def rounding_table(recovered: Reconstruction, batch: int = 10_000, wanted: int = 200) -> Table:
    """Spread of each six-bar's power over linkages inside Table 2's rounding that move as Table 1 says."""
    rows, random = [], np.random.default_rng(_SEED)
    for name in SIX_BARS:
        weights = np.array([_weights(design) for design in _inside_rounding(name, random, batch, wanted)])
        for group, posterior in recovered.posteriors.items():
            change = weights @ posterior.mean - _weights(load_design(name)) @ posterior.mean
            rows.append((name.upper(), group, float(np.sqrt(np.mean(change**2))), float(change.mean()), len(weights)))
    return captioned("rounding", rows)


def _inside_rounding(name: str, random: np.random.Generator, batch: int, wanted: int) -> Iterable[Design]:
    printed, target = load_design(name, "printed"), table1()[name]
    accepted: list[FloatArray] = []
    while len(accepted) < wanted:
        shift = random.uniform(-LENGTH_ROUNDING, LENGTH_ROUNDING, (9, batch, 1))
        drawn = lengths(printed)[:, None, None] + shift
        error = joint_ranges(with_lengths(printed, drawn), FULL_TURN[::8]) - (*target.knee_range, *target.hip_range)
        accepted += list(drawn[:, np.all(np.abs(error) < 0.5, axis=1), 0].T)
    samples = (with_lengths(printed, each) for each in accepted[:wanted])
    # the coarse turn may have stepped over an angle at which the linkage does not close
    return (sample for sample in samples if np.all(np.isfinite(joint_ranges(sample))))


def _group(evidence: list[Evidence], group: str, without: set[str] | None = None) -> list[Evidence]:
    return [row for row in evidence if row.group == group and row.name not in (without or set())]


def _weights(design: Design) -> FloatArray:
    return power_weights(solve(design), design.linkage.cadence, PAPER_TRICYCLE)


def _gain(posterior: Posterior) -> str:
    """D1's power per the TRT's with its standard deviation, to first order."""
    d1, trt = _weights(load_design("d1")), _weights(load_design("trt"))
    ratio = d1 @ posterior.mean / (trt @ posterior.mean)
    return f"{ratio:.2f} +- {posterior.predict(d1 - ratio * trt)[1] / (trt @ posterior.mean):.2f}"


def _negative_share(design: Design, posterior: Posterior) -> tuple[float, float, float]:
    """Share of the turn with visibly negative power: mean, standard deviation, and how probable it is below 1 %."""
    moments = _drawn_crank_moments(design, posterior)
    shares = np.mean(moments < -VISIBLE * moments.max(axis=0), axis=0)
    return float(shares.mean()), float(shares.std()), float(np.mean(shares < 0.01))


def _second_peak(design: Design, posterior: Posterior) -> str:
    """Highest power more than a quarter of a turn away from the peak, per peak."""
    moments = _drawn_crank_moments(design, posterior)
    quarter = len(moments) // 4
    turned = np.stack([np.roll(m, -peak) for m, peak in zip(moments.T, moments.argmax(axis=0), strict=True)])
    ratio = turned[:, quarter:-quarter].max(axis=1) / turned[:, 0]
    return f"second one of {100 * ratio.mean():.0f} +- {100 * ratio.std():.0f} % of the first"


def _drawn_crank_moments(design: Design, posterior: Posterior) -> FloatArray:
    """Crank moment over a full turn under curves drawn from the posterior, N m, shape (angles, samples)."""
    motion = solve(design)
    angle, rate = motion.joint_angle, motion.joint_rate
    rows = [
        rate[joint][:, None] * fourier(PAPER_TRICYCLE.source_angle(joint, angle[joint], rate[joint]))
        for joint in JOINTS
    ]
    random = np.random.default_rng(_SEED)
    draws = random.multivariate_normal(posterior.mean, posterior.covariance, _SAMPLES, method="eigh")
    return np.concatenate(rows, axis=1) @ draws.T

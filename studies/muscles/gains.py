"""Gains of riders whose muscles are known, and of those who may have been measured, under one rule for all linkages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, SIX_BARS, load_design
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, Anatomy
from fes_mj.muscles.by_angle import Gains, null_test
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.rules import RULES, stimulated
from fes_mj.muscles.setting import Setting
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, activation, best_windows
from fes_mj.muscles.trial import ENDS
from fes_mj.paper.evidence import load_evidence, of_group

KNOWN = 400  # riders of the prior in the null test
WIDTHS = (70, 100, 130)  # deg
MEASURED_W = (8, 35)  # both legs, of FES cycling (Szecsi 2014, doi:10.1186/1743-0003-11-123)


def riders_of_prior(count: int, **fixed: float) -> Riders:
    """Riders of the prior, with these quantities at one value."""
    values = prior_draws(count, np.random.default_rng(26)) | {
        name: np.full(count, value) for name, value in fixed.items()
    }
    return Riders("prior", values, np.zeros(count))


def known_gains() -> Gains:
    """True and by-angle gain of riders who are known, on SIX_BARS."""
    return null_test(riders_of_prior(KNOWN), [load_design(name) for name in SIX_BARS])


def paper_gains() -> dict[str, float]:
    """What the paper prints, by six-bar."""
    power = {row.design: row.value for row in of_group(load_evidence(), "p1p2") if row.quantity == "power"}
    return {name: power[name] / power["trt"] for name in SIX_BARS}


def null_rows() -> Iterator[tuple[Any, ...]]:
    """True and by-angle gain of riders who are known."""
    gains, paper = known_gains(), paper_gains()
    for name, true, predicted in zip(SIX_BARS, gains.true, gains.by_angle, strict=True):
        correlation = float(np.corrcoef(true, predicted)[0, 1])
        yield name.upper(), *quantiles(true), *quantiles(predicted), paper[name], correlation


def quantiles(values: FloatArray) -> list[float]:
    return [float(value) for value in np.quantile(values, ENDS)]


def group_powers(riders: Riders, name: str, muscles: Anatomy) -> FloatArray:
    """Mean power of each group alone, W, each member best stimulated, shape (groups, members)."""
    design = load_design(name)
    pulled = pull(riders, kinematics.solve(design, TURN_ANGLES), design.linkage.cadence, muscles)
    windows, _ = best_windows(pulled.power, riders, design.linkage.cadence, each_its_own=True)
    answers = activation(windows, riders, design.linkage.cadence)
    return np.asarray(np.mean(answers * pulled.power, axis=-1)[..., 0])


def group_rows(muscles: Anatomy, title: str) -> Iterator[tuple[Any, ...]]:
    """Gain of each group alone for time constants, without any fit; and of the vasti alone."""
    centre = {name: float(np.median(values)) for name, values in prior_draws(4001, np.random.default_rng(1)).items()}
    groups = [*((name, number, 1.0) for number, name in enumerate(MUSCLE_GROUPS)), ("vasti", 0, 0.0)]
    for rise in (0.05, 0.07, 0.10):
        for group, number, rectus in groups:
            rider = riders_of_prior(1, **centre | {"rise_s": rise, "rectus_recruitment": rectus})
            powers = {name: float(group_powers(rider, name, muscles)[number, 0]) for name in DESIGNS}
            yield title, group, rise, *(powers[name] / powers["trt"] for name in SIX_BARS)


def gain_rows(cadence_rpm: float | None) -> Iterator[tuple[Any, ...]]:
    """Gains of both rider groups by rule and width; at the paper's gears, or all at one cadence."""
    for group in RIDER_GROUPS:
        riders = load_riders(group)
        for rule, duty in [(rule, DUTY) for rule in RULES[1:]] + [(RULES[0], width / 360) for width in WIDTHS]:
            powers, works = {}, {}
            for name in DESIGNS:
                design = load_design(name)
                cadence = design.linkage.cadence if cadence_rpm is None else cadence_rpm * RPM
                powers[name] = stimulated(rule, riders, design, cadence, duty).power.mean(axis=1)
                works[name] = powers[name] / turns_per_second(cadence)
            title = f"best, {360 * duty:.0f} deg" if rule == RULES[0] else rule
            for name in DESIGNS:
                gain = powers[name] / powers["trt"]
                turn = quantiles(works[name] / works["trt"])
                above = [probability(gain > least) for least in (1, 1.25, 2)]
                beats = probability(powers[name] > powers["r1"]) if name != "r1" else None
                watts = float(powers[name].mean())
                yield group, title, name.upper(), watts, *quantiles(gain), *turn, *above, beats


def probability(holds: Any) -> float:
    """In how many of the riders it holds, %."""
    return 100 * float(np.mean(holds))


def power_rows() -> Iterator[tuple[Any, ...]]:
    """Powers, dead spots, windows and what mistimed windows cost, of both rider groups best stimulated."""
    for group in RIDER_GROUPS:
        for name in DESIGNS:
            design = load_design(name)
            setting = Setting.best(design, load_riders(group), design.linkage.cadence)
            content, power = setting.summary(), setting.power.sum(axis=0)
            work = content["power_mean_W"] / turns_per_second(design.linkage.cadence)
            right = [record for record in setting.records() if record["leg"] == "right"]
            ends = "; ".join(f"{row['on_deg']:.0f} to {row['off_deg']:.0f}" if row["duty"] else "-" for row in right)
            dead = (content["power_two_legs_min_W"], 100 * content["negative_share"])
            losses = (100 * content["early_loss_share"], 100 * content["late_loss_share"])
            low, high = MEASURED_W
            probabilities = (probability((2 * power >= low) & (2 * power <= high)), probability(2 * power > high))
            yield group, name.upper(), *quantiles(2 * power), *probabilities, work, *dead, *losses, ends

"""Random linkages that turn, half of them close to where they no longer would, and random periodic moments."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import ARCHITECTURES, Design, Linkage, Rider
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics.validity import turning_in_range

NEAREST, FARTHEST = 1.5e-4, 0.03  # m from the nearest dead centre
FINE = np.linspace(0, 2 * np.pi, 7200, endpoint=False)


def random_moments(rng: np.random.Generator) -> JointMoments:
    """A Fourier series of three harmonics for each joint."""
    angle = np.radians(np.arange(0.0, 360.0))

    def curve() -> np.ndarray:
        mean = rng.uniform(2, 10)  # some work is always done
        return np.asarray(
            mean + sum(rng.uniform(-8, 8) * np.cos(k * angle + rng.uniform(0, 2 * np.pi)) for k in (1, 2, 3))
        )

    return JointMoments("random", angle, curve(), curve())


def random_design(
    rng: np.random.Generator, kinds: Sequence[str] = tuple(ARCHITECTURES), nearest: float = NEAREST
) -> Design:
    """A linkage that turns all the way round, its joints at least partly within the range of the paper's moments.

    nearest: m, least distance from a dead centre; the distances are spread evenly over its logarithm.
    """
    while (design := _draw(rng, kinds, nearest)) is None:
        pass
    return design


def _draw(rng: np.random.Generator, kinds: Sequence[str], nearest: float) -> Design | None:
    uniform, kind = rng.uniform, str(rng.choice(list(kinds)))
    rider = Rider(uniform(0.4, 0.6), uniform(0.4, 0.6), uniform(45, 110), str(rng.choice(["male", "female"])))
    foot, margin = uniform(-0.05, 0.15), _clearance(rng, nearest)
    linkage = Linkage(kind, 0j, uniform(0.1, 0.2), foot)
    if kind != "trt":
        pivot, coupler, rocker = uniform(0.25, 0.5), uniform(0.25, 0.5), uniform(0.1, 0.25)
        # the dyad of rocker and coupler reaches from pivot - crank to pivot + crank, but for the clearance
        longest = min(rocker + coupler - pivot, pivot - abs(rocker - coupler)) - _clearance(rng, nearest)
        if not 0.03 < longest < 0.2:
            return None
        crank = longest if rng.random() < 0.5 else uniform(0.02, longest)
        pivot *= np.exp(1j * uniform(2.4, 3.6))
        linkage = Linkage(kind, 0j, crank, foot, complex(pivot), uniform(0.02, 0.18), coupler, rocker)
        linkage = replace(linkage, branch=str(rng.choice(["left", "right"])), coupler_angle=uniform(-np.pi, np.pi))
    design = Design("random", replace(linkage, gear_ratio=uniform(0.5, 3)), rider)
    return _seated(rng, design, margin, np.exp(1j * uniform(2.6, 3.7)))


def _clearance(rng: np.random.Generator, nearest: float) -> float:
    return float(10 ** rng.uniform(math.log10(nearest), math.log10(FARTHEST)))


def _seated(rng: np.random.Generator, design: Design, margin: float, direction: complex) -> Design | None:
    """With the hip where the leg reaches the pedal, or only just does, stretched or folded; None if nowhere."""
    path = kinematics.positions(design, FINE)["pedal"]
    farthest = design.rider.thigh + float(design.knee_to_pedal)
    nearest = abs(design.rider.thigh - float(design.knee_to_pedal))
    distance = np.linspace(0.2, 1.3, 1101)
    spans = np.abs(path[::10] - path.mean() + distance[:, None] * direction)
    low, high = spans.min(axis=1), spans.max(axis=1)
    inside = np.flatnonzero((high < farthest - margin) & (low > max(nearest + margin, 0.15)))
    if not inside.size:
        return None
    stretched = float(np.interp(farthest - margin, high[inside[-1] :], distance[inside[-1] :]))
    folded = float(np.interp(nearest + margin, low[: inside[0] + 1], distance[: inside[0] + 1]))
    seat = float(rng.choice([float(rng.choice(distance[inside])), stretched, folded])) * direction
    ground = complex(design.linkage.ground - path.mean() + seat)
    design = design.with_linkage(ground=ground)
    thigh = np.angle(kinematics.positions(design, FINE)["knee"]).mean()
    seat_angle = float(thigh - rng.uniform(*PAPER_TRICYCLE.ranges.hip))
    design = design.with_linkage(seat_angle=seat_angle)
    try:
        turning_in_range(design, PAPER_TRICYCLE)
    except InputError:
        return None
    return design

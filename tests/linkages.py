"""Random linkages that turn all the way round, and random periodic moments, for property tests."""

import math
from dataclasses import replace

import numpy as np
from hypothesis import assume, strategies as st

from fes_mj import kinematics
from fes_mj.design import Design, Linkage, Rider
from fes_mj.moments import JointMoments

MARGIN = 0.02  # m, that every dyad stays away from its dead centres


def between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


@st.composite
def designs(draw: st.DrawFn, kinds: tuple[str, ...] = ("trt", "crt", "cdt")) -> Design:
    """A TRT, CRT or CDT with a rider whose leg reaches the pedal at every crank angle."""
    kind = draw(st.sampled_from(kinds))
    rider = Rider(draw(between(0.4, 0.6)), draw(between(0.4, 0.6)), draw(between(45, 110)), draw(sexes))
    foot = draw(between(-0.05, 0.15))
    if kind == "trt":
        linkage = Linkage(kind, ground=0j, crank=draw(between(0.1, 0.2)), foot=foot)
    else:
        linkage = draw(crank_rockers(kind, foot))
    linkage = replace(
        linkage,
        gear_ratio=draw(between(0.5, 3)),
        seat_angle=draw(between(0, 1.2)),
        coupler_angle=draw(between(0.5, 2.5)),
    )
    return _within_reach(Design("random", linkage, rider), draw(between(0, 1)), draw(between(2.6, 3.7)))


sexes = st.sampled_from(("male", "female"))


@st.composite
def crank_rockers(draw: st.DrawFn, kind: str, foot: float) -> Linkage:
    """A four-bar whose shortest link is the crank, away from its change point; the hip is still at the pivot."""
    pivot = draw(between(0.25, 0.5)) * np.exp(1j * draw(between(2.4, 3.6)))
    coupler, rocker = draw(between(0.25, 0.5)), draw(between(0.1, 0.25))
    # the dyad of rocker and coupler must reach from |pivot| - crank to |pivot| + crank
    longest = min(rocker + coupler - abs(pivot), abs(pivot) - abs(rocker - coupler)) - MARGIN
    assume(longest > 0.03)
    crank = draw(between(0.02, min(0.17, longest)))
    arm = draw(between(0.02, 0.18))
    return Linkage(kind, 0j, crank, foot, complex(pivot), arm, coupler, rocker)


def _within_reach(design: Design, fraction: float, direction: float) -> Design:
    """Put the hip where the leg reaches the whole path of the pedal; refuse paths that are too large for it."""
    path = kinematics.positions(design, kinematics.FULL_TURN)["pedal"]
    centre = path.mean()
    size = np.abs(path - centre).max()
    nearest = abs(design.rider.thigh - design.knee_to_pedal) + size + MARGIN
    farthest = design.rider.thigh + design.knee_to_pedal - size - MARGIN
    nearest = max(nearest, 0.35)  # a pedal at the hip is no tricycle
    assume(nearest < farthest)
    distance = nearest + fraction * (farthest - nearest)
    ground = design.linkage.ground - centre + distance * np.exp(1j * direction)
    return replace(design, linkage=replace(design.linkage, ground=complex(ground)))


@st.composite
def periodic_moments(draw: st.DrawFn) -> JointMoments:
    """A Fourier series of three harmonics for each joint."""
    angle = np.radians(np.arange(0.0, 360.0, 1.0))
    curves = [
        draw(between(2, 10))  # some work is always done
        + sum(draw(between(-8, 8)) * np.cos(k * angle + draw(between(0, 2 * math.pi))) for k in (1, 2, 3))
        for _ in range(2)
    ]
    return JointMoments("random", angle, *curves)

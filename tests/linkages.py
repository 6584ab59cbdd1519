"""Random linkages that turn all the way round, and random periodic moments, for property tests."""

from collections.abc import Sequence
from functools import cache

import numpy as np
from hypothesis import settings, strategies as st

from fes_mj.linkage.design import ARCHITECTURES, Design
from fes_mj.moments.joint_moments import JointMoments
from studies.random_linkages import random_design, random_moments

MARGIN = 0.02  # m, that every dyad stays away from its dead centres

_seeds = st.integers(0, settings.default.max_examples - 1)  # as many as a property has examples: drawn once for all


def between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


def designs(kinds: Sequence[str] = tuple(ARCHITECTURES)) -> st.SearchStrategy[Design]:
    """A TRT, CRT or CDT with a rider whose leg reaches the pedal at every crank angle."""
    return _seeds.map(lambda seed: _design(seed, tuple(kinds)))


def periodic_moments() -> st.SearchStrategy[JointMoments]:
    """A Fourier series of three harmonics for each joint."""
    return _seeds.map(_moments)


@cache
def _design(seed: int, kinds: tuple[str, ...]) -> Design:
    return random_design(np.random.default_rng(seed), kinds, MARGIN)


@cache
def _moments(seed: int) -> JointMoments:
    return random_moments(np.random.default_rng(seed))

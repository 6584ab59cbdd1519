"""Random linkages that turn all the way round, and random periodic moments, for property tests."""

from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

from fes_mj.linkage.design import ARCHITECTURES, Design
from fes_mj.moments.joint_moments import JointMoments
from studies.random_linkages import random_design, random_moments

MARGIN = 0.02  # m, that every dyad stays away from its dead centres

_generators = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def between(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


def designs(kinds: Sequence[str] = tuple(ARCHITECTURES)) -> st.SearchStrategy[Design]:
    """A TRT, CRT or CDT with a rider whose leg reaches the pedal at every crank angle."""
    return _generators.map(lambda rng: random_design(rng, kinds, MARGIN))


def periodic_moments() -> st.SearchStrategy[JointMoments]:
    """A Fourier series of three harmonics for each joint."""
    return _generators.map(random_moments)

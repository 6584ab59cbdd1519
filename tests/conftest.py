"""Designs and moments that many tests share."""

import numpy as np
import pytest
from hypothesis import settings

import fes_mj
from fes_mj.design_file import DESIGNS
from fes_mj.moments import GROUPS

# The same examples in every run: a failure can be repeated. `--hypothesis-profile default` looks further.
settings.register_profile("fes_mj", derandomize=True, deadline=None, max_examples=50)
settings.load_profile("fes_mj")


@pytest.fixture(params=DESIGNS)
def design(request: pytest.FixtureRequest) -> fes_mj.Design:
    """Each catalogued design in turn."""
    return fes_mj.load_design(request.param)


@pytest.fixture(params=GROUPS)
def moments(request: pytest.FixtureRequest) -> fes_mj.JointMoments:
    """The recovered moments of each group in turn."""
    return fes_mj.load_moments(request.param)


@pytest.fixture
def smooth_moments() -> fes_mj.JointMoments:
    """Moments that nobody fitted to anything."""
    angle = np.radians(np.arange(0.0, 360.0, 0.5))
    return fes_mj.JointMoments(
        "smooth", angle, 9 + 11 * np.cos(angle - 1.2) + 2 * np.sin(3 * angle), 7 * np.sin(angle + 0.4)
    )

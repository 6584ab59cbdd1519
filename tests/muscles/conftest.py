import numpy as np
import pytest

from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.riders import Riders


@pytest.fixture(scope="session")
def riders():
    """A few riders of the prior."""
    return Riders("prior", prior_draws(8, np.random.default_rng(5)), np.arange(8.0))

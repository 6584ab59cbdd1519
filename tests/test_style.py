"""One look: colours that can be told apart."""

from itertools import combinations

import numpy as np

from fes_mj.style import COLOURS, LINKS, rgb


def test_colours_can_be_told_apart() -> None:
    for palette in (COLOURS, LINKS):
        for one, other in combinations(palette.values(), 2):
            assert np.linalg.norm(np.subtract(rgb(one), rgb(other))) > 0.08, (one, other)

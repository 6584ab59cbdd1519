"""One look: colours that can be told apart."""

from itertools import combinations

import numpy as np

from fes_mj.common.style import COLOURS, LINKS, MOMENTS, SERIES, hex_colour, rgb


def test_colours_can_be_told_apart() -> None:
    for palette in ((*COLOURS.values(), *MOMENTS), LINKS.values(), SERIES):
        for one, other in combinations(palette, 2):
            assert np.linalg.norm(np.subtract(rgb(one), rgb(other))) > 0.08, (one, other)


def test_a_colour_there_and_back() -> None:
    for colour in COLOURS.values():
        assert hex_colour(rgb(colour)) == colour

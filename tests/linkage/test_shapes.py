"""Bars are as thick as their parts; the boot holds the foot."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.style import LINKS, hex_colour, rgb
from fes_mj.linkage.inertia import foot_points
from fes_mj.linkage.shapes import PARTS, back_to_front, bars


def test_an_outline_is_half_a_thickness_from_its_line(design: fes_mj.Design) -> None:
    origin, direction = 0.3 - 0.2j, np.exp(0.7j)
    for bar in bars(design):
        local = (bar.outline(origin, direction) - origin) / direction  # back in the body's frame
        along = (bar.end - bar.start) / abs(bar.end - bar.start)
        offset = (local - bar.start) / along
        nearest = np.clip(offset.real, 0, abs(bar.end - bar.start))
        assert np.abs(offset - nearest) == pytest.approx(PARTS[bar.part].size, rel=1e-9)


def test_links_wear_the_videos_colours_and_the_boot_holds_the_foot(design: fes_mj.Design) -> None:
    drawn = back_to_front(design)
    for bar in drawn:
        if bar.part in LINKS:
            assert bar.colour == hex_colour(rgb(LINKS[bar.part]))
    _, heel, toe = foot_points(design)
    boot = next(bar for bar in drawn if bar.name == "boot").outline(0j, 1.0)
    sole = (toe - heel) / abs(toe - heel)
    reach = ((boot - heel) / sole).real  # with its round ends from heel to toe
    assert (reach.min(), reach.max()) == pytest.approx((0, abs(toe - heel)), abs=1e-9)

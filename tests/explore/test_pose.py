"""Links are rigid and joined, also where a linkage cannot close; there the gap is what the links lack."""

import numpy as np
import pytest

import fes_mj
from fes_mj.explore.pose import as_json, ends, failing
from fes_mj.linkage.assembly import DYADS, clearances
from fes_mj.linkage.design import Design
from fes_mj.linkage.kinematics import positions
from fes_mj.linkage.shapes import bars
from fes_mj.linkage.variables import replaced

ANGLES = np.radians(np.arange(360.0))
# Too long to close stretched, too short to close folded, and a leg out of reach.
IMPOSSIBLE = {
    "stretched": ("d1", {"R2": 0.25}),
    "folded": ("r1", {"R10": 1.5}),
    "folded the other way": ("d2", {"R9": 1.5}),
    "leg": ("d1", {"thigh": 0.40}),
    "leg of a TRT": ("trt", {"R1x": -1.1}),
}


@pytest.fixture(params=IMPOSSIBLE)
def impossible(request: pytest.FixtureRequest) -> Design:
    name, changes = IMPOSSIBLE[request.param]
    return replaced(fes_mj.load_design(name), changes)


def lengths(design: Design) -> None:
    """Every body keeps its length at every angle."""
    for body, (origin, tip) in ends(design, ANGLES).items():
        np.testing.assert_allclose(np.abs(tip - origin), float(design.link_lengths[body]), rtol=1e-12)


def test_a_linkage_that_turns_is_where_the_kinematics_say(design: Design) -> None:
    lengths(design)
    points, bodies = positions(design, ANGLES), ends(design, ANGLES)
    np.testing.assert_allclose(bodies["shank"][1], points["pedal"], atol=1e-12)
    np.testing.assert_allclose(bodies["thigh"][1], points["knee"], atol=1e-12)
    for first, second in DYADS:
        if first in bodies:
            np.testing.assert_array_equal(bodies[first][1], bodies[second][0])
    assert failing(design) is None


def test_an_impossible_linkage_is_open_by_what_its_links_lack(impossible: Design) -> None:
    lengths(impossible)
    angle = failing(impossible)
    assert angle
    bodies = ends(impossible, np.radians([angle["deg"]]))
    worst = next(clearance for clearance in clearances(impossible) if clearance.margin[0] < 0)
    first, second = worst.links
    gap = abs(complex(bodies[first][1][0] - bodies[second][0][0]))
    assert gap == pytest.approx(-float(worst.margin[0]), abs=1e-9)
    assert angle["text"].startswith(f"{first} and {second} cannot close at crank angle {angle['deg']:.1f} deg")
    assert angle["text"].endswith(f"{100 * gap:.2f} cm are missing")


def test_too_near_a_dead_centre() -> None:
    linkage = fes_mj.load_design("d1").linkage
    longest = linkage.rocker + linkage.coupler - abs(linkage.pivot_to_crank)  # of cranks that turn
    near = failing(replaced(fes_mj.load_design("d1"), {"R2": longest - 5e-5}))
    assert near
    assert near["text"].startswith("rocker and coupler come within 0.005 cm of their dead centre")
    assert near["text"].endswith("0.01 cm are needed")


def test_what_is_drawn_belongs_to_bodies_that_are_there(design: Design) -> None:
    answer = as_json(design, ANGLES)
    assert {bar.body for bar in bars(design)} == {"", *answer["bodies"]}
    assert {pin["body"] for pin in answer["pins"]} <= {*answer["bodies"]}
    assert len(answer["pins"]) == len(design.linkage.architecture.joints)

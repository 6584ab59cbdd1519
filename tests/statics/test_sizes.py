"""Sizes against beams and pins by hand, and forces on them against virtual work."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.inertia import inertias
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.plates import Hole, Plate, hole_places
from fes_mj.statics.link_loads import PEDAL_LOAD, LinkLoads, pedal_forces
from fes_mj.statics.materials import material, materials, pin_stock, plate_stock
from fes_mj.statics.sizes import BOUGHT, YIELD_SAFETY, Build, build


@pytest.fixture(scope="module")
def d1() -> Build:
    return build(fes_mj.quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), points=360))


def test_the_pedal_load_does_the_work_of_the_blocked_crank(design: fes_mj.Design) -> None:
    """Moment on the crank per turn of it = force times how far the pedal goes along it; the leg bears nothing."""
    motion = solve(design)
    moment, forces = pedal_forces(motion, PEDAL_LOAD)
    away = motion.points["pedal"].value / np.abs(motion.points["pedal"].value)
    work = PEDAL_LOAD * (np.conj(away) * motion.points["pedal"].first).real
    assert moment == pytest.approx(work, abs=1e-8 * np.abs(work).max())
    assert np.abs(forces["hip"]).max() == pytest.approx(0, abs=1e-8)
    assert np.abs(forces["pedal"]) == pytest.approx(PEDAL_LOAD)


def test_a_crank_is_a_cantilever() -> None:
    """Of the TRT's: bending is force times length where they are at right angles, pull where they are in line."""
    turn = fes_mj.quasi_static(fes_mj.load_design("trt"), fes_mj.load_moments("p1p2"), points=360)
    places = hole_places(turn.design)["crank"]
    plate = Plate("crank", tuple(Hole(joint, place, 0.01) for joint, place in places.items()), 0.02, 0.01)
    riding, pushed = LinkLoads.of(turn).sections(plate, {"pedal": 0.05, "crank_centre": 0.0})
    length = turn.design.linkage.crank
    assert riding.length == pushed.length == pytest.approx(length)
    assert np.hypot(pushed.bending / length, pushed.pull) == pytest.approx(PEDAL_LOAD)
    assert pushed.bending == pytest.approx(pedal_forces(turn.motion, PEDAL_LOAD)[0], abs=1e-9)
    assert pushed.across == pytest.approx(0.05 * PEDAL_LOAD)


def test_pins_are_the_thinnest_that_bear_their_forces(d1: Build) -> None:
    """Von Mises stress of a round cantilever, and pressure on its bush; the next thinner one does not do."""
    stock = pin_stock()

    def bears(joint: str, diameter: float) -> bool:
        force, lever = d1.loads.largest(joint), d1.stack.pin_lengths[joint]
        section, modulus = math.pi * diameter**2 / 4, math.pi * diameter**3 / 32
        torsion = d1.loads.torque / (2 * modulus) if joint == "crank_centre" else 0.0
        outside = math.sqrt((force * lever / modulus) ** 2 + 3 * torsion**2)
        middle = math.sqrt(3) * (4 / 3 * force / section + torsion)
        pressure = force / (diameter * d1.stack.thickness)
        return YIELD_SAFETY * max(outside, middle) <= stock.yield_strength and pressure <= stock.pressure

    for joint in d1.pins.keys() - {BOUGHT}:
        size = stock.diameter.index(d1.pins[joint])
        assert bears(joint, stock.diameter[size])
        assert size == 0 or not bears(joint, stock.diameter[size - 1]), joint


def test_plates_bear_their_loads_and_no_other_thickness_is_lighter(d1: Build) -> None:
    for body, plate in d1.plates.items():
        assert plate.width in plate_stock().width
        hole = max(hole.diameter for hole in plate.holes)
        assert plate.margin >= plate_stock().edge * hole
        levers = dict.fromkeys((hole.joint for hole in plate.holes), (plate.thickness + 0.001) / 2)
        levers["pedal"] = d1.stack.pin_lengths["pedal"]
        for section in d1.loads.sections(plate, levers):
            thick, width = plate.thickness, plate.width
            net = thick * (width - hole)
            stress = np.abs(section.pull) / net + np.abs(section.bending) * 6 * width / (thick * (width**3 - hole**3))
            stress = stress + section.across * 6 / (net * thick)
            assert YIELD_SAFETY * stress.max() <= d1.material.yield_strength, body


def test_masses_go_back_into_the_design(d1: Build) -> None:
    """The links weigh what their plates do, in every model; the legs are as they were."""
    before, after = inertias(fes_mj.load_design("d1")), inertias(d1.design)
    for body, inertia in after.items():
        plate = d1.plates.get(body)
        assert inertia == (plate.inertia(d1.material.density) if plate else before[body])
    assert d1.mass == pytest.approx({body: after[body].mass for body in d1.plates})
    case = fes_mj.Case(d1.design, fes_mj.load_moments("p1p2"))
    assert case.agrees


def test_materials_are_those_of_the_file() -> None:
    assert {"aluminium", "steel", "stainless"} == {*materials()}
    assert material("steel").density == 7850.0
    with pytest.raises(InputError, match=r"material is 'wood'.* aluminium, steel, stainless"):
        material("wood")


def test_a_flat_transmission_angle_cannot_be_built() -> None:
    """R2's, 7 deg: its pins would bear eight times the pedal load."""
    turn = fes_mj.quasi_static(fes_mj.load_design("r2"), fes_mj.load_moments("p1p2"), points=360)
    with pytest.raises(InputError, match=r"r2: no pin in stock bears the"):
        build(turn, "steel")

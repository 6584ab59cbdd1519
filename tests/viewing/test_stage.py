"""The stage: what is written over a picture stands where it says, and beside the mechanism."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.style import hex_colour
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.linkage.legs import LEGS
from fes_mj.simulation.mjcf import build_mjcf

pytest.importorskip("PIL")
pytest.importorskip("mediapy")
from fes_mj.viewing import stage as stages
from fes_mj.viewing.headless import use_offscreen_gl


@pytest.mark.parametrize("legs", [1, 2])
def test_points_are_drawn_where_mujoco_draws_them(legs: int) -> None:
    """The hip's pin, in its own colour, against the pixel that is computed for the hip."""
    use_offscreen_gl()
    design = fes_mj.load_design("d1")
    spec = build_mjcf(design, legs=legs)
    hip = np.array(stages.PARTS["hip"].colour)
    with stages.stage(spec, design, 1.0, legs) as scene:
        names = ("right_crank", "crank")
        picture = scene.picture({name: 0.0 for name in names if spec.joint(name)}).astype(float)[:600]
    share = picture / np.maximum(picture.sum(axis=-1, keepdims=True), 1)
    rows, columns = np.nonzero(np.abs(share - hip / hip.sum()).max(axis=-1) < 0.03)
    pixel = stages.Camera(design, LEGS[legs][0]).pixels(np.array([0j]))[0]
    # the pin stands out of the plane towards the camera by 7 cm, which moves it by some pixels
    assert (columns.mean(), rows.mean()) == pytest.approx(pixel, abs=12)


@pytest.mark.parametrize(
    "name", ["trt", "d1", *(pytest.param(name, marks=pytest.mark.long) for name in ("r1", "r2", "d2"))]
)
def test_nothing_is_cut(name: str) -> None:
    """The outermost pixels of what is drawn are those of an empty picture, all over the turn."""
    use_offscreen_gl()
    case = fes_mj.Case(fes_mj.load_design(name), fes_mj.load_moments(), legs=2)
    run = case.simulation
    rows = stages.Camera(case.design, LEGS[2][0]).rows
    top = (stages.SIDE - rows) // 2
    assert rows < stages.SIDE  # less than the whole is drawn
    spec = build_mjcf(case.design, cadence=run.cadence, timestep=run.timestep, legs=2)
    with stages.stage(spec, case.design, 1.0, 2) as scene:
        empty = np.asarray(scene._empty)[top : stages.SIDE - top]
        for step in np.linspace(0, len(run.crank_angle), 12, endpoint=False).astype(int):
            picture = scene.picture({joint: angle[step] for joint, angle in run.joint_angle.items()})
            drawn = picture[top : stages.SIDE - top]
            for edge in ((0, ...), (-1, ...), (..., 0, slice(None)), (..., -1, slice(None))):
                np.testing.assert_array_equal(drawn[edge], empty[edge])
            assert (drawn != empty).any(axis=-1).mean() > 0.1


@pytest.mark.parametrize("name", DESIGNS)
def test_the_arrow_turns_with_the_crank_outside_all_that_moves(name: str) -> None:
    design = fes_mj.load_design(name)
    arc, centre = stages.turning_arrow(design), complex(design.linkage.crank_centre)
    positions = kinematics.positions(design, np.array([0.0, 0.1]))["crank_pin"] - centre
    assert np.all(np.diff(np.unwrap(np.angle(arc - centre))) * np.angle(positions[1] / positions[0]) > 0)
    pixels = np.array(stages.Camera(design, LEGS[2][0]).pixels(arc))
    assert np.all((pixels > 10) & (pixels < stages.SIDE - 10))  # inside the picture
    (x1, y1), (x2, y2) = pixels[1] - pixels[0], pixels[-1] - pixels[0]
    assert x1 * y2 - y1 * x2 > 0  # clockwise on the screen, whose y runs down
    everything = np.concatenate(
        [np.ravel(jet.value) for jet in kinematics.solve(design, kinematics.FULL_TURN).points.values()]
    )
    assert min(np.abs(everything - point).min() for point in arc) > 0.05  # m


def test_the_speed_is_written_into_the_picture() -> None:
    assert stages.speed_text(1) == "true speed"
    assert stages.speed_text(0.1556) == "slow motion, x0.16"
    assert stages.speed_text(2.0) == "fast motion, x2"
    design = fes_mj.load_design("d1")
    camera = stages.Camera(design, LEGS[1][0])
    slow, true = (np.asarray(stages._overlay(design, camera, speed)) for speed in (0.16, 1.0))
    rows, columns = np.nonzero(np.any(slow != true, axis=-1))
    assert (rows.max() < 60, columns.max() < 300) == (True, True)  # and nothing else differs


@pytest.mark.parametrize("name", DESIGNS)
def test_the_key_shows_the_colours_of_what_there_is(name: str) -> None:
    design = fes_mj.load_design(name)
    overlay = np.asarray(stages._overlay(design, stages.Camera(design, LEGS[1][0]), 1.0))
    shown = {hex_colour((r / 255, g / 255, b / 255)) for r, g, b, _ in np.unique(overlay[660:].reshape(-1, 4), axis=0)}
    parts = {"hip", "knee", *design.linkage.architecture.bodies}
    links = {"rocker", "coupler"}
    assert {hex_colour(stages.PARTS[part].colour) for part in parts} <= shown
    assert not {hex_colour(stages.PARTS[part].colour) for part in links - parts} & shown

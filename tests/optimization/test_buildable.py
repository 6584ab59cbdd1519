"""What can be built: values of populations against those of single designs, by other ways."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.assembly import transmission_angles
from fes_mj.linkage.kinematics import solve
from fes_mj.optimization.buildable import (
    Buildability,
    BuildLimits,
    clearance,
    hole_distance,
    slow_values,
    transmission_angle,
)
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.statics.cycles import cycles
from tests.optimization.conftest import TABLE

MOMENTS = fes_mj.load_moments("p1p2")


def test_transmission_angle_is_that_of_the_moving_links(design: fes_mj.Design) -> None:
    fine = min(transmission_angles(solve(design, np.linspace(0, 2 * np.pi, 36001))).values())
    assert transmission_angle(design, cycles(design, TABLE))[0] == pytest.approx(float(fine), abs=0.01)


def test_hole_distances_by_the_law_of_cosines(design: fes_mj.Design) -> None:
    linkage = design.linkage
    lengths = {"trt": [linkage.crank], "crt": [linkage.crank, linkage.rocker, linkage.pedal_arm, linkage.coupler]}
    third = np.sqrt(
        linkage.coupler**2
        + linkage.pedal_arm**2
        - 2 * linkage.coupler * linkage.pedal_arm * np.cos(linkage.coupler_angle)
    )
    lengths["cdt"] = [*lengths["crt"], third]
    assert hole_distance(design)[0] == pytest.approx(min(lengths[linkage.kind]))


def test_a_population_has_the_values_of_its_designs() -> None:
    d1 = fes_mj.load_design("d1")
    cranks = d1.linkage.crank + np.array([[0.0], [-0.002], [-0.004]])
    batch = d1.with_linkage(crank=cranks)
    drive = MomentDrive(MOMENTS)
    values = slow_values(batch, np.array([True, False, True]), BuildLimits(), drive.pin_force)
    assert np.isnan(values[1]).all()
    for row in (0, 2):
        assert values[row].tolist() == [drive.pin_force(batch.single(row)), clearance(batch.single(row))]
    assert transmission_angle(batch, cycles(batch, TABLE))[2] == pytest.approx(
        transmission_angle(batch.single(2), cycles(batch.single(2), TABLE))[0]
    )


@pytest.mark.parametrize(
    ("name", "words"),
    [("r2", ["transmission angle goes down to 7", "N act on a pin"]), ("d1", ["21 deg"]), ("d2", ["25 deg", "3.6 %"])],
)
def test_the_papers_designs_leave_the_limits(name: str, words: list[str]) -> None:
    """As estimated outside the project: 7, 21 and 25 deg, D2 3.6 % outside."""
    doubts = "; ".join(Buildability.of(fes_mj.quasi_static(fes_mj.load_design(name), MOMENTS)).broken().values())
    assert all(word in doubts for word in words), doubts


def test_a_degenerate_class_and_a_still_hip_are_named() -> None:
    d1 = fes_mj.load_design("d1").with_linkage(pedal_arm=1e-4)
    doubts = Buildability.of(fes_mj.quasi_static(fes_mj.load_design("trt"), MOMENTS)).broken().values()
    assert not doubts
    assert hole_distance(d1)[0] == pytest.approx(1e-4)

"""Files of the layout that Park et al. (2022) published, made up: a force that always pushes along the circle."""

import re
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from studies.park import DATA, DEGREES, MODEL, STATES, bicycle, pedal_force, powers, trial

FORCE = 60.0  # N
PERIOD = 2.0  # s
BODIES = {
    "pelvis": ((0, 0, 0), (0, 0, -0.2), 40),
    "femur_l": ((-0.06, -0.08, -0.07), (0, 0, 0), 8),
    "tibia_l": ((-0.005, -0.42, 0), (0, 0, 0), 3),
    "talus_l": ((-0.01, -0.42, 0), (0, 0, 0), 0.1),
    "calcn_l": ((-0.05, -0.04, -0.01), (0, 0, 0), 1),
    "toes_l": ((0.18, 0, 0), (0, 0, 0), 0.2),
    "crank": ((0.18, -0.74, 0), (0, 0, 0), 1),
}


def _vector(name: str, values: tuple[float, ...]) -> str:
    return f"<{name}> {' '.join(map(str, values))} </{name}>"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    bodies = "".join(
        f"<Body name='{name}'><mass>{mass}</mass><Joint><J>{_vector('location_in_parent', place)}"
        f"{_vector('orientation_in_parent', turned)}</J></Joint></Body>"
        for name, (place, turned, mass) in BODIES.items()
    )
    spline = f"{_vector('x', (0.0, 1.0, PERIOD))}{_vector('y', (20.0, 24.0, 20.0))}"
    forces = (
        f"<PointToPointSpring name='Spring_l'>{_vector('point1', (0, 0.17, -0.08))}</PointToPointSpring>"
        f"<PrescribedForce name='CrankTorque'><F><SimmSpline>{spline}</SimmSpline></F></PrescribedForce>"
    )
    for name in (MODEL, STATES, DATA):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / MODEL).write_text(f"<D><Model><B>{bodies}</B><F>{forces}</F></Model></D>")
    states = "states\nnRows=3\nendheader\ntime\tknee_angle_l\tankle_angle_l\n0\t1.5\t0.2\n1\t0.6\t-0.15\n2\t1.5\t0.2\n"
    (tmp_path / STATES).write_text(states)
    return tmp_path


def _tangential() -> np.ndarray:
    return FORCE * -1j * np.exp(1j * np.radians(90 - DEGREES))


def test_the_bicycle_is_that_of_the_model(folder):
    machine = bicycle(folder)
    hip = complex(-0.06, -0.08) * np.exp(-0.2j)
    assert machine.hip_to_crank == pytest.approx(complex(0.18, -0.74) - hip)
    assert (machine.crank, machine.period) == (0.17, PERIOD)
    assert machine.mass == pytest.approx(52.3)
    pedal = complex(0.13, -0.04) * np.exp(-0.15j)
    assert (machine.foot, machine.shank) == pytest.approx((pedal.real, 0.42 - pedal.imag))


def test_power_survives_the_chain_of_the_moments(folder, tmp_path):
    machine = bicycle(folder)
    for name, text in zip(("park.csv", "park.toml"), trial(machine, _tangential()), strict=True):
        (tmp_path / name).write_text(text)
    found = powers(machine, _tangential(), tmp_path / "park.toml")
    exact = FORCE * 0.17 * 2 * np.pi / PERIOD
    assert found["by the pedal's force"] == pytest.approx(exact, rel=1e-12)
    assert found["by the joint moments"] == pytest.approx(exact, rel=1e-3)
    assert found["by the joint moments in MuJoCo"] == pytest.approx(exact, rel=1e-3)
    assert found["by the crank torque of the model's file"] == pytest.approx(22 * np.pi / PERIOD)


def test_the_forces_of_a_mat_file(folder):
    h5py = pytest.importorskip("h5py")
    with h5py.File(folder / DATA, "w") as file:
        file["Two_L/APF_Two_L"] = np.stack([_tangential().real, np.ones(361)])
        file["Two_L/VF_Two_L"] = np.stack([_tangential().imag, np.ones(361)])
    assert pedal_force(folder) == pytest.approx(_tangential())


def test_another_model_is_refused(folder):
    (folder / MODEL).write_text("<D><Model/></D>")
    with pytest.raises(InputError, match=re.escape(f"{MODEL}: ")):
        bicycle(folder)

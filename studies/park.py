"""Pedal forces of able-bodied riders through the whole chain of the moments: python -m studies.park FOLDER [OUT]

FOLDER: a copy of github.com/sangsoopark1739/pedaling_DC_OpenSim (Park, Caldwell and Umberger 2022,
doi:10.1371/journal.pone.0264346; GPL), which is not part of this project. Its .mat file needs h5py. OUT: where the
measurement file and its table are written. results/park.* holds the crank's power by the pedal's forces, by the joint
moments that follow from them, by those moments in MuJoCo, and by the crank torque that the model's file holds.
"""

import sys
import tempfile
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

import fes_mj
from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError, MissingPartError
from fes_mj.common.markdown import Table
from fes_mj.common.writing import json_text, write_text
from fes_mj.moments.tables import load_table
from fes_mj.statics.turn import quasi_static

DATA = "MatlabCode/Experimental_Data/TwoL_Tracking_Data.mat"
MODEL = "MatlabCode/Model/Pedaling_Model.osim"
STATES = "Optimal_Solution_Results/N31_Equal_Optimal_States.sto"
PATH = Path(__file__).parents[1] / "results" / "park.md"
HEADING = """# Pedal forces of able-bodied riders

Written by `python -m studies.park FOLDER` from mean pedal forces of fifteen recreational cyclists (Park, Caldwell and
Umberger 2022, [doi:10.1371/journal.pone.0264346](https://doi.org/10.1371/journal.pone.0264346)), whose files are under
the GPL and not part of this project. Forces become joint moments by inverse dynamics on a traditional tricycle of their
bicycle's dimensions, moments become crank power by statics and by MuJoCo with masses. The last row is another record of
the same trial: half the crank torque of both legs in the authors' model. The ankle is held; in the riders it moves.
"""
DEGREES = np.arange(361.0)  # of the crank, from the top, clockwise for who sees the rider face right


class Bicycle(NamedTuple):
    """Of the riders' common model: m, rad, x forward, y up. torque: of both legs on the crank over a turn, N m."""

    hip_to_crank: complex
    crank: float
    thigh: float
    shank: float
    foot: float
    period: float
    torque: FloatArray
    mass: float


def bicycle(folder: Path) -> Bicycle:
    """From the OpenSim model, the ankle held as where the leg is longest: foot and shank are one body in fes_mj."""
    model = ElementTree.parse(folder / MODEL)

    def numbers(path: str) -> FloatArray:
        text = model.findtext(f".//{path}")
        if text is None:
            raise InputError(f"{folder / MODEL}: there is no {path}; it must be the model of Park et al. 2022")
        return np.array(text.split(), float)

    def place(body: str, name: str = "location_in_parent") -> FloatArray:
        return numbers(f"Body[@name='{body}']//{name}")

    hip, crank, turned = place("femur_l"), place("crank"), place("pelvis", "orientation_in_parent")[2]
    states = load_table(folder / STATES, "states")
    ankle = float(states.column("ankle_angle_l")[states.column("knee_angle_l").argmin()])
    pedal = complex(*(place("calcn_l") + place("toes_l"))[:2]) * np.exp(1j * ankle)
    spline = "PrescribedForce[@name='CrankTorque']//SimmSpline"
    masses = [float(mass.text or 0) for mass in model.iterfind(".//Body/mass")]
    return Bicycle(
        complex(*crank[:2]) - complex(*hip[:2]) * np.exp(1j * turned),
        abs(float(numbers("PointToPointSpring[@name='Spring_l']/point1")[1])),
        float(np.hypot(*place("tibia_l")[:2])),
        float(-place("talus_l")[1] - pedal.imag),
        pedal.real,
        float(numbers(f"{spline}/x")[-1]),
        numbers(f"{spline}/y"),
        sum(masses) - float(numbers("Body[@name='crank']/mass")[0]),
    )


def pedal_force(folder: Path) -> FloatArray:
    """Mean force of the left foot on its pedal over DEGREES, N, complex, x forward, y up."""
    try:
        import h5py
    except ModuleNotFoundError:
        raise MissingPartError(f"{DATA} is HDF5: pip install h5py") from None
    with h5py.File(folder / DATA) as file:
        forward, up = (np.asarray(file[f"Two_L/{name}_Two_L"])[0] for name in ("APF", "VF"))
    return np.asarray(forward + 1j * up)


def trial(machine: Bicycle, force: FloatArray) -> tuple[str, str]:
    """The table and the measurement file of fes_mj, x backwards; crank angle after the crank points backwards."""
    angle = 90 - DEGREES  # forward and up; seen from the other side, the turn is counter-clockwise
    rows = "\n".join(
        f"{(180 - a) % 360:.0f},{-f.real:.4f},{f.imag:.4f}" for a, f in zip(angle[:-1], force[:-1], strict=True)
    )
    centre = machine.hip_to_crank
    toml = f"""[moments]
file = "park.csv"
pedal_force = ["Fx", "Fy"]
zero = "horizontal"
[measured_on]
cadence_rpm = {60 / machine.period:.4f}
R1 = [{-centre.real:.5f}, {centre.imag:.5f}]
R2 = {machine.crank:.4f}
R6 = {machine.foot:.4f}
seat_angle = 90
[measured_on.rider]
thigh = {machine.thigh:.4f}
shank = {machine.shank:.4f}
mass = {machine.mass:.2f}
"""
    return f"crank_angle_deg,Fx,Fy\n{rows}\n", toml


def powers(machine: Bicycle, force: FloatArray, path: Path) -> dict[str, float]:
    """Mean power of one leg on the crank, W, by each way; path: of the measurement file."""
    angle = np.radians(90 - DEGREES[:-1])
    moved = -1j * machine.crank * np.exp(1j * angle) * (2 * np.pi / machine.period)
    moments = fes_mj.load_moments(path)
    tricycle = moments.measured_on
    static = quasi_static(tricycle.design, moments, tricycle.cadence)
    run = fes_mj.simulate(tricycle.design, moments, cadence=tricycle.cadence)
    return {
        "by the pedal's force": float(np.mean((np.conj(force[:-1]) * moved).real)),
        "by the joint moments": static.power_mean,
        "by the joint moments in MuJoCo": run.power_mean,
        "by the crank torque of the model's file": float(machine.torque[:-1].mean() * np.pi / machine.period),
    }


def main() -> None:
    folder = Path(sys.argv[1])
    machine, force = bicycle(folder), pedal_force(folder)
    with tempfile.TemporaryDirectory() as temporary:
        out = Path(sys.argv[2] if sys.argv[2:] else temporary)
        for name, text in zip(("park.csv", "park.toml"), trial(machine, force), strict=True):
            write_text(out / name, text)
        computed = powers(machine, force, out / "park.toml")
    table = Table("Mean power of one leg", {"way": "", "W": ".2f"}, [*computed.items()])
    write_text(PATH, f"{HEADING}\n{table.markdown()}")
    write_text(PATH.with_suffix(".json"), json_text({table.title: table.records()}))


if __name__ == "__main__":
    main()

"""Make the small made-up trial of examples/trial, as OpenSim would write one: nobody's data.

`python -m tools.make_trial` writes ik.mot (joint angles) and id.sto (joint moments) of some turns on a traditional
tricycle, described by trial.toml beside them.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.writing import write_files
from fes_mj.linkage import kinematics
from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.measurement_file import Description
from fes_mj.moments.reference_tricycle import ReferenceTricycle

FOLDER = Path(__file__).parents[1] / "examples" / "trial"
RATE = 50.0  # samples a second
TURNS = 4.4  # the rest of a turn is what a recording has at its ends
NOISE = 0.8  # N m, standard deviation of each turn's own deviation


def invented(angle: FloatArray) -> PerJoint[FloatArray]:
    """Moments over the crank angle from top dead centre (rad), N m: three harmonics of no rider."""
    knee = 4 + 13 * np.cos(angle - 1.0) + 2.5 * np.cos(2 * angle) + 1.0 * np.sin(3 * angle)
    hip = 1 + 5 * np.cos(angle - 1.6) - 1.2 * np.sin(2 * angle) + 0.5 * np.cos(3 * angle)
    return PerJoint(knee, hip)


def trial(measured_on: ReferenceTricycle, turns: float, noise: float, seed: int = 1) -> tuple[str, str]:
    """The texts of ik.mot and id.sto: invented moments, each turn with a smooth deviation of its own."""
    random = np.random.default_rng(seed)
    time = np.arange(round(turns * 2 * np.pi / measured_on.cadence * RATE) + 1) / RATE
    angle = measured_on.cadence * time - 1.2  # from top dead centre
    pose = kinematics.solve(measured_on.design, angle + measured_on.top_dead_centre).joint_angle
    turn = np.floor(angle / (2 * np.pi)).astype(int)
    moment = invented(angle).map(lambda m: m + _deviation(random, angle, turn, noise))
    # As gait2392 counts them: 0 for the straight leg in line with the trunk, knee extension and hip flexion positive.
    knee, hip = np.degrees(pose.knee) - 180, 180 - np.degrees(pose.hip)
    motion = _opensim("Coordinates", "yes", {"time": time, "knee_angle_r": knee, "hip_flexion_r": hip})
    dynamics = {"time": time, "knee_angle_r_moment": moment.knee, "hip_flexion_r_moment": -moment.hip}
    return motion, _opensim("Inverse Dynamics Generalized Forces", "no", dynamics)


def _deviation(random: np.random.Generator, angle: FloatArray, turn: IntArray, size: float) -> FloatArray:
    """First two harmonics, drawn anew for every turn."""
    drawn = size * random.standard_normal((int(np.ptp(turn)) + 1, 4))[turn - turn.min()]
    harmonics = np.stack([f(k * angle) for f in (np.cos, np.sin) for k in (1, 2)], axis=-1)
    return np.asarray(np.sum(drawn * harmonics, axis=-1))


def _opensim(title: str, degrees: str, columns: Mapping[str, FloatArray]) -> str:
    rows = "\n".join("\t".join(f"{value:.6f}" for value in row) for row in zip(*columns.values(), strict=True))
    count = f"nRows={len(columns['time'])}\nnColumns={len(columns)}"
    return f"{title}\nversion=1\n{count}\ninDegrees={degrees}\nendheader\n" + "\t".join(columns) + f"\n{rows}\n"


def main() -> None:
    """Write the trial."""
    motion, dynamics = trial(Description.read(FOLDER / "trial.toml").measured_on, TURNS, NOISE)
    write_files({FOLDER / "ik.mot": motion, FOLDER / "id.sto": dynamics})


if __name__ == "__main__":
    main()

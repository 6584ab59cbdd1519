"""Load an exported model without fes_mj, replay the moments of its table, print the crank power of one turn.

python replay_moments.py d1.xml
"""

import csv
import sys
from pathlib import Path
from typing import Any, NoReturn

import mujoco
import numpy as np


def stop(message: str) -> NoReturn:
    """End with one message and exit code 2."""
    print(f"replay_moments.py: {message}", file=sys.stderr)
    raise SystemExit(2)


def load(path: Path) -> tuple[mujoco.MjModel, dict[str, Any], list[str]]:
    """The model, its table, and the motors that the table drives."""
    if not path.is_file():
        stop(f"{path}: there is no such file; give a model of `fes_mj export`")
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        stop(f"{path}: MuJoCo cannot load it: {' '.join(str(error).split())}; give a model of `fes_mj export`")
    table = path.with_suffix(".csv")
    try:
        header, *rows = csv.reader(table.read_text(encoding="utf-8").splitlines())
        columns = dict(zip(header, np.array(rows, float).T, strict=True))
    except OSError as error:
        stop(f"{table}: cannot read the table of joint moments: {error.strerror}; give the model itself, not its scene")
    except ValueError:
        stop(f"{table}: this is no table of numbers under one header; export the model again")
    motors = [name.removesuffix("_Nm") for name in columns if name.endswith(("knee_Nm", "hip_Nm"))]
    actuators = {model.actuator(number).name for number in range(model.nu)}
    if not motors or missing(columns):
        stop(f"{table}: the columns {', '.join(missing(columns)) or 'knee_Nm'} are not there; export the model again")
    if not actuators.issuperset(motors):
        stop(f"{path}: it has no motors {', '.join(motors)}; export it without the variants passive and muscles")
    if "crank_servo" not in actuators and model.joint("crank").armature[0] < 1e5:
        stop(f"{path}: nothing holds its crank at a cadence; export it without the variants free, brake and ride")
    return model, columns, motors


def missing(columns: dict[str, Any]) -> list[str]:
    return [name for name in ("crank_angle_deg", "crank_Nm") if name not in columns]


def replay(model: mujoco.MjModel, table: dict[str, Any], motors: list[str]) -> tuple[float, float]:
    """Mean crank power of the second turn, and what the table says, W."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    crank, power, turn = data.joint("crank"), [], 2 * np.pi
    cadence = float(crank.qvel[0])
    while crank.qpos[0] < 2 * turn:
        angle = np.degrees(crank.qpos[0])
        for motor in motors:
            data.actuator(motor).ctrl = np.interp(angle, table["crank_angle_deg"], table[f"{motor}_Nm"], period=360)
        mujoco.mj_step(model, data)
        if angle >= 360:  # the first turn lets the loops settle
            power.append(data.sensor("crank_torque").data[1] * data.sensor("crank_speed").data[0])
    return float(np.mean(power)), float(table["crank_Nm"].mean() * cadence)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        stop("give one model of `fes_mj export`, with its table (.csv) beside it")
    measured, expected = replay(*load(Path(sys.argv[1])))
    print(f"crank power {measured:.3f} W, table {expected:.3f} W")

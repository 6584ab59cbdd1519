"""Load an exported model without fes_mj, replay the moments of its table, print the crank power of one turn.

python replay_moments.py d1.xml
"""

import csv
import sys
from pathlib import Path

import mujoco
import numpy as np

path = Path(sys.argv[1])
rows = [*csv.reader(path.with_suffix(".csv").open())]
table = dict(zip(rows[0], np.array(rows[1:], float).T, strict=True))
model = mujoco.MjModel.from_xml_path(str(path))
data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)
cadence = data.joint("crank").qvel[0]
motors = [joint.removesuffix("_Nm") for joint in rows[0] if joint.endswith(("knee_Nm", "hip_Nm"))]

power, turn = [], 2 * np.pi
while data.joint("crank").qpos[0] < 2 * turn:
    angle = np.degrees(data.joint("crank").qpos[0])
    for motor in motors:
        data.actuator(motor).ctrl = np.interp(angle, table["crank_angle_deg"], table[f"{motor}_Nm"], period=360)
    mujoco.mj_step(model, data)
    if angle >= 360:  # the first turn lets the loops settle
        power.append(data.sensor("crank_torque").data[1] * data.sensor("crank_speed").data[0])

print(f"crank power {np.mean(power):.3f} W, table {table['crank_Nm'].mean() * cadence:.3f} W")

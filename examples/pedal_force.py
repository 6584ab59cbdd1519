"""The force of foot on pedal over the turn: quasi-static, with masses and weight, and as MuJoCo's constraint."""

import numpy as np

import fes_mj
from fes_mj.linkage.inertia import body_loads
from fes_mj.linkage.kinematics import solve
from fes_mj.simulation.stepping import FORCE_EVERY
from fes_mj.statics.equilibrium import equilibrium

design, moments = fes_mj.load_design("r1"), fes_mj.load_moments("p1p3")
static = fes_mj.quasi_static(design, moments)
run = fes_mj.simulate(design, moments)

motion = solve(design, run.crank_angle[::FORCE_EVERY])
_, reactions = equilibrium(motion, static.torque.along(motion, run.cadence), body_loads(motion, run.cadence))
for name, force in (
    ("quasi-static", static.reactions["pedal"]),
    ("with masses and weight", reactions["pedal"]),
    ("MuJoCo", run.loop_force["pedal"]),
):
    print(f"{name:24s} mean {np.abs(force).mean():6.1f} N, largest {np.abs(force).max():6.1f} N")

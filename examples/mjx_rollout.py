"""Roll out 64 copies of the exported ride model at once with MJX: by how much should stimulation lead the crank?

python examples/mjx_rollout.py       # needs mujoco-mjx: pip install mujoco-mjx; compiling takes a minute

Each copy pedals with the recovered moments commanded by crank angle, led by another angle; muscles answer with a lag of
first order. What comes out is how far each has come, beside the angle by which such a lag trails. MJX leaves out the
air's resistance.
"""

import os

os.environ.setdefault("JAX_ENABLE_X64", "1")  # the stiff loops ask for double precision

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

from fes_mj import load_design, load_moments
from fes_mj.moments.drive import DRIVE_POINTS, drive
from fes_mj.simulation.variants import variant_model, variant_options

COPIES, DURATION = 64, 2.0  # s
LAG = 0.1  # s, time constant of the muscles
JOINTS = [(leg, joint) for leg in ("right", "left") for joint in ("hip", "knee")]  # in the order of the motors


def roll_out(design: str = "r2", copies: int = COPIES, duration: float = DURATION) -> dict[str, np.ndarray]:
    """Arrays of shape (copies,): `lead` (rad), `distance` (m) and `loop_gap` (m) at the end."""
    chosen, moments = load_design(design), load_moments()
    spec = variant_model(chosen, moments, chosen.linkage.cadence, variant_options(["ride", "fixed-gear", "compatible"]))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    moment, behind = drive(chosen, moments), DRIVE_POINTS // 2
    table = np.array([np.roll(moment[joint], behind if leg == "left" else 0) for leg, joint in JOINTS])
    assert [model.actuator(i).name for i in range(model.nu)] == [f"{leg}_{joint}" for leg, joint in JOINTS]
    crank = int(model.joint("crank").qposadr[0])
    put, commands, kept = mjx.put_model(model), jnp.asarray(table), float(np.exp(-model.opt.timestep / LAG))

    def advance(_: int, carried: tuple[mjx.Data, jax.Array, jax.Array]) -> tuple[mjx.Data, jax.Array, jax.Array]:
        state, answer, lead = carried
        place = (state.qpos[crank] + lead) * (DRIVE_POINTS / (2 * np.pi))
        command = commands[:, jnp.floor(place).astype(int) % DRIVE_POINTS]
        answer = command + kept * (answer - command)
        return mjx.step(put, state.replace(ctrl=answer)), answer, lead

    def ride(lead: jax.Array) -> tuple[jax.Array, jax.Array]:
        begin = advance(0, (mjx.put_data(model, data), jnp.zeros(model.nu), lead))  # settles the types of the carry
        state, *_ = jax.lax.fori_loop(1, round(duration / model.opt.timestep), advance, begin)
        return state.qpos, state.qvel

    leads = np.linspace(-np.pi / 2, np.pi, copies)
    qpos, qvel = (np.asarray(state) for state in jax.jit(jax.vmap(ride))(jnp.asarray(leads)))
    names = [model.sensor(i).name for i in range(model.nsensor)]
    gaps = []
    for position in qpos:
        data.qpos[:] = position
        mujoco.mj_forward(model, data)
        gaps.append(max(float(np.linalg.norm(data.sensor(name).data)) for name in names if name.endswith("_gap")))
    return {
        "lead": leads,
        "distance": qpos[:, int(model.joint("road").qposadr[0])],
        "speed": qvel[:, int(model.joint("road").dofadr[0])],
        "loop_gap": np.array(gaps),
    }


if __name__ == "__main__":
    result, cadence = roll_out(), load_design("r2").linkage.cadence
    best = int(np.argmax(result["distance"]))
    for lead, distance in zip(result["lead"][::7], result["distance"][::7], strict=True):
        print(f"lead {np.degrees(lead):6.1f} deg: {distance:.3f} m")
    lead, distance, trail = (
        np.degrees(result["lead"][best]),
        result["distance"][best],
        np.degrees(np.arctan(LAG * cadence)),
    )
    print(f"best of {COPIES}: {lead:.0f} deg, {distance:.3f} m in {DURATION:g} s; such a lag trails by {trail:.0f} deg")
    print(f"loops open by {result['loop_gap'].max():.1e} m at most")

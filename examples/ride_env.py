"""A Gymnasium environment on the exported ride model: drive the tricycle by stimulation or by joint moments.

python examples/ride_env.py          # a table of stimulation windows, and chance

It needs gymnasium: pip install gymnasium.
"""

import math
from collections.abc import Callable
from typing import Any, Literal

import gymnasium
import mujoco
import numpy as np
from numpy.typing import NDArray

from fes_mj import load_design, load_moments
from fes_mj.moments.torque_map import torque_map
from fes_mj.riding.stimulation import MUSCLES, Window, stimulation
from fes_mj.simulation.variants import variant_model, variant_options

CHANNELS = [(leg, name) for leg in ("right", "left") for name in MUSCLES]  # of the stimulator
PERIOD = 0.02  # s between two actions: a stimulator's 50 Hz
EFFORT = 0.5  # m/s that full effort of all muscles costs
STOPPED = 0.1  # m/s


class RideEnv(gymnasium.Env[NDArray[np.float64], NDArray[Any]]):
    """Ride a flat road for some seconds, launched at 5.71 km/h give or take a fifth.

    Actions, held for PERIOD:
      "stimulation": MultiBinary(6), in the order of CHANNELS: quadriceps, hamstrings and gluteus of the right leg, then
        of the left. An activation follows each with a time constant `lag` (s); the moment is the activation times the
        largest that the group's recovered moments show.
      "moments": Box(4) within -1 and 1, of the motors' ranges in N m: hip and knee of the right leg, then of the left;
        extension is positive.

    Observation, Box of float64:
      0, 1   cosine and sine of the crank angle, which is 0 where the right crank arm points backwards
      2      crank speed, rad/s
      3      speed of the tricycle, m/s
      4-9    the activations, 0 to 1 (only with "stimulation")

    Reward: metres ridden in the step, less EFFORT times PERIOD times the mean activation (or the mean squared action).
    It ends when the tricycle stops, and is cut off after `duration` seconds. info: `time` (s), `distance` (m), `effort`
    (s of full effort).

    variants: those of `fes_mj export`, `ride` among them; `fixed-gear` takes the freewheel away.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012  gymnasium's own declaration

    def __init__(
        self,
        design: str = "r2",
        group: str = "p1p2",
        actions: Literal["stimulation", "moments"] = "stimulation",
        variants: tuple[str, ...] = ("ride",),
        lag: float = 0.1,
        duration: float = 20.0,
    ) -> None:
        self.design, moments = load_design(design), load_moments(group)
        spec = variant_model(self.design, moments, self.design.linkage.cadence, variant_options(variants))
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.lag, self.duration, self.stimulated = lag, duration, actions == "stimulation"
        table = torque_map(moments).table
        self.strength = [
            float((muscle.sense * table[muscle.joint]).max()) for muscle in (MUSCLES[n] for _, n in CHANNELS)
        ]
        self.steps = round(PERIOD / self.model.opt.timestep)
        self.crank, self.road = self.data.joint("crank"), self.data.joint("road")
        self.tendon = self.model.tendon("drivetrain").id
        self.freewheel = bool(self.model.tendon_limited[self.tendon])
        self.limit = float(self.model.tendon_range[self.tendon, 0])
        self.activation, self.effort = np.zeros(len(CHANNELS)), 0.0
        active = len(CHANNELS) * self.stimulated
        largest = np.array([1, 1, 200, 50, *[1] * active], float)  # no crank and no rider is faster
        self.bounds = np.where(np.arange(len(largest)) < 4, -largest, 0.0), largest
        self.observation_space = gymnasium.spaces.Box(*self.bounds, dtype=np.float64)
        self.action_space = (
            gymnasium.spaces.MultiBinary(len(CHANNELS))
            if self.stimulated
            else gymnasium.spaces.Box(-1.0, 1.0, (self.model.nu,), np.float32)
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        super().reset(seed=seed)
        mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        self.data.qvel *= self.np_random.uniform(0.8, 1.2)  # one degree of freedom: all speeds together
        self.model.tendon_range[self.tendon, 0] = self.limit
        self.activation[:], self.effort = 0.0, 0.0
        return self._observation(), self._info()

    def step(self, action: NDArray[Any]) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        before, effort = float(self.road.qpos[0]), self._drive(np.asarray(action))
        for _ in range(self.steps):
            mujoco.mj_step(self.model, self.data)
            if self.freewheel:  # it has no memory: the wheel is where it has come to
                limit, length = self.model.tendon_range[self.tendon], self.data.ten_length[self.tendon]
                limit[0] = max(limit[0], length)
        self.effort += PERIOD * effort
        reward = float(self.road.qpos[0]) - before - EFFORT * PERIOD * effort
        stopped = bool(self.road.qvel[0] < STOPPED)
        return self._observation(), reward, stopped, self.data.time >= self.duration - PERIOD / 2, self._info()

    def _drive(self, action: NDArray[Any]) -> float:
        """Set the motors for an action; its effort, 0 to 1."""
        if not self.stimulated:
            self.data.ctrl[:] = np.clip(action, -1, 1) * self.model.actuator_ctrlrange[:, 1]
            return float(np.mean(np.square(np.clip(action, -1, 1))))
        kept = math.exp(-PERIOD / self.lag) if self.lag else 0.0
        self.activation = action + kept * (self.activation - action)
        self.data.ctrl[:] = 0.0
        for (leg, name), active, strength in zip(CHANNELS, self.activation, self.strength, strict=True):
            joint, sense = MUSCLES[name]
            self.data.actuator(f"{leg}_{joint}").ctrl += sense * active * strength
        return float(self.activation.mean())

    def _observation(self) -> NDArray[np.float64]:
        angle = float(self.crank.qpos[0])
        state = [math.cos(angle), math.sin(angle), float(self.crank.qvel[0]), float(self.road.qvel[0])]
        seen = np.array([*state, *self.activation] if self.stimulated else state)
        return np.asarray(np.clip(seen, *self.bounds))

    def _info(self) -> dict[str, Any]:
        return {"time": self.data.time, "distance": float(self.road.qpos[0]), "effort": self.effort}


# gymnasium.make("fes_mj/Ride-v0", design="d1")
gymnasium.register("fes_mj/Ride-v0", entry_point=lambda **choices: RideEnv(**choices))

Policy = Callable[[NDArray[np.float64]], NDArray[Any]]


def table_policy(env: RideEnv) -> Policy:
    """Stimulate each group in its core window, advanced by what the crank turns in the lag."""
    windows: dict[tuple[str, str], list[Window]] = {channel: [] for channel in CHANNELS}
    for window in stimulation(env.design):
        windows[window.leg, window.muscle].append(window)

    def policy(observation: NDArray[np.float64]) -> NDArray[Any]:
        cosine, sine, speed = observation[:3]
        ahead = math.atan2(sine, cosine) + env.lag * max(speed, 0.0)
        on = [
            any((ahead - window.core[0]) % (2 * math.pi) < window.core_width for window in windows[channel])
            for channel in CHANNELS
        ]
        return np.array(on, np.int8)

    return policy


def random_policy(env: RideEnv) -> Policy:
    """Whatever the action space gives; env.action_space.seed makes it the same again."""
    return lambda _: env.action_space.sample()


def roll_out(env: RideEnv, policy: Policy, seed: int = 0) -> dict[str, NDArray[np.float64]]:
    """One episode: `reward` and what info holds at each step, and the `speed` (m/s)."""
    observation, info = env.reset(seed=seed)
    rows, over = [{**info, "reward": 0.0, "speed": observation[3]}], False
    while not over:
        observation, reward, stopped, late, info = env.step(policy(observation))
        rows.append({**info, "reward": reward, "speed": observation[3]})
        over = stopped or late
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


if __name__ == "__main__":
    env = RideEnv()
    env.action_space.seed(0)
    for name, policy in (("table", table_policy(env)), ("random", random_policy(env))):
        run = roll_out(env, policy)
        distance, seconds, effort, speed = (run[key][-1] for key in ("distance", "time", "effort", "speed"))
        print(
            f"{name:6}: {distance:5.1f} m in {seconds:.1f} s, {3.6 * speed:4.1f} km/h at the end, "
            f"effort {effort:.2f} s, return {run['reward'].sum():.1f}"
        )

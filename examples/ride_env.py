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

from fes_mj import load_design, load_moments, load_muscles, stimulated_rider
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.instant import LegMuscles, joint_moments, stimulation
from fes_mj.muscles.stepping import MuscleStepper, steady
from fes_mj.riding.stimulated import lead
from fes_mj.simulation.stepping import drive_addresses
from fes_mj.simulation.variants import variant_model, variant_options

PERIOD = 0.02  # s between two actions: a stimulator's 50 Hz
TICK = PERIOD / 10  # s between two answers of the muscles
EFFORT = 0.5  # m/s that full effort of all muscles costs
STOPPED = 0.1  # m/s
REST = (0.0,) * len(MUSCLE_GROUPS)


class RideEnv(gymnasium.Env[NDArray[np.float64], NDArray[Any]]):
    """Ride a flat road for some seconds, launched at 5.71 km/h give or take a fifth.

    Actions, held for PERIOD:
      "stimulation": MultiBinary(6): quadriceps, hamstrings and gluteus of the right leg, then of the left. Muscles of
        the group's most probable rider answer, as in `fes_mj ride`: late, and by length and speed of their fibres.
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
        duration: float = 20.0,
    ) -> None:
        self.design, moments = load_design(design), load_moments(group)
        spec = variant_model(self.design, moments, self.design.linkage.cadence, variant_options(variants))
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.duration, self.stimulated = duration, actions == "stimulation"
        self.rider = stimulated_rider(load_muscles(group), self.design)
        self.muscles = LegMuscles.of(self.rider.riders, self.design.rider).in_lists
        self.joints = [[drive_addresses(self.model, leg.prefix + joint) for joint in JOINTS] for leg in TWO_LEGS]
        self.steps = round(TICK / self.model.opt.timestep)
        self.crank, self.road = self.data.joint("crank"), self.data.joint("road")
        self.tendon = self.model.tendon("drivetrain").id
        self.freewheel = bool(self.model.tendon_limited[self.tendon])
        self.limit = float(self.model.tendon_range[self.tendon, 0])
        active = len(TWO_LEGS) * len(MUSCLE_GROUPS)
        largest = np.array([1, 1, 200, 50, *[1] * active * self.stimulated], float)  # no crank and no rider is faster
        self.bounds = np.where(np.arange(len(largest)) < 4, -largest, 0.0), largest
        self.observation_space = gymnasium.spaces.Box(*self.bounds, dtype=np.float64)
        self.action_space = (
            gymnasium.spaces.MultiBinary(active)
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
        self.effort, rest = 0.0, steady(self.muscles, TICK, [REST], REST)
        self.legs = [MuscleStepper(self.muscles, TICK, rest) for _ in TWO_LEGS]
        return self._observation(), self._info()

    def step(self, action: NDArray[Any]) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        before, asked = float(self.road.qpos[0]), np.asarray(action)
        if not self.stimulated:
            self.data.ctrl[:] = np.clip(asked, -1, 1) * self.model.actuator_ctrlrange[:, 1]
        for step in range(round(PERIOD / TICK) * self.steps):
            if self.stimulated and not step % self.steps:
                self._pull(asked)
            mujoco.mj_step(self.model, self.data)
            if self.freewheel:  # it has no memory: the wheel is where it has come to
                limit, length = self.model.tendon_range[self.tendon], self.data.ten_length[self.tendon]
                limit[0] = max(limit[0], length)
        effort = float(np.mean(self.activation) if self.stimulated else np.mean(np.square(np.clip(asked, -1, 1))))
        self.effort += PERIOD * effort
        reward = float(self.road.qpos[0]) - before - EFFORT * PERIOD * effort
        stopped = bool(self.road.qvel[0] < STOPPED)
        return self._observation(), reward, stopped, self.data.time >= self.duration - PERIOD / 2, self._info()

    @property
    def activation(self) -> list[float]:
        return [active for leg in self.legs for active in leg.activation]

    def _pull(self, asked: NDArray[Any]) -> None:
        """Let the muscles of both legs go on by a TICK, and pull."""
        angle, rate = self.data.qpos, self.data.qvel
        for leg, leg_pulses, ((_, *knee), (_, *hip)) in zip(
            self.legs, asked.reshape(2, -1).tolist(), self.joints, strict=True
        ):
            state = (float(values[joint[row]]) for row, values in enumerate((angle, rate)) for joint in (knee, hip))
            moments = joint_moments(self.muscles, leg.advance(leg_pulses), *state)
            self.data.qfrc_applied[[knee[1], hip[1]]] = moments

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
    """Stimulate each group in its best window, led for the speed as in `fes_mj ride`, and by the muscles' delay."""
    stimulator = env.rider.stimulator

    def policy(observation: NDArray[np.float64]) -> NDArray[Any]:
        cosine, sine, speed = observation[:3]
        felt = math.atan2(sine, cosine) + lead(stimulator, speed) + speed * (env.muscles.delay + PERIOD / 2)
        asked = [
            stimulation(stimulator.stimulus, group, felt - leg.lag)
            for leg in TWO_LEGS
            for group in range(len(MUSCLE_GROUPS))
        ]
        return np.array(np.round(asked), np.int8)

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

"""Two problems that others chose, built by the project's own MJCF code and run under its own settings.

A02 of the IFToMM library of multibody benchmarks (Gonzalez, Dopico, Lugris, Cuadrado, Multibody Syst. Dyn. 16, 2006):
N four-bar windows of 2N + 1 equal bars stand upright and are pushed over; every time the bars lie flat all windows are
singular at once. As long as no window leaves its branch the chain is a pendulum, so the exact motion is known.

The four-bar test of the Newton physics engine (newton-physics/newton, test_physics_validation.py): a crank-rocker at
one revolution a second for two seconds, its rocker within 0.1 deg of Freudenstein's equation, its loop within 1 mm.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from scipy.integrate import solve_ivp

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.checks import Check, check
from fes_mj.linkage.design import Design, Linkage, Rider
from fes_mj.linkage.inertia import GRAVITY, Inertia
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.mjcf import AXIS, LOOP_SOLIMP, ModelOptions, Physics, add_body, build_mjcf, set_options
from fes_mj.simulation.stepping import Sensors, controlled_loop, run_loop

WINDOWS = 2  # of the chain, as in the library's table of results
CHAIN_TIME = 10.0  # s
BAR_LENGTH, BAR_MASS, PUSH = 1.0, 1.0, 1.0  # m, kg, m/s of the first bar's top


@dataclass(frozen=True)
class IntegratorSettings:
    """How a chain is integrated: MuJoCo's integrator, time step (s), loop time constant (s) and impedance."""

    name: str
    integrator: Any
    timestep: float
    loop_time: float
    solimp: tuple[float, ...]


RECOMMENDED = IntegratorSettings("RK4, stiff loops", mujoco.mjtIntegrator.mjINT_RK4, 0.5e-3, 1e-3, LOOP_SOLIMP)
DEFAULTS = IntegratorSettings(
    "MuJoCo's defaults", mujoco.mjtIntegrator.mjINT_EULER, 2e-3, 0.02, (0.9, 0.95, 0.001, 0.5, 2.0)
)


@dataclass(frozen=True)
class Chain:
    """A run of A02; arrays have shape (steps,)."""

    settings: IntegratorSettings
    time: FloatArray  # s
    energy: FloatArray  # J, relative to the start
    gap: FloatArray  # m, of the window that is open widest
    top: ComplexArray  # m, top of the first bar
    exact: ComplexArray  # m, where it ought to be

    @property
    def energy_drift(self) -> float:
        """Largest change of the energy, J."""
        return float(np.abs(self.energy).max())

    @property
    def path_error(self) -> float:
        """Largest distance of the first bar's top from the exact motion, m."""
        return float(np.abs(self.top - self.exact).max())


def compare_chains() -> list[Chain]:
    """The chain at the recommended settings and at MuJoCo's defaults."""
    return [run_chain(settings) for settings in (RECOMMENDED, DEFAULTS)]


def chain_spec(settings: IntegratorSettings, windows: int = WINDOWS) -> Spec:
    """The chain upright: bar i stands on the ground at x = i, coupler i leads from its top to the next bar's."""
    spec = mujoco.MjSpec()
    set_options(spec, settings.timestep, GRAVITY)
    spec.default.joint.axis = AXIS
    spec.option.integrator = settings.integrator
    inertia = Inertia(BAR_MASS, complex(BAR_LENGTH / 2), BAR_MASS * BAR_LENGTH**2 / 12)
    upright, ends = math.pi / 2, (BAR_LENGTH, 0.0, 0.0)
    for i in range(windows + 1):
        bar = add_body(spec.worldbody, f"bar{i}", (i * BAR_LENGTH, 0.0, 0.0), inertia, angle=upright)
        bar.add_site(name=f"top{i}", pos=ends)
        if i < windows:
            coupler = add_body(bar, f"coupler{i}", ends, inertia, angle=-upright)
            coupler.add_site(name=f"end{i}", pos=ends)
    for i in range(windows):
        loop = spec.add_equality(name=f"window{i}", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE)
        loop.name1, loop.name2 = f"end{i}", f"top{i + 1}"
        loop.solref, loop.solimp = (settings.loop_time, 1.0), settings.solimp
    return spec


def run_chain(settings: IntegratorSettings, windows: int = WINDOWS, duration: float = CHAIN_TIME) -> Chain:
    """Push the chain over and let it turn for `duration` s."""
    model = chain_spec(settings, windows).compile()
    data = mujoco.MjData(model)
    for i in range(model.njnt):  # couplers keep their direction
        data.qvel[i] = (-1 if model.joint(i).name.startswith("bar") else 1) * PUSH / BAR_LENGTH
    steps = round(duration / settings.timestep)
    ends = [(data.site(f"end{i}"), data.site(f"top{i + 1}")) for i in range(windows)]
    energy, gap, top = np.empty(steps), np.empty(steps), np.empty(steps, complex)
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    for step in range(steps):
        mujoco.mj_forward(model, data)
        energy[step] = data.energy.sum()
        gap[step] = max(np.linalg.norm(one.xpos - other.xpos) for one, other in ends)
        top[step] = complex(*data.site("top0").xpos[[0, 2]])
        mujoco.mj_step(model, data)
    time = settings.timestep * np.arange(steps, dtype=float)
    return Chain(settings, time, energy - energy[0], gap, top, exact_top(time, windows))


def exact_top(time: FloatArray, windows: int = WINDOWS) -> ComplexArray:
    """Top of the first bar, m: the windows stay parallelograms, so the chain is a pendulum of one angle."""
    moment = (windows + 1) / 3 + windows  # bars turn about their feet, couplers travel; of mass times length squared
    lever = (windows + 1) / 2 + windows
    rate = GRAVITY / BAR_LENGTH * lever / moment

    def pendulum(_: float, state: FloatArray) -> list[float]:
        return [state[1], rate * math.sin(state[0])]

    start = [0.0, PUSH / BAR_LENGTH]
    angle = solve_ivp(pendulum, (0, time[-1]), start, "DOP853", time, rtol=1e-12, atol=1e-12).y[0]
    return np.asarray(BAR_LENGTH * 1j * np.exp(-1j * angle))


# Crank, coupler, rocker and ground link of Newton's test, m; bars of 4 cm square section, 1000 kg/m^3, without weight.
CRANK, COUPLER, ROCKER, GROUND = 0.2, 0.5, 0.4, 0.5
BAR_WIDTH, BAR_DENSITY = 0.04, 1000.0
ONE_TURN_A_SECOND, FOUR_BAR_TURNS = 2 * math.pi, 2
FOUR_BAR_TIMESTEP = 2e-4  # s, that of the test


def run_four_bar() -> tuple[float, float]:
    """Largest error of the rocker's or the coupler's angle (deg) and largest loop gap (m) of Newton's four-bar test.

    The four-bar is a TRT whose thigh is the rocker and whose shank is the coupler.
    """
    linkage = Linkage("trt", ground=complex(-GROUND), crank=CRANK, foot=0.0, seat_angle=0.0)
    design = Design("four_bar", linkage, Rider(thigh=ROCKER, shank=COUPLER))
    weightless = ModelOptions(Physics(gravity=0.0))
    spec = build_mjcf(design, cadence=ONE_TURN_A_SECOND, timestep=FOUR_BAR_TIMESTEP, options=weightless)
    for name, length in (("crank", CRANK), ("shank", COUPLER), ("thigh", ROCKER)):
        body, mass = spec.body(name), BAR_DENSITY * length * BAR_WIDTH**2
        body.mass, body.ipos, body.inertia = mass, (length / 2, 0, 0), [mass * (length**2 + BAR_WIDTH**2) / 12] * 3
    model = spec.compile()
    run = run_loop(model, controlled_loop(lambda *_: lambda: None), round(FOUR_BAR_TURNS / FOUR_BAR_TIMESTEP))

    rows = Sensors(model, run.sensors)
    crank, rocker, knee = (rows[f"{joint}_angle"] for joint in ("crank", "hip", "knee"))
    coupler = rocker - knee  # from the crank pin to the knee
    exact_coupler, exact_rocker = freudenstein(crank)
    errors = (_wrapped(rocker - exact_rocker), _wrapped(coupler - exact_coupler))
    gap = np.linalg.norm(rows.vector("pedal_gap"), axis=1)
    return math.degrees(max(float(np.abs(error).max()) for error in errors)), float(gap.max())


def freudenstein(crank_angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles of coupler (crank pin to rocker joint) and rocker, rad, by Freudenstein's equation, open branch."""
    k1, k2 = GROUND / CRANK, GROUND / ROCKER
    k3 = (CRANK**2 - COUPLER**2 + ROCKER**2 + GROUND**2) / (2 * CRANK * ROCKER)
    cosine, sine = np.cos(crank_angle), np.sin(crank_angle)
    # (k1 - cos) cos(rocker) - sin sin(rocker) = k2 cos - k3
    across, along = -sine, k1 - cosine
    rocker = np.arctan2(across, along) + np.arccos((k2 * cosine - k3) / np.hypot(across, along))
    coupler = np.arctan2(ROCKER * np.sin(rocker) - CRANK * sine, GROUND + ROCKER * np.cos(rocker) - CRANK * cosine)
    return coupler, rocker


def _wrapped(angle: FloatArray) -> FloatArray:
    return np.asarray(np.angle(np.exp(1j * angle)))


def chain_checks(subject: str) -> Iterator[Check]:
    """The chain at the recommended settings."""
    chain = run_chain(RECOMMENDED)
    yield check("a02_energy", chain.energy_drift, subject)
    yield check("a02_path", chain.path_error, subject)
    yield check("a02_gap", float(chain.gap.max()), subject)


def four_bar_checks(subject: str) -> Iterator[Check]:
    """The four-bar at the settings of `simulate`."""
    angle, gap = run_four_bar()
    yield check("four_bar_angle", angle, subject)
    yield check("four_bar_gap", gap, subject)

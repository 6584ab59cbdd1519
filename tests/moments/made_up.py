"""Made-up trials of known truth. Triangles and numerical derivatives only: nothing here comes from the package."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

R1, R2, R6, THIGH, SHANK, SEAT, MASS = -0.70 - 0.26j, 0.13, 0.07, 0.43, 0.50, 45.0, 70.0
# Signs that count as positive: knee angle, knee moment, hip angle, hip moment; 1 is extension.
SIGNS = {"gait2392": (1, 1, -1, -1), "rajagopal": (-1, -1, -1, -1), "winter": (-1, 1, -1, 1)}


def angles(crank: np.ndarray, ground: complex = R1, arm: float = R2) -> tuple[np.ndarray, np.ndarray]:
    """Knee and hip angle, growing in extension, deg, at crank angles from top dead centre, rad."""
    pedal = ground + arm * np.exp(1j * (crank + np.angle(-ground)))
    leg, distance = math.hypot(SHANK, R6), np.abs(pedal)
    knee = np.arccos((THIGH**2 + leg**2 - distance**2) / (2 * THIGH * leg)) - math.atan2(R6, SHANK)
    at_hip = np.arccos((THIGH**2 + distance**2 - leg**2) / (2 * THIGH * distance))
    hip = np.mod(np.angle(pedal), 2 * np.pi) - at_hip - math.radians(SEAT)  # the knee above the line to the pedal
    return np.degrees(knee), np.degrees(hip)


def moments(crank: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Knee and hip moment, extension positive, N m."""
    return 5 + 14 * np.cos(crank - 1.1) + 3 * np.sin(2 * crank), 2 + 6 * np.cos(crank - 1.4) - np.cos(3 * crank)


def work() -> float:
    """Of a turn, J: the sum of moment times change of angle."""
    edges = np.linspace(0, 2 * np.pi, 20_001)
    middles = (edges[1:] + edges[:-1]) / 2
    pairs = zip(moments(middles), angles(edges), strict=True)
    return float(sum(np.sum(moment * np.diff(np.radians(angle))) for moment, angle in pairs))


@dataclass(frozen=True)
class Trial:
    """A trial as a laboratory would record it: cadence in rpm, turns, samples a second, sd of noise."""

    convention: str = "gait2392"
    cadence: float = 45.0
    turns: float = 5.4
    rate: float = 50.0
    noise: float = 0.0  # N m
    angle_noise: float = 0.0  # deg
    uneven: float = 0.0  # part of the crank speed that comes and goes within the turn
    pelvis: float = 0.0  # deg
    ground: complex = R1
    crank_at: Callable[[np.ndarray], np.ndarray] | None = None  # of time, instead of an even or uneven crank
    seed: int = 1

    def columns(self) -> dict[str, np.ndarray]:
        """Time (s), crank (rad from top dead centre), angles (deg) and moments (N m) as the convention counts them."""
        random, speed = np.random.default_rng(self.seed), self.cadence * np.pi / 30
        time = np.arange(round(self.turns * 60 / self.cadence * self.rate)) / self.rate
        crank = self.crank_at(time) if self.crank_at else self._turned(speed * time - 0.9)
        (knee, hip), (knee_moment, hip_moment) = angles(crank, self.ground), moments(crank)
        signs = SIGNS[self.convention]
        zeros = (180, 0, 180 + self.pelvis, 0)
        noise = (self.angle_noise, self.noise, self.angle_noise, self.noise)
        values = [
            sign * (value - zero + sd * random.standard_normal(len(time)))
            for sign, value, zero, sd in zip(signs, (knee, knee_moment, hip, hip_moment), zeros, noise, strict=True)
        ]
        return dict(
            zip(("time", "crank", "knee", "knee_moment", "hip", "hip_moment"), (time, crank, *values), strict=True)
        )

    def _turned(self, mean: np.ndarray) -> np.ndarray:
        """Crank angles of mean anomalies, as da/dt = w (1 - u cos a) has them: by Kepler's half-angle formula."""
        factor = math.sqrt((1 - self.uneven) / (1 + self.uneven))
        slow = mean * 1.0
        half = slow / 2
        return 2 * np.arctan(factor * np.tan(half)) + 2 * np.pi * np.round(slow / (2 * np.pi))


def opensim(path: Path, columns: Mapping[str, np.ndarray], degrees: bool = True) -> None:
    """Write a file as OpenSim does."""
    rows = "\n".join("\t".join(f"{value:.8f}" for value in row) for row in zip(*columns.values(), strict=True))
    count = f"nRows={len(columns['time'])}\nnColumns={len(columns)}\ninDegrees={'yes' if degrees else 'no'}"
    path.write_text(f"{path.stem}\nversion=1\n{count}\nendheader\n" + "\t".join(columns) + f"\n{rows}\n")


MEASURED_ON = f"""[measured_on]
R1 = [{R1.real}, {R1.imag}]
R2 = {R2}
R6 = {R6}
seat_angle = {SEAT}
[measured_on.rider]
thigh = {THIGH}
shank = {SHANK}
mass = {MASS}
"""


def measurement(
    folder: Path, trial: Trial | Mapping[str, np.ndarray], keys: str = "", measured_on: str = MEASURED_ON
) -> Path:
    """Write a trial as id.sto, ik.mot and m.toml; keys: more lines of [moments]."""
    columns = trial.columns() if isinstance(trial, Trial) else trial
    time = {"time": columns["time"]}
    opensim(folder / "ik.mot", time | {"knee_angle_r": columns["knee"], "hip_flexion_r": columns["hip"]})
    names = {"knee_angle_r_moment": "knee_moment", "hip_flexion_r_moment": "hip_moment"}
    opensim(folder / "id.sto", time | {name: columns[column] for name, column in names.items()})
    if isinstance(trial, Trial) and "convention" not in keys and "extension" not in keys:
        keys += f'convention = "{trial.convention}"\n'
    path = folder / "m.toml"
    path.write_text(
        '[moments]\nfile = "id.sto"\nkinematics = "ik.mot"\nknee = "knee_angle_r_moment"\n'
        f'hip = "hip_flexion_r_moment"\n{keys}{measured_on}'
    )
    return path


def changed(trial: Trial, **columns: Callable[[np.ndarray], np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of a trial, some of them changed in one place."""
    recorded = trial.columns()
    return recorded | {name: change(recorded[name]) for name, change in columns.items()}


def with_convention(trial: Trial, name: str) -> Trial:
    """The same trial by another laboratory."""
    return replace(trial, convention=name)

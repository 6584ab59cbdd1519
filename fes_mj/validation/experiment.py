"""The experiment of docs/experiment.md: one rider's quadriceps, on a tricycle whose crank a motor holds.

What was measured weighs riders of the priors (muscles.identification): powers and torques are linear in the strength.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import is_text, read_toml
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import SIX_BARS, load_design
from fes_mj.linkage.turning import turning
from fes_mj.moments.measurement_file import read_tricycle
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.tables import load_table
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.identification import Candidates, weighed
from fes_mj.muscles.posterior import MEMBERS, WeighedRiders
from fes_mj.muscles.prior import prior_draws, priors
from fes_mj.muscles.pull import pull
from fes_mj.muscles.recovery import gains
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import TURN_ANGLES, Windows, activation
from fes_mj.validation.cranking import isometric

MODEL_ERROR = 0.05  # of the largest number of its kind: what the model misses even of a rider whom it knows
CRANKED = ("cadence_rpm", "on_deg", "off_deg", "power_W", "sd_W")
ISOMETRIC = ("hip_flexion_deg", "knee_flexion_deg", "torque_Nm", "sd_Nm")
_BLOCK = 100  # riders at once
_ENDS = (0.05, 0.5, 0.95)


@dataclass(frozen=True, eq=False)
class Experiment:
    """cranked, isometric: what was measured, shape (rows, CRANKED) and (rows, ISOMETRIC)."""

    files: tuple[Path, ...]
    tricycle: ReferenceTricycle
    cranked: FloatArray
    isometric: FloatArray

    @classmethod
    def read(cls, path: Path) -> Self:
        """Raises InputError naming file, line or key, value and what is allowed."""
        content = read_toml(path, "experiment")
        content.only(("experiment", "measured_on"))
        section, columns = content.section("experiment"), {"cranked": CRANKED, "isometric": ISOMETRIC}
        section.only(columns)
        section.require(columns, "it names a file of measured numbers (docs/experiment.md)")
        files = [
            path.parent / section.value(key, None, is_text, "the name of a file beside this one") for key in columns
        ]
        tables = list(map(_columns, files, columns.values()))
        return cls((path, *files), read_tricycle(content.section("measured_on")), *tables)

    @property
    def values(self) -> FloatArray:
        """Powers, then torques, shape (rows,)."""
        return np.concatenate([self.cranked[:, -2], self.isometric[:, -2]])

    @property
    def covariance(self) -> FloatArray:
        """Of what a rider's model would miss of them, shape (rows, rows)."""
        variances = (
            table[:, -1] ** 2 + (MODEL_ERROR * np.abs(table[:, -2]).max()) ** 2
            for table in (self.cranked, self.isometric)
        )
        return np.diag(np.concatenate([*variances]))

    @property
    def best_power(self) -> dict[float, float]:
        """Largest power over the windows, W, by cadence, rpm."""
        return {
            float(rpm): float(self.cranked[self.cranked[:, 0] == rpm, -2].max())
            for rpm in np.unique(self.cranked[:, 0])
        }

    def candidates(self, riders: Riders) -> Candidates:
        """What the experiment would give of riders, per strength of each group."""
        rows = len(self.values)
        by_strength = np.zeros((len(riders), rows, len(MUSCLE_GROUPS)))
        for start in range(0, len(riders), _BLOCK):
            block = slice(start, start + _BLOCK)
            by_strength[block, :, MUSCLE_GROUPS.index("quadriceps")] = self.seen(riders.taken(block))
        covariance = np.broadcast_to(self.covariance, (len(riders), rows, rows))
        return Candidates(riders, by_strength, np.zeros((len(riders), rows)), covariance)

    def seen(self, riders: Riders) -> FloatArray:
        """Powers and torques that these riders would give, shape (riders, rows)."""
        design, muscles = self.tricycle.design, anatomy().only("quadriceps")
        motion, top = kinematics.solve(design, TURN_ANGLES), np.degrees(turning(design).top_dead_centre)
        power = {rpm: pull(riders, motion, rpm * RPM, muscles).power[:1] for rpm in self.best_power}
        columns = []
        for rpm, on, off, *_ in self.cranked:
            windows = Windows(np.full((1, 1, 1), on), np.full((1, 1, 1), (off - on) % 360)).shifted(float(top))
            columns.append(np.mean(activation(windows, riders, rpm * RPM) * power[rpm], axis=-1)[0, :, 0])
        hip, knee = self.isometric[:, 0], self.isometric[:, 1]
        return np.concatenate([np.stack(columns, axis=1), isometric(riders, hip, knee, design.rider)], axis=1)


def _columns(path: Path, names: tuple[str, ...]) -> FloatArray:
    """The named columns of a table; errors, which stand last, above 0."""
    table = load_table(path, "experiment", names)
    columns = np.stack([table.column(name) for name in names], axis=1)
    if not columns.size or columns[:, -1].min() <= 0:
        raise InputError(f"{path}: {names[-1]} must be above 0 in every row, of which there must be one at least")
    return columns


def _spread(values: FloatArray) -> list[float]:
    return [float(value) for value in np.quantile(values, _ENDS)]


def _probabilities(riders: Riders) -> dict[str, dict[str, Any]]:
    """Gains of the six-bars over the traditional tricycle, all groups at the timing that is best in expectation."""
    ratios = gains(riders, [load_design(name) for name in SIX_BARS], load_design("trt"))
    above = {f"P(gain > {least})": least for least in (1.0, 1.25)}
    return {
        name: {"gain": _spread(ratio)} | {words: float(np.mean(ratio > least)) for words, least in above.items()}
        for name, ratio in zip(SIX_BARS, ratios, strict=True)
    }


def identified(experiment: Experiment, candidates: int = 1000, seed: int = 28) -> WeighedRiders:
    """Riders weighed by the experiment; candidates: of each stage (muscles.identification.weighed)."""
    random, name = np.random.default_rng(seed), str(next(iter(experiment.files), "experiment"))
    return weighed(experiment.candidates, experiment.values, random, candidates, name)


def judged(experiment: Experiment) -> dict[str, Any]:
    """What the experiment does to the probabilities of the gains, and to what is known of the rider."""
    before = Riders("prior", prior_draws(MEMBERS, np.random.default_rng(29)), np.zeros(MEMBERS))
    posterior = identified(experiment)
    after = posterior.members(MEMBERS)
    missed = (experiment.seen(after) - experiment.values) / np.sqrt(np.diag(experiment.covariance))
    return {
        "best_power_W": {f"{rpm:g}": power for rpm, power in experiment.best_power.items()},
        "riders_effective": posterior.effective,
        "misfit_rms": float(np.sqrt(np.mean(missed**2))),
        "before": _probabilities(before),
        "after": _probabilities(after),
        "quantities": {
            name: {"unit": priors()[name]["unit"], "before": _spread(column), "after": _spread(after.values[name])}
            for name, column in before.values.items()
        },
    }

"""What a file of a user's own joint moments holds: turns as they were measured, and the moments made of them."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.common.text import printable
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.variables import VARIABLES
from fes_mj.moments.averaging import (
    declared_power_sd,
    mean_of,
    turn_coefficients,
    weights_on,
    with_power_sd,
    without_spikes,
)
from fes_mj.moments.comparison import Comparison
from fes_mj.moments.conventions import Convention
from fes_mj.moments.files import CURVE_DEGREES, moments_of
from fes_mj.moments.joint_moments import COLUMNS, JointMoments
from fes_mj.moments.measured_turns import LARGEST_ANGLE, LARGEST_MOMENT, WHAT, Recording, bounded, measured_turns
from fes_mj.moments.measurement_file import Description
from fes_mj.moments.plausibility import cadence_agrees, comparisons, largest_gap, recorded_cadence
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.moments.tables import load_table
from fes_mj.moments.trial import in_order
from fes_mj.moments.turn import Turn
from fes_mj.moments.uncertainty import standard_deviation

_PLAIN = Convention(PerJoint(1.0, 1.0), PerJoint(1.0, 1.0))  # what the header of a plain file means


@dataclass(frozen=True, eq=False)
class Measurement:
    """What a file of moments holds: each turn as it was measured, and the moments that are made of them.

    comparisons: what the file says of itself beside what is declared. declared_sd: what the errors of tape measure and
    cadence have in power_sd, W.
    """

    turns: tuple[Turn, ...]
    moments: JointMoments
    comparisons: tuple[Comparison, ...] = ()
    declared_sd: float | None = None

    @classmethod
    def of(cls, moments: JointMoments) -> "Measurement":
        """Moments that are not a user's own."""
        return cls((Turn(moments.crank_angle, moments.knee, moments.hip),), moments)

    @property
    def power_sd(self) -> float | None:
        """Standard deviation of the mean power in the tricycle of the measurement, W; None for a single turn."""
        covariance = self.moments.covariance
        return None if covariance is None else standard_deviation(weights_on(self.moments.measured_on), covariance)

    def summary(self) -> dict[str, Any]:
        """What is understood of the file, as JSON names and units it."""
        moments = self.moments
        curves, cadence = moments.at(np.radians(CURVE_DEGREES)), moments.measured_on.cadence
        return {
            "knee_Nm": [curves.knee.min(), curves.knee.max()],
            "hip_Nm": [curves.hip.min(), curves.hip.max()],
            "turns": len(self.turns),
            "trials": len({turn.source for turn in self.turns}),
            "riders": len({turn.source[0] for turn in self.turns}),
            "samples": sum(len(turn.knee) for turn in self.turns),
            "largest_gap_deg": math.degrees(largest_gap(self.turns)),
            "power_mean_W": sum(moments.power_mean),
            "power_sd_W": self.power_sd,
            "power_declared_sd_W": self.declared_sd,
            "work_per_turn_J": sum(moments.power_mean) / turns_per_second(cadence),
            "cadence_rpm": cadence / RPM,
            "warnings": [misreading._asdict() for misreading in moments.misreadings],
            "plausibility": [comparison._asdict() for comparison in self.comparisons],
        }


def load_measurement(path: Path) -> Measurement:
    """Read a CSV with the header COLUMNS, crank angle from top dead centre, or a measurement file (.toml)."""
    if path.suffix.lower() == ".toml":
        return _measurement(path, measured_turns(Description.read(path)))
    turns = _plain_turns(path)
    degrees = np.concatenate([np.degrees(turn.crank_angle) for turn in turns])
    return _measurement(path, Recording(_PLAIN, PAPER_TRICYCLE, False, turns, degrees))


def _plain_turns(path: Path) -> list[Turn]:
    """The turns of a plain file."""
    table = load_table(path, WHAT)
    if table.header != [*COLUMNS]:
        raise InputError(
            f"{path}: the header is {','.join(table.header)!r}; of a plain file it must be {','.join(COLUMNS)!r}; "
            "other columns, units and zeros are described in a measurement file (.toml)"
        )
    limits = (LARGEST_ANGLE, LARGEST_MOMENT, LARGEST_MOMENT)
    angle, knee, hip = (bounded(table, column, limit) for column, limit in zip(COLUMNS, limits, strict=True))
    angle = np.radians(angle)
    return [Turn(angle[row], knee[row], hip[row]) for row in in_order(angle)]


def measured_files(path: Path) -> list[Path]:
    """The file itself and, of a measurement file, those that it names."""
    return [path, *Description.read(path).files] if path.suffix.lower() == ".toml" else [path]


def _measurement(path: Path, recording: Recording) -> Measurement:
    """Moments of one turn as they are; of several their mean, with the covariance of that mean."""
    for turn in recording.turns:
        if len(np.unique(np.mod(turn.crank_angle, 2 * np.pi))) < 2:
            count = f"{len(turn.knee)} row{'s' * (len(turn.knee) > 1)} of moments"
            raise InputError(f"{path}: {count} at one crank angle; at least 2 crank angles are needed")
    cleaned = [without_spikes(turn) for turn in recording.turns]
    turns, spikes = [turn for turn, _ in cleaned], sum(count for _, count in cleaned)
    cadence, measured_on = recorded_cadence(turns), recording.measured_on
    if cadence is not None and not (recording.cadence_known and cadence_agrees(turns, measured_on.cadence)):
        measured_on = _at_cadence(path, measured_on, cadence)
    declared_sd = None
    name, cadence_known = printable(path.stem), recording.cadence_known or cadence is not None
    if len(turns) > 1:
        rows = np.stack([turn_coefficients(turn) for turn in turns])
        weights = weights_on(measured_on)
        mean, covariance = mean_of(rows, [turn.source for turn in turns], weights)
        declared_sd = declared_power_sd(mean, measured_on, cadence is not None)
        covariance = with_power_sd(covariance, weights, declared_sd)
        moments = replace(
            moments_of(mean, name), covariance=covariance, measured_on=measured_on, cadence_known=cadence_known
        )
    else:
        (turn,) = turns
        moments = JointMoments(name, turn.crank_angle, turn.knee, turn.hip, None, measured_on, cadence_known)
    compared = tuple(comparisons(replace(recording, turns=turns), moments, spikes))
    misreadings = tuple(comparison.misreading for comparison in compared if not comparison.agrees)
    return Measurement(tuple(turns), replace(moments, misreadings=misreadings), compared, declared_sd)


def _at_cadence(path: Path, declared: ReferenceTricycle, recorded: float) -> ReferenceTricycle:
    """The tricycle at the recorded cadence, rad/s. Raises InputError for one that nobody pedals."""
    rpm, allowed = recorded / RPM, VARIABLES["cadence_rpm"]
    if not allowed.accepts(rpm):
        raise InputError(
            f"{path}: a turn lasts {60 / rpm:.4g} s by the column of the time, which is {rpm:.3g} rpm; it must be "
            f'{allowed.allowed}; is the time in ms (moments.time_unit = "ms")?'
        )
    return replace(declared, cadence=recorded)

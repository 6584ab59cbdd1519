"""When muscles are stimulated: the best windows of a stimulator, for a rider of whom only an ensemble is known.

A window has an on-angle and a width on a grid of 5 deg, and the stimulator's ramp at both ends. Power is linear in each
group's activation, and the activation by a window shifts with it; so the power of every window is a correlation.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.muscles.activation import periodic_activation, trapezium
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders

TURN_POINTS = 360  # crank angles of a turn
TURN_ANGLES = np.arange(TURN_POINTS) * (2 * np.pi / TURN_POINTS)
WINDOW_STEP = 5  # deg, of on-angles and widths
DUTY = 100 / 360  # largest share of the turn in which a group is stimulated
DUTIES = (
    f"a share of the turn (degrees divided by 360), from {WINDOW_STEP / 360:.3f}, a window of {WINDOW_STEP} deg, "
    "to 1, all of it"
)
LEAST_POWER_SHARE = 0.02  # of the expected power of all groups; for less a group is not worth its stimulation
_STARTS = TURN_POINTS // WINDOW_STEP
_MEMBERS = 100  # at once: the answers of more to every width leave the processor's cache


@dataclass(frozen=True, eq=False)
class Windows:
    """On-angle and width, deg of crank, of the stimulation of each group, 0 wide where there is none.

    Shape (groups, members or 1, designs or 1): common to all members, or each its own.
    """

    on: FloatArray
    width: FloatArray

    def at(self, crank_angle: FloatArray, ramp_angle: Any) -> FloatArray:
        """Stimulation in [0, 1] at crank angles of shape (members, designs, angles); the ramp in rad, (designs, 1)."""
        on, width = (np.radians(values)[..., None] for values in (self.on, self.width))
        return trapezium(crank_angle - on, width, ramp_angle)

    def of(self, member: int) -> "Windows":
        """Those of one of the members."""
        return self if self.on.shape[1] == 1 else Windows(self.on[:, [member]], self.width[:, [member]])

    def by_group(self, member: int = 0) -> dict[str, list[float] | None]:
        """[on, off] of one of the members on the one design by group, deg; None where a group is not stimulated."""
        windows = self.of(member)
        pairs = zip(windows.on[:, 0, 0], windows.width[:, 0, 0], strict=True)
        ends = ([float(on), float((on + width) % 360)] if width else None for on, width in pairs)
        return dict(zip(MUSCLE_GROUPS, ends, strict=True))

    def shifted(self, degrees: float) -> "Windows":
        """The same later in the turn."""
        return Windows((self.on + degrees) % 360, self.width)


def activation(windows: Windows, riders: Riders, cadence: Any) -> FloatArray:
    """Of each group over TURN_ANGLES, shape (groups, members, designs, angles); cadence: rad/s, or (designs, 1)."""
    cadence = np.reshape(cadence, (-1, 1))
    return responded(windows.at(TURN_ANGLES - cadence * riders["delay_s"], cadence * ramp()), riders, cadence)


def responded(stimulation: FloatArray, riders: Riders, cadence: FloatArray) -> FloatArray:
    """What muscles make of a stimulation, already delayed, shape (..., members, designs, angles)."""
    times = (2 * np.pi / cadence[:, 0], riders["rise_s"][..., 0], riders.fall[..., 0])
    return periodic_activation(stimulation, *times)


def is_duty(share: float) -> bool:
    """Whether a share of the turn is one of DUTIES."""
    return WINDOW_STEP / 360 <= share <= 1


def widths_up_to(duty: float) -> FloatArray:
    """Widths of windows, deg, no wider than this share of the turn, taken to the nearest degree: 0.222 means 80 deg.

    Raises InputError if there is none.
    """
    if not is_duty(duty):
        raise InputError(f"duty is {duty:g}; it must be {DUTIES}")
    return np.arange(WINDOW_STEP, np.round(360 * duty) + 1, WINDOW_STEP)


def best_windows(
    power: FloatArray, riders: Riders, cadence: Any, duty: float = DUTY, each_its_own: bool = False
) -> tuple[Windows, FloatArray]:
    """The windows, none wider than a share `duty` of the turn, with the largest power in expectation over the riders.

    And that power, W, of all groups, shape (members or 1, designs).

    power: W per activation, shape (groups, members, designs, angles), over TURN_ANGLES; cadence: as for `activation`.
    each_its_own: the best ones of every member instead, for one who has been measured completely.
    Raises InputError for a duty below that of a window of 5 deg, or above 1.
    """
    widths = widths_up_to(duty)
    blocks = [slice(first, first + _MEMBERS) for first in range(0, len(riders), _MEMBERS)]
    spectra = [_spectra(power[:, block], riders.taken(block), cadence, widths, each_its_own) for block in blocks]
    together = np.concatenate(spectra, axis=1)
    if not each_its_own:
        together = together.sum(axis=1, keepdims=True) / len(riders)
    # (groups, members, designs, widths, starts); the inverse divides by the number of starts
    expected = np.fft.irfft(together, _STARTS) * (_STARTS / TURN_POINTS**2)
    flat = expected.reshape(*expected.shape[:-2], -1)
    best, largest = flat.argmax(axis=-1), flat.max(axis=-1)
    worth = largest > LEAST_POWER_SHARE * np.maximum(largest, 0).sum(axis=0)
    width, start = np.unravel_index(best, expected.shape[-2:])
    windows = Windows(np.where(worth, WINDOW_STEP * start, 0.0), np.where(worth, widths[width], 0.0))
    return windows, (worth * largest).sum(axis=0)


def _spectra(power: FloatArray, riders: Riders, cadence: Any, widths: FloatArray, each_its_own: bool) -> ComplexArray:
    """Of the power of every window over its on-angle, a sum over the riders or of each.

    Shape (groups, members or 1, designs, widths, harmonics).
    """
    # in single precision, which tells windows apart by 1e-6 of the power
    single, cadence = np.float32, np.reshape(cadence, (-1, 1))
    since_on = (TURN_ANGLES - cadence * riders["delay_s"]).astype(single)
    tried = np.radians(widths).astype(single)[:, None, None, None]
    answers = responded(trapezium(since_on, tried, (cadence * ramp()).astype(single)), riders, cadence)
    # harmonics beyond half the number of starts have less than 1e-6 of the power, as both curves are continuous
    spectra = [np.fft.rfft(values)[..., : _STARTS // 2] for values in (answers, power.astype(single))]
    members = "m" if each_its_own else ""
    together = np.einsum(f"wmdk,gmdk->g{members}dwk", np.conj(spectra[0]), spectra[1], optimize=True)
    return np.asarray(together if each_its_own else together[:, None])

"""The stimulated muscles of a leg: whose group each is, its lengths over hip and knee flexion, its parameters."""

from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.design import Rider
from fes_mj.linkage.riders import boot_height
from fes_mj.muscles.geometry import Flexion, Surfaces

MUSCLE_GROUPS = ("quadriceps", "hamstrings", "gluteus")
ANATOMY_FILE = DATA / "muscles" / "gait2392.toml"


@dataclass(frozen=True, eq=False)
class Anatomy:
    """Muscles of a generic adult, in the order of the file; arrays of shape (muscles,).

    group: number in MUSCLE_GROUPS, ascending. lengths: m, of hip and knee flexion. force: N, largest isometric.
    optimal, slack: m, of fibre and tendon. pennation: rad, at the optimal length. segments: names of the rider's
    segments that each lies along. thigh, shank: m, of that adult. hip_deg, knee_deg: flexion with known lengths.
    """

    names: tuple[str, ...]
    group: IntArray
    lengths: Surfaces
    force: FloatArray
    optimal: FloatArray
    slack: FloatArray
    pennation: FloatArray
    segments: tuple[tuple[str, ...], ...]
    thigh: float
    shank: float
    hip_deg: tuple[float, float]
    knee_deg: tuple[float, float]

    @property
    def of_group(self) -> list[slice]:
        """The muscles of each group."""
        ends = np.searchsorted(self.group, np.arange(len(MUSCLE_GROUPS) + 1))
        return [slice(*pair) for pair in pairwise(ends)]

    @property
    def rectus(self) -> BoolArray:
        """Which muscle is the part of the quadriceps that passes the hip as well, shape (muscles,)."""
        two_joints = np.array([len(along) == 2 for along in self.segments])
        return np.asarray(two_joints & (self.group == MUSCLE_GROUPS.index("quadriceps")))

    def only(self, group: str) -> "Anatomy":
        """The muscles of one group."""
        rows = self.of_group[MUSCLE_GROUPS.index(group)]
        columns = ("names", "group", "force", "optimal", "slack", "pennation", "segments")
        lengths = Surfaces(self.lengths.coefficients[rows], self.lengths.degree)
        return replace(self, lengths=lengths, **{name: getattr(self, name)[rows] for name in columns})

    def length_scale(self, rider: Rider) -> FloatArray:
        """Of length, fibre and tendon alike, by the rider's segments per the adult's, shape (muscles, designs, 1).

        It leaves force and relative speed as they are: moment arms grow. A rider's shank reaches down to the pedal.
        """
        of_rider = {"thigh": rider.thigh, "shank": rider.shank - boot_height()}
        of_model = {"thigh": self.thigh, "shank": self.shank}
        scales = (
            sum(of_rider[part] for part in along) / sum(of_model[part] for part in along) for along in self.segments
        )
        return np.stack([np.atleast_2d(scale) for scale in np.broadcast_arrays(*scales)])

    def in_range(self, flexion: Flexion) -> BoolArray:
        """Whether lengths are known at every angle of a turn, the last axis of flexion."""
        ranges = ((flexion.hip, self.hip_deg), (flexion.knee, self.knee_deg))
        inside = [(np.radians(low) <= angle) & (angle <= np.radians(high)) for angle, (low, high) in ranges]
        return np.asarray(np.logical_and(*inside).all(axis=-1))

    def require_range(self, name: str, flexion: Flexion, advice: str = "move the seat, or use joint moments") -> None:
        """Raise InputError, naming the joint, where a motion leaves the angles for which lengths are known."""
        for joint, (low, high) in (("hip", self.hip_deg), ("knee", self.knee_deg)):
            angle = np.degrees(getattr(flexion, joint))
            if angle.min() < low or angle.max() > high:
                raise InputError(
                    f"{name}: the {joint} bends from {angle.min():.1f} to {angle.max():.1f} deg; muscle lengths are "
                    f"known from {low:g} to {high:g} deg of flexion: {advice}"
                )

    def changed_arms(self, flexion: Flexion) -> list[str]:
        """Muscles, each with the joint, whose moment arm about it changes its sign within these angles."""
        values = self.lengths.at(flexion)
        changed = []
        for joint, arms in (("hip", values.by_hip), ("knee", values.by_knee)):
            ends = arms.reshape(len(self.names), -1)
            crossed = np.abs(ends).max(axis=1) > 0
            both = crossed & (ends.min(axis=1) < 0) & (ends.max(axis=1) > 0)
            changed += [f"{self.names[row]} at the {joint}" for row in np.flatnonzero(both)]
        return changed


@cache
def anatomy(path: Path = ANATOMY_FILE) -> Anatomy:
    """The muscles of a file that tools/make_muscles.py wrote; by default those that ship."""
    content = read_toml(path, "muscles").content
    muscles, adult = content["muscle"], content["adult"]

    def column(key: str) -> FloatArray:
        return np.array([row[key] for row in muscles.values()])

    return Anatomy(
        names=tuple(muscles),
        group=np.array([MUSCLE_GROUPS.index(row["group"]) for row in muscles.values()]),
        lengths=Surfaces(column("coefficients_m"), int(adult["degree"])),
        force=column("max_isometric_force_N"),
        optimal=column("optimal_fibre_length_m"),
        slack=column("tendon_slack_length_m"),
        pennation=column("pennation_rad"),
        segments=tuple(tuple(row["segments"]) for row in muscles.values()),
        thigh=adult["thigh_m"],
        shank=adult["shank_m"],
        hip_deg=tuple(adult["hip_flexion_deg"]),
        knee_deg=tuple(adult["knee_flexion_deg"]),
    )

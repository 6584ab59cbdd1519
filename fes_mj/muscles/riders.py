"""What is known of a rider's muscles: an ensemble, a member of which is a rider who may have been the one measured."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA
from fes_mj.common.writing import replacing
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.variables import component, replaced
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, Anatomy
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.prior import priors

SHIPPED = DATA / "muscles"
_TRICYCLE = ("R1x", "R1y", "R2", "R6", "seat_angle", "thigh", "shank", "mass")  # and the cadence, rad/s
_WRITES = "`fes_mj moments TRIAL --fit-muscles -o RIDER.npz` writes one"


@dataclass(frozen=True, eq=False, repr=False)
class Riders(Brief):
    """Riders by what is not known of them, each quantity of shape (members,), in the unit of data/muscles/priors.toml.

    likelihood: logarithm of the density of the member and of what was measured, up to a constant, shape (members,).
    measured_on: the tricycle of the measurement, from which its windows and moments are taken elsewhere.
    """

    name: str
    values: Mapping[str, FloatArray]
    likelihood: FloatArray
    measured_on: ReferenceTricycle = PAPER_TRICYCLE

    @property
    def brief(self) -> str:
        return f"{self.name}: {len(self)} who may have been measured"

    def __len__(self) -> int:
        return len(self.likelihood)

    def __getitem__(self, quantity: str) -> FloatArray:
        """Of every member, shape (members, 1, 1), to stand beside designs and crank angles."""
        return self.values[quantity][:, None, None]

    def taken(self, rows: Any) -> "Riders":
        """The members at `rows`, an index array, a mask or a slice."""
        values = {quantity: column[rows] for quantity, column in self.values.items()}
        return replace(self, values=values, likelihood=self.likelihood[rows])

    @property
    def most_probable(self) -> "Riders":
        """The one member with the largest density."""
        return self.taken([int(np.argmax(self.likelihood))])

    def flexion(self, motion: Motion) -> Flexion:
        """Hip and knee flexion along a motion, rad: the hip's of every member, shape (members, designs, angles)."""
        return Flexion.along(motion, np.radians(self["hip_offset_deg"]))

    def flexion_each(self, motion: Motion) -> Flexion:
        """The same of every member along the motion of a design of its own, shape (members, 1, angles)."""
        return Flexion.of_each(motion, np.radians(self["hip_offset_deg"]))

    @property
    def fall(self) -> FloatArray:
        """Time constant of the fall of activation, s, shape (members, 1, 1)."""
        return self["rise_s"] * self["fall_per_rise"]

    def strength(self, anatomy: Anatomy) -> FloatArray:
        """Of each muscle per that of the anatomy, shape (muscles, members, 1, 1)."""
        groups = np.stack([self[f"{group}_strength"] for group in MUSCLE_GROUPS])
        rectus = anatomy.rectus[:, None, None, None]
        return np.asarray(groups[anatomy.group] * np.where(rectus, self["rectus_recruitment"], 1.0))

    def slack(self, anatomy: Anatomy) -> FloatArray:
        """Slack length of each tendon, m, shape (muscles, members, 1, 1): longer fibres belong to a shorter tendon."""
        shift = np.stack([self[f"{group}_fibre_shift"] for group in MUSCLE_GROUPS])[anatomy.group]
        return np.asarray(anatomy.slack[:, None, None, None] - shift * anatomy.optimal[:, None, None, None])

    def windows(self) -> FloatArray:
        """[on, width] of each group in the measurement, deg of crank from the most bent knee; (groups, members, 2)."""
        ends = ("on_deg", "width_deg")
        return np.stack([np.stack([self.values[f"{group}_{end}"] for end in ends], axis=-1) for group in MUSCLE_GROUPS])

    def save(self, path: Path) -> None:
        """Write all members, and the tricycle of the measurement, to an .npz file."""
        design, cadence = self.measured_on.design, self.measured_on.cadence
        tricycle = np.array([*(component(design, name) for name in _TRICYCLE), cadence])
        with replacing(path) as temporary:
            np.savez_compressed(
                temporary, allow_pickle=False, likelihood=self.likelihood, measured_on=tricycle, **self.values
            )


def load_riders(source: str | Path) -> Riders:
    """The shipped ensemble of a rider group ("p1p2", "p1p3"), or one of a file that Riders.save wrote.

    Raises InputError for a file that is none.
    """
    shipped = SHIPPED / f"{source}.npz"
    return _shipped(shipped) if shipped.is_file() else _read(Path(source))


@cache
def _shipped(path: Path) -> Riders:
    return replace(_read(path), measured_on=PAPER_TRICYCLE)


def _read(path: Path) -> Riders:
    import zlib
    from zipfile import BadZipFile

    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            columns = {name: np.asarray(stored[name], float) for name in ("likelihood", "measured_on", *priors())}
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; {_WRITES}") from None
    except (OSError, ValueError, KeyError, EOFError, BadZipFile, zlib.error):
        raise InputError(f"{path}: no ensemble of riders; {_WRITES}") from None
    sizes = {name: column.shape for name, column in columns.items() if name != "measured_on"}
    whole = len(set(sizes.values())) == 1 and columns["likelihood"].ndim == 1 and columns["likelihood"].size > 0
    finite = all(np.isfinite(column).all() for column in columns.values())
    if not (whole and finite and columns["measured_on"].shape == (len(_TRICYCLE) + 1,)):
        raise InputError(f"{path}: an ensemble of riders with columns that do not fit each other; {_WRITES}")
    *numbers, cadence = map(float, columns["measured_on"])
    design = replaced(PAPER_TRICYCLE.design, dict(zip(_TRICYCLE, numbers, strict=True)))
    quantities = {name: columns[name] for name in priors()}
    return Riders(path.stem, quantities, columns["likelihood"], ReferenceTricycle(design, cadence))

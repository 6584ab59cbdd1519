"""A user's trial: what its joint moments say of the rider's muscles, and whether muscles explain them at all."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.moments.fourier import HARMONICS, TERMS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.chains import moved
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.identification import DOUBTS, STRENGTHS, WHOLE, Candidates, Measured, identify_riders
from fes_mj.muscles.posterior import MEMBERS
from fes_mj.muscles.prior import prior_draws, priors
from fes_mj.muscles.riders import Riders

ORDERS = 4  # harmonics that are fitted; in finer ones the largest residual has less than 0.1 N m to make good a model
ERROR = 0.25  # N m, of every coefficient, besides the scatter of the turns: of a model that knows no finer detail
LEAST_EXPLAINED = 0.8  # of the variance of the moments
IDENTIFIED = 0.9  # standard deviation per the prior's, above which nothing was learned of a quantity
ENDS = (0.05, 0.5, 0.95)


class Quantity(NamedTuple):
    """What was known of a quantity before the measurement and after: quantiles ENDS, and how far it narrowed."""

    name: str
    unit: str
    prior: list[float]
    posterior: list[float]
    narrowed_to: float

    @property
    def identified(self) -> bool:
        return self.narrowed_to <= IDENTIFIED


def quantities(riders: Riders) -> list[Quantity]:
    """Prior beside posterior of everything that is not known of riders."""
    before = prior_draws(20_000, np.random.default_rng(2))

    def quantity(name: str) -> Quantity:
        prior, posterior = ([float(end) for end in np.quantile(of[name], ENDS)] for of in (before, riders.values))
        narrowed = float(riders.values[name].std() / before[name].std())
        return Quantity(name, priors()[name]["unit"], prior, posterior, narrowed)

    return [quantity(name) for name in priors()]


def measured_moments(moments: JointMoments, orders: int = ORDERS) -> Measured:
    """The moments of a trial as measured numbers: Fourier coefficients up to a harmonic.

    Raises InputError for moments without a covariance, or joints beyond the range of the muscles' lengths.
    """
    if moments.covariance is None:
        raise InputError(
            f"{moments.name}: a single turn does not say how sure its moments are; muscles are fitted to two turns or "
            "more"
        )
    motion = kinematics.solve(moments.measured_on.design)
    offsets = np.radians(np.array(priors()["hip_offset_deg"]["even"]))[:, None]
    anatomy().require_range(
        f"{moments.name}, with a pelvis that may tilt",
        Flexion.along(motion, offsets),
        "are seat_angle and R1 of measured_on as they were?",
    )
    one = [*range(orders + 1), *range(HARMONICS + 1, HARMONICS + 1 + orders)]
    rows = np.array([*one, *(TERMS + row for row in one)])
    values = np.concatenate([*moments.coefficients])
    covariance = moments.covariance[np.ix_(rows, rows)] + ERROR**2 * np.eye(len(rows))
    return Measured(np.eye(2 * TERMS)[rows], np.full(len(rows), WHOLE), values[rows], covariance, moments.measured_on)


def explained_share(riders: Riders, moments: JointMoments) -> float:
    """Of the variance of a trial's moments: by muscles, passive moments, and a residual no larger than the riders'."""
    whole = measured_moments(moments, HARMONICS)
    seen = Candidates.of(riders, whole)
    strengths = np.stack([riders.values[name] for name in STRENGTHS], axis=-1)
    missed = whole.values - seen.explained - np.einsum("nrg,ng->nr", seen.by_strength, strengths)
    covariance, size = whole.residual.covariance, riders.values["residual_sd_Nm"]
    residual = np.einsum(
        "n,rs,ns->nr", size**2, covariance, np.linalg.solve(seen.covariance, missed[..., None])[..., 0]
    )
    mean_square = np.where(np.arange(2 * TERMS) % TERMS == 0, 1.0, 0.5)
    root = np.sqrt(residual**2 @ mean_square / 2)  # of both joints
    unexplained = missed - residual * np.minimum(1, size / root)[:, None]
    varies = mean_square * (np.arange(2 * TERMS) % TERMS > 0)
    return float(1 - np.median(unexplained**2 @ mean_square) / (whole.values**2 @ varies))


def fit_muscles(
    moments: JointMoments, candidates: int, steps: int, seed: int = 0, advance: Callable[[int], None] = lambda _: None
) -> tuple[Riders, float]:
    """Riders who may have given a trial's moments, and the share of its variance that they explain.

    candidates: by which the posterior is found (identify_riders); steps: of every rider in it (chains.moved); advance:
    called with the number of riders just looked at. Raises InputError as measured_moments, and where that share is
    below LEAST_EXPLAINED.
    """
    measured, random = measured_moments(moments), np.random.default_rng(seed)
    members = identify_riders(measured, random, candidates, moments.name, advance).flattened().members(MEMBERS)
    riders = moved(members, measured, random, steps, advance)
    share = explained_share(riders, moments)
    if share < LEAST_EXPLAINED:
        raise InputError(
            f"{moments.name}: muscles, passive moments and a residual of its own size explain "
            f"{100 * max(share, 0):.0f} % of the variance of these moments; {100 * LEAST_EXPLAINED:.0f} % are needed: "
            f"{DOUBTS}"
        )
    return riders, share

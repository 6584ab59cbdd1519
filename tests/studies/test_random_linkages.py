"""300 linkages of any shape, any seat and coupler angle: which turn, and what they deliver, by a second statics."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.common.checks import LEAST_POWER, definitions
from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.assembly import LEAST_CLEARANCE
from fes_mj.linkage.design import Design, Linkage, Rider
from fes_mj.linkage.turning import LARGEST_SWING
from fes_mj.moments.joint_moments import JointMoments
from studies.random_linkages import random_design, random_moments
from tests.reference import POINTS, mean_power, turn

LIMIT = definitions()["mean_power"].limit


def any_linkage(rng: np.random.Generator) -> Design:
    """Some turn and some do not; seats face anywhere."""
    uniform, kind = rng.uniform, str(rng.choice(["trt", "crt", "cdt"]))
    ground = uniform(0.3, 1.0) * np.exp(1j * uniform(2.3, 4.0))
    linkage = Linkage(kind, complex(ground), uniform(0.03, 0.2), uniform(-0.05, 0.15))
    if kind != "trt":
        arm = complex(uniform(0.2, 0.5) * np.exp(1j * uniform(2.4, 3.9)))
        rest = (arm, uniform(0, 0.2), uniform(0.2, 0.5), uniform(0.08, 0.3))
        linkage = Linkage(kind, linkage.ground, linkage.crank, linkage.foot, *rest, uniform(-math.pi, math.pi))
    rider = Rider(uniform(0.4, 0.6), uniform(0.4, 0.6), uniform(45, 110))
    seat, branch = uniform(-math.pi, 1.5 * math.pi), str(rng.choice(["left", "right"]))
    changes = {"gear_ratio": uniform(0.5, 3), "seat_angle": seat} | ({"branch": branch} if kind != "trt" else {})
    return Design("any", linkage, rider).with_linkage(**changes)


@pytest.mark.long
def test_300_linkages() -> None:
    rng, seen = np.random.default_rng(7), {"turns": 0, "does not turn": 0, "never enters": 0}
    while sum(seen.values()) < 300:
        design = random_design(rng) if rng.random() < 0.4 else any_linkage(rng)
        moments = random_moments(rng) if rng.random() < 0.5 else fes_mj.load_moments()
        seen[_verdict(design, moments)] += 1
    assert min(seen.values()) > 15, seen


def _verdict(design: Design, moments: JointMoments) -> str:
    """What the package says, after it was compared with the reference."""
    motion = turn(design)
    swing = np.ptp(motion["hip"])
    resolution = 1e-6  # m, of a search on a grid: what lies closer to the limit is not compared
    refusal: InputError | None = None
    try:
        result = fes_mj.quasi_static(design, moments)
    except InputError as error:
        refusal = error
    if isinstance(refusal, AssemblyError):
        assert motion["margin"] < LEAST_CLEARANCE + resolution or swing > LARGEST_SWING - 10 / POINTS, design
        return "does not turn"
    assert motion["margin"] > LEAST_CLEARANCE - resolution, design
    power, gross, enters = mean_power(design, moments, motion)
    assert enters == (refusal is None), (refusal, design)
    if refusal:
        return "never enters"
    assert result.power_mean == pytest.approx(power, abs=LIMIT * gross), design
    for joint, ends in result.joint_range_deg.items():
        offset = 360 * round((ends[0] - np.degrees(motion[joint].min())) / 360)  # the same angle, a turn apart
        reference = [np.degrees(motion[joint].min()) + offset, np.degrees(motion[joint].max()) + offset]
        assert ends == pytest.approx(reference, abs=0.05), design
    return "turns"


@pytest.mark.long
@pytest.mark.parametrize("seed", range(30))
def test_the_simulated_mean_power_is_the_references(seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    design, moments = random_design(rng, nearest=1e-3), random_moments(rng)
    power, gross, _ = mean_power(design, moments, turn(design))
    case = Case(design, moments)
    assert case.agrees, [check for check in case.checks if not check.ok]
    assert case.simulation.power_mean == pytest.approx(power, abs=2 * LIMIT * max(gross, LEAST_POWER))

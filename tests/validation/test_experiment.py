"""The experiment of docs/experiment.md: its file, and riders who are known."""

import re
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.muscles.power import muscle_turn
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.recovery import gains
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import Windows
from fes_mj.validation.experiment import MODEL_ERROR, Experiment, identified

PAGE = Path(__file__).parents[2] / "docs" / "experiment.md"


@pytest.fixture
def written(tmp_path: Path) -> Path:
    """The files of the page."""
    for content in re.findall(r"```\w+\n(# \S+\n.*?)```", PAGE.read_text(), re.DOTALL):
        (tmp_path / content.split("\n")[0][2:]).write_text(content)
    return tmp_path / "experiment.toml"


def riders(count: int, seed: int) -> Riders:
    return Riders("truth", prior_draws(count, np.random.default_rng(seed)), np.zeros(count))


def asked(plan: Experiment, rider: Riders, random: np.random.Generator) -> Experiment:
    """The same experiment on a rider who is known, with errors of its own."""
    seen = plan.seen(rider)[0] + random.multivariate_normal(np.zeros(len(plan.values)), plan.covariance)
    cranked, isometric = plan.cranked.copy(), plan.isometric.copy()
    cranked[:, -2], isometric[:, -2] = np.split(seen, [len(cranked)])
    return Experiment(plan.files, plan.tricycle, cranked, isometric)


def test_the_files_of_the_page_are_read(written):
    experiment = Experiment.read(written)
    assert experiment.cranked.shape == (15, 5)
    assert experiment.isometric.shape == (10, 4)
    assert experiment.tricycle.design.linkage.crank == PAPER_TRICYCLE.design.linkage.crank
    assert experiment.best_power == {30.0: 12.5, 60.0: 18.1, 96.0: 13.9}
    assert np.sqrt(experiment.covariance[0, 0]) == pytest.approx(np.hypot(0.5, 18.1 * MODEL_ERROR))


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("experiment.toml", "cranked =", "crancked =", "unknown key experiment.crancked"),
        ("cranked.csv", "30,280,20,-1.4,0.5", "30,280,20,-1.4,0", "sd_W must be above 0"),
        ("isometric.csv", "torque_Nm", "torque", "torque_Nm"),
        ("experiment.toml", "R2 = 0.15", "R2 = 0.9", "measured_on"),
    ],
)
def test_a_wrong_file_is_refused_with_what_is_wrong(written, file, old, new, said):
    path = written.parent / file
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(InputError, match=re.escape(said)):
        Experiment.read(written)


def test_what_riders_would_give_is_their_turns_power(written):
    experiment, some = Experiment.read(written), riders(3, 2)
    rpm, on, off, *_ = experiment.cranked[7]
    top = np.degrees(PAPER_TRICYCLE.top_dead_centre)
    width = np.array([(off - on) % 360, 0, 0])[:, None, None]
    turn = muscle_turn(some, PAPER_TRICYCLE.design, rpm * np.pi / 30, Windows(np.full((3, 1, 1), on + top), width))
    assert experiment.seen(some)[:, 7] == pytest.approx(turn.power_mean[:, 0])


def test_numbers_are_linear_in_the_strength(written):
    experiment, some = Experiment.read(written), riders(2, 3)
    unit = Riders("unit", dict(some.values) | {"quadriceps_strength": np.ones(2)}, np.zeros(2))
    by_strength = experiment.candidates(unit).by_strength
    assert by_strength[..., 0] * some.values["quadriceps_strength"][:, None] == pytest.approx(experiment.seen(some))
    assert np.all(by_strength[..., 1:] == 0)


@pytest.mark.long
def test_riders_who_are_known_are_recovered(written):
    """Intervals of 90 % hold D1's true gain, under the timing that is then best, and are narrower than the prior's."""
    plan, random, d1, trt = Experiment.read(written), np.random.default_rng(11), load_design("d1"), load_design("trt")
    prior, held = np.ptp(np.quantile(gains(riders(100, 4), [d1], trt)[0], (0.05, 0.95))), []
    for seed in (1, 2, 3):
        known = riders(1, seed)
        members = identified(asked(plan, known, random), candidates=300).members(100)
        low, high = np.quantile(gains(members, [d1], trt)[0], (0.05, 0.95))
        held.append(low <= gains(members, [d1], trt, actual=known)[0, 0] <= high)
        assert high - low < 0.8 * prior
    assert sum(held) >= 2  # 97 % probable if the intervals are right

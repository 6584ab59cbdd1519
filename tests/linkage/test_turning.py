"""Whether linkages turn, what is said of those that do not, and where a turn begins."""

from dataclasses import replace

import numpy as np
import pytest

from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.linkage.assembly import LEAST_CLEARANCE, clearances
from fes_mj.linkage.design import Design, Linkage, Rider
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import joint_angles, positions
from fes_mj.linkage.turning import turning
from fes_mj.moments.files import load_moments
from fes_mj.statics.cycles import cycles
from fes_mj.statics.work_table import WorkTable


def test_what_cannot_close_is_named_with_its_crank_angle() -> None:
    """R2 of the printed CRT R2: longest reach 0.53 m, needed 0.5301 m when the crank points away from the pivot."""
    printed = Design("r2", Linkage("crt", -0.62 + 0.32j, 0.04, 0.08, -0.49 + 0.01j, 0.15, 0.44, 0.09))
    with pytest.raises(AssemblyError, match=r"r2: rocker and coupler.* 178.8 deg.*0\.5301 m.*0\.102 mm"):
        turning(printed)
    far = Design("far", Linkage("trt", -1.0 - 0.4j, 0.15, 0.069))
    with pytest.raises(AssemblyError, match=r"far: thigh and shank.* 20[12]\.\d deg"):
        turning(far)


@pytest.mark.parametrize("short", [5e-7, 1e-5, 0.9e-4])
@pytest.mark.parametrize("kind", ["stretched", "folded"])
def test_what_is_too_close_to_a_dead_centre_is_refused_by_name(kind: str, short: float) -> None:
    """Rocker and coupler of D1, shortened until they lack so much, or have no more than that to spare."""
    d1 = load_design("d1")
    pivot, crank = abs(d1.linkage.pivot_to_crank), d1.linkage.crank
    for margin, said in ((-short, "mm lack"), (short, "0.1 mm")):
        if kind == "stretched":
            changed = replace(d1.linkage, coupler=pivot + crank - d1.linkage.rocker + margin)
        else:
            changed = replace(d1.linkage, coupler=pivot - crank + d1.linkage.rocker - margin)
        design = replace(d1, linkage=changed)
        assert clearances(design)[0].margin[0] == pytest.approx(margin, abs=1e-12)
        with pytest.raises(AssemblyError, match=rf"d1: rocker and coupler .* deg: .*{said}"):
            turning(design)


def test_a_thigh_that_turns_right_round_is_refused() -> None:
    round_the_hip = Design("around", Linkage("trt", 0.05 + 0j, 0.3, 0.0), Rider(0.3, 0.3))
    with pytest.raises(AssemblyError, match=r"around: the thigh.* 3[0-9][0-9] deg"):
        turning(round_the_hip)


def test_it_is_established_once_for_equal_designs_and_never_for_a_batch() -> None:
    d1 = load_design("d1")
    assert turning(replace(d1, linkage=replace(d1.linkage))) is turning(d1)
    assert turning(replace(d1, name="other")) is not turning(d1)
    with pytest.raises(InputError, match=r"d1: a batch of designs; fes_mj\.statics\.cycles\.cycles"):
        turning(d1.with_rider(mass=np.array([[60.0], [90.0]])))


def test_a_batch_turns_where_its_designs_do() -> None:
    """Legs around the shortest and longest that reach the pedal of R1 and D2, those within micrometres included."""
    random, table = np.random.default_rng(3), WorkTable.of(load_moments())
    for name in ("trt", "r1", "d2"):
        design = load_design(name)
        reach = clearances(design)[-1].margin[0]
        shorter = reach - np.concatenate([random.uniform(-0.01, 0.01, 40), LEAST_CLEARANCE + 1e-6 * np.arange(-3, 4)])
        batch = design.with_rider(thigh=design.rider.thigh - shorter[:, None])
        turns = [_turns(design.with_rider(thigh=float(thigh))) for thigh in batch.rider.thigh[:, 0]]
        assert cycles(batch, table).turns.tolist() == turns
        assert 10 < sum(turns) < 40


def _turns(design: Design) -> bool:
    try:
        turning(design)
    except AssemblyError:
        return False
    return True


def test_top_dead_centre_is_where_the_leg_is_bent_most() -> None:
    """In closed form for the four-bar, by a fine search for the others."""
    trt = load_design("trt")
    assert turning(trt).top_dead_centre == pytest.approx(np.angle(-trt.linkage.crank_centre) % (2 * np.pi))
    turn = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    for name in ("r1", "r2", "d1", "d2"):
        design = load_design(name)
        top = turning(design).top_dead_centre
        knee, least = (joint_angles(design, positions(design, at)).knee for at in (turn, np.array([top])))
        assert abs(top - turn[knee.argmin()]) < 1e-3  # R2's minimum is flat
        assert least[0] <= knee.min() + 1e-12
        after = turning(design).degrees_from_top(np.array([turning(design).top_dead_centre + 1e-9, 0.0]))
        assert after == pytest.approx([0, -np.degrees(turning(design).top_dead_centre) % 360], abs=1e-6)

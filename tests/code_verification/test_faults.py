"""Every injected fault is noticed by the check that is there for it, and leaves nothing behind."""

import inspect

import pytest

import fes_mj
from fes_mj import mjcf, statics, torque
from fes_mj.checks import criteria
from fes_mj.paper.printed import table1
from fes_mj.verification.case import Case
from fes_mj.verification.catalogue import FAULTS
from fes_mj.verification.faults import Fault, inject, injected, passing
from fes_mj.verification.suite import FULL, verify


@pytest.fixture(scope="module")
def case() -> Case:
    design = fes_mj.load_design("d1")
    return Case(design, fes_mj.load_moments("p1p2"), design.linkage.cadence, table1()["d1"])


@pytest.fixture(scope="module")
def baseline(case: Case) -> dict[str, bool]:
    return passing(case)


def test_the_catalogue_is_large_enough_and_explained() -> None:
    assert len(FAULTS) >= 20
    assert len({fault.name for fault in FAULTS}) == len(FAULTS)
    assert {fault.guard for fault in FAULTS} <= set(criteria())
    assert all(fault.mistake and (fault.patches or fault.edit) for fault in FAULTS)


def test_everything_holds_without_a_fault(baseline: dict[str, bool]) -> None:
    assert [name for name, ok in baseline.items() if not ok] == []


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_the_guard_notices(fault: Fault, case: Case, baseline: dict[str, bool]) -> None:
    verdict = inject(fault, case, baseline)
    assert verdict.caught
    assert verdict.guarded, [each.name for each in verdict.failed]
    assert all(baseline[each.name] for each in verdict.failed)
    assert verdict.first is not None
    assert verdict.first.factor > 1


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_is_put_back(fault: Fault) -> None:
    before = [vars(patch.owner)[patch.attribute] for patch in fault.patches]
    with injected(fault):
        pass
    with pytest.raises(KeyboardInterrupt), injected(fault):
        raise KeyboardInterrupt
    assert [vars(patch.owner)[patch.attribute] for patch in fault.patches] == before


def test_a_fault_reaches_every_module_that_imported_the_original() -> None:
    from fes_mj import inverse_dynamics
    from fes_mj.verification import references

    fault = next(fault for fault in FAULTS if fault.name == "map_by_crank_angle")
    original = statics.joint_moments
    with injected(fault):
        assert statics.joint_moments is not original
        assert inverse_dynamics.joint_moments is statics.joint_moments
        assert references.joint_moments is statics.joint_moments
    assert inverse_dynamics.joint_moments is references.joint_moments is statics.joint_moments is original


def test_all_faults_together_leave_the_suite_as_it_was(case: Case, baseline: dict[str, bool]) -> None:
    sources = [inspect.getsource(module) for module in (mjcf, statics, torque)]
    for fault in FAULTS:
        with injected(fault):
            pass
    assert passing(case) == baseline
    assert [inspect.getsource(module) for module in (mjcf, statics, torque)] == sources


def test_a_fault_that_no_check_can_see_is_reported_as_such(case: Case, baseline: dict[str, bool]) -> None:
    harmless = Fault("none", "nothing at all", "mean_power", edit=lambda design: design)
    verdict = inject(harmless, case, baseline)
    assert not verdict.caught
    assert verdict.as_json()["check"] is None


def test_the_suite_measures_every_registered_check(case: Case) -> None:
    from fes_mj.verification.suite import benchmarks

    names = {each.name for each in verify(case, FULL)} | {each.name for each in benchmarks()}
    assert names == set(criteria())

"""Every injected fault is noticed by the check that is there for it, and leaves the case it was put into alone."""

from pathlib import Path

import pytest

from fes_mj.crosscheck.pipeline import Pipeline
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.faults import Fault, inject, passing
from fes_mj.verification.mistakes import faults
from fes_mj.verification.suite import QUICK_CHECKS, ride_checks, two_leg_checks, verify
from tests.verification.conftest import case_of

ROOT = Path(__file__).parents[2]
SHARP = 3  # times the limit of at least one check
OF_MUSCLES = [fault for fault in faults() if fault.drive == "muscles"]
OF_MOMENTS = [fault for fault in faults() if fault not in OF_MUSCLES]


@pytest.fixture(scope="module")
def baseline(case: VerificationCase) -> dict[str, bool]:
    return passing(case)


def test_everything_holds_without_a_fault(baseline: dict[str, bool]) -> None:
    assert [name for name, ok in baseline.items() if not ok] == []


@pytest.mark.long
@pytest.mark.parametrize("fault", OF_MOMENTS, ids=lambda fault: fault.name)
def test_the_guard_notices(fault: Fault, case: VerificationCase, baseline: dict[str, bool]) -> None:
    assert_noticed(fault, case, baseline)


@pytest.fixture(scope="module")
def muscle_baseline(muscle_case: VerificationCase) -> dict[str, bool]:
    return {check.name: check.ok for check in verify(muscle_case, (*QUICK_CHECKS, two_leg_checks, ride_checks))}


@pytest.mark.long
@pytest.mark.parametrize("fault", OF_MUSCLES, ids=lambda fault: fault.name)
def test_the_guard_of_muscles_notices(
    fault: Fault, muscle_case: VerificationCase, muscle_baseline: dict[str, bool]
) -> None:
    assert all(muscle_baseline.values())
    assert_noticed(fault, muscle_case, muscle_baseline)


def assert_noticed(fault: Fault, case: VerificationCase, baseline: dict[str, bool]) -> None:
    assert fault.applies(case)
    detection = inject(fault, case, baseline)
    factors = {check.name: check.factor for check in detection.failed}
    assert {*fault.guards} <= factors.keys()
    assert all(baseline[name] for name in factors)
    assert max(factors.values()) >= SHARP


@pytest.mark.long
@pytest.mark.parametrize("source", ["trt", "r1", str(ROOT / "results" / "optimization" / "r2-caution-1.toml")])
def test_any_design_can_be_used(source: str) -> None:
    case = case_of(source)
    baseline = passing(case)
    assert all(baseline.values())
    for fault in OF_MOMENTS:
        if fault.applies(case):
            detection = inject(fault, case, baseline)
            assert detection.guarded, fault.name
            assert max(check.factor for check in detection.failed) >= SHARP, fault.name
        else:
            assert fault.edit or case.design.linkage.kind not in fault.kinds, fault.name


def test_a_fault_is_in_its_own_case_only(case: VerificationCase) -> None:
    before = case.static.power_mean, case.simulation.power_mean
    for fault in faults():
        faulty = fault.put_into(case)
        assert faulty.pipeline is not case.pipeline
        assert not {"steps", "static", "simulation", "checks"} & vars(faulty).keys()  # nothing measured is taken over
    assert case.pipeline is Pipeline
    again = VerificationCase(case.design, case.drive)
    assert (again.static.power_mean, again.simulation.power_mean) == before


def test_a_fault_that_no_check_can_see_is_reported_as_such(case: VerificationCase, baseline: dict[str, bool]) -> None:
    detection = inject(Fault("none", "nothing at all", ("mean_power",)), case, baseline)
    assert not detection.caught
    assert detection.as_json()["check"] is None

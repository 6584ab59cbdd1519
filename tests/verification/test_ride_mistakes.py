"""A fault in one solver of a ride is noticed by far, on any design."""

from pathlib import Path

import pytest

from fes_mj.verification.faults import inject
from fes_mj.verification.mistakes import faults
from fes_mj.verification.suite import ride_checks
from tests.verification.conftest import case_of

ROOT = Path(__file__).parents[2]
CLEARLY = 3  # times its limit is a guard's value at least
FAULTS = [fault for fault in faults() if fault.ride_steps]


@pytest.mark.long
@pytest.mark.parametrize(
    "source",
    [
        "d1",
        *("trt", "r1", "r2", "d2"),
        str(ROOT / "results" / "optimization" / "r2-caution-1.toml"),
    ],
)
def test_the_guard_notices_by_far(source: str) -> None:
    case = case_of(source)
    checks = [*ride_checks(case)]
    assert [check for check in checks if not check.ok] == []
    baseline = {check.name: True for check in checks}
    for fault in FAULTS:
        failed = inject(fault, case, baseline).failed
        for guard in fault.guards:
            assert max(check.factor for check in failed if check.name == guard) >= CLEARLY, fault.name


def test_every_check_of_a_ride_guards() -> None:
    """The rides' alone: the loop gap has guards of its own."""
    guards = {guard for fault in FAULTS for guard in fault.guards}
    assert guards == {"ride_verdict", "ride_speed", "ride_settled", "ride_power", "ride_energy"}

"""The catalogue of injected mistakes is complete."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fes_mj.common.checks import definitions
from fes_mj.common.reading import read_toml
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.faults import inject
from fes_mj.verification.mistakes import EDITS, MISTAKEN_STEPS, RIDE_STEPS, faults
from fes_mj.verification.muscle_mistakes import MUSCLE_STEPS
from fes_mj.verification.suite import ride_checks
from tests.verification.conftest import case_of, muscle_case_of

ROOT = Path(__file__).parents[2]


def test_every_fault_is_explained_and_made_in_one_way() -> None:
    rows = read_toml(ROOT / "fes_mj" / "data" / "faults.toml", "faults").content
    assert sorted([*MISTAKEN_STEPS, *EDITS, *RIDE_STEPS, *MUSCLE_STEPS]) == sorted(rows)
    assert definitions().keys() >= GUARDS


GUARDS = {guard for fault in faults() for guard in fault.guards}
PROVED = [name for name, definition in definitions().items() if definition.kind != "benchmark"]


@pytest.mark.parametrize("name", PROVED)
def test_every_check_that_is_no_benchmark_guards_against_a_fault(name: str) -> None:
    """That guards notice is test_faults' to say."""
    assert name in GUARDS


CLEARLY = 3  # times its limit is a guard's value at least
RIDE_FAULTS = [fault for fault in faults() if fault.ride_steps]


@pytest.mark.long
@pytest.mark.parametrize(
    "source",
    [
        "d1",
        *("trt", "r1", "r2", "d2"),
        str(ROOT / "results" / "optimization" / "r2-caution-1.toml"),
    ],
)
@pytest.mark.parametrize("made", [case_of, muscle_case_of], ids=["moments", "muscles"])
def test_the_guard_of_a_ride_notices_by_far(made: Callable[[str], VerificationCase], source: str) -> None:
    case = made(source)
    checks = [*ride_checks(case)]
    assert [check for check in checks if not check.ok] == []
    baseline = {check.name: True for check in checks}
    for fault in [fault for fault in RIDE_FAULTS if fault.applies(case)]:
        failed = inject(fault, case, baseline).failed
        for guard in fault.guards:
            assert max(check.factor for check in failed if check.name == guard) >= CLEARLY, fault.name


def test_every_check_of_a_ride_guards() -> None:
    """The rides' alone: the loop gap has guards of its own."""
    guards = {guard for fault in RIDE_FAULTS for guard in fault.guards}
    assert guards == {"ride_verdict", "ride_speed", "ride_settled", "ride_power", "ride_energy"}

"""The catalogue of injected mistakes is complete."""

from pathlib import Path

import pytest

from fes_mj.common.checks import definitions
from fes_mj.common.reading import read_toml
from fes_mj.verification.mistakes import EDITS, RIDE_STEPS, STEPS, faults

ROOT = Path(__file__).parents[2]


def test_every_fault_is_explained_and_made_in_one_way() -> None:
    rows = read_toml(ROOT / "fes_mj" / "data" / "faults.toml", "faults").content
    assert sorted([*STEPS, *EDITS, *RIDE_STEPS]) == sorted(rows)
    assert definitions().keys() >= GUARDS


GUARDS = {guard for fault in faults() for guard in fault.guards}
PROVED = [name for name, definition in definitions().items() if definition.kind != "benchmark"]


@pytest.mark.parametrize("name", PROVED)
def test_every_check_that_is_no_benchmark_guards_against_a_fault(name: str) -> None:
    """That guards notice is test_faults' to say."""
    assert name in GUARDS

"""The catalogue of injected mistakes is complete."""

from pathlib import Path

from fes_mj.common.checks import definitions
from fes_mj.common.reading import read_toml
from fes_mj.verification.mistakes import EDITS, STEPS, faults

ROOT = Path(__file__).parents[2]


def test_every_fault_is_explained_and_made_in_one_way() -> None:
    rows = read_toml(ROOT / "fes_mj" / "data" / "faults.toml", "faults").content
    assert STEPS.keys() | EDITS.keys() == rows.keys()
    assert not STEPS.keys() & EDITS.keys()
    assert {fault.guard for fault in faults()} <= set(definitions())

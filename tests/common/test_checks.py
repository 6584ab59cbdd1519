"""The registry of checks, and verdicts on values."""

import pytest

from fes_mj.common.checks import Check, check, definitions, find
from fes_mj.common.errors import InputError


def test_the_registry_is_complete() -> None:
    for definition in definitions().values():
        assert definition.limit >= 0
        assert (
            min(len(text) for text in (definition.quantity, definition.reason, definition.guards, definition.breaks))
            >= 12
        )
    assert find("Loop gap").name == "loop_gap"
    with pytest.raises(InputError, match="no such check"):
        find("?")


def test_verdicts_on_values() -> None:
    assert check("loop_gap", 1e-5).ok
    assert not check("loop_gap", 1.1e-5).ok
    assert not check("loop_gap", float("nan")).ok
    assert check("loop_gap", 3e-5).factor == pytest.approx(3)
    assert check("loop_gap", float("nan")).factor == float("inf")
    assert check("assembly_mode", 1).factor == float("inf")
    assert Check("any", 0.0, 0.0).factor == 0

"""A case is measured once, whoever asks, and with as few simulations as its checks need."""

import sys

import pytest

import fes_mj
from fes_mj.simulation import stepping
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import FULL_CHECKS, verify

MOST_RUNS = 12 + 6  # of the bench, and three rides, each with a trial at twice the step


@pytest.mark.long
def test_a_full_verification_makes_few_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    runs, run_loop = [], stepping.run_loop

    def counted(*arguments: object, **options: object) -> object:
        runs.append(arguments)
        return run_loop(*arguments, **options)  # type: ignore[arg-type]

    for module in [*sys.modules.values()]:  # whoever has imported it by name
        if vars(module).get("run_loop") is run_loop:
            monkeypatch.setattr(module, "run_loop", counted)
    case = VerificationCase(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), refined=True)
    checks = list(verify(case, FULL_CHECKS))
    needed = len(runs)
    assert 0 < needed <= MOST_RUNS
    assert list(verify(case, FULL_CHECKS)) == checks
    _ = case.as_json(), case.curves, case.uncertainty, case.summary()
    assert len(runs) == needed  # tables and reports simulate nothing again

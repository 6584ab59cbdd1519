"""The suite leaves out no check."""

import pytest

from fes_mj.common.checks import definitions
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import FULL_CHECKS, QUICK_CHECKS, benchmarks, verify


@pytest.mark.long
def test_the_suite_measures_every_registered_check(case: VerificationCase, muscle_case: VerificationCase) -> None:
    checks = (*verify(case, FULL_CHECKS), *verify(muscle_case, QUICK_CHECKS), *benchmarks())
    names = {check.name for check in checks}
    assert names == set(definitions())

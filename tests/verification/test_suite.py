"""The suite leaves out no check."""

import pytest

from fes_mj.common.checks import definitions
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.suite import FULL, benchmarks, verify


@pytest.mark.long
def test_the_suite_measures_every_registered_check(case: VerificationCase) -> None:
    names = {check.name for check in (*verify(case, FULL), *benchmarks())}
    assert names == set(definitions())

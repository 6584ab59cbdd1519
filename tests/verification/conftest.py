"""Cases that many tests of the verification share."""

import pytest

import fes_mj
from fes_mj.linkage.design_file import design_path
from fes_mj.paper.printed import table1
from fes_mj.verification.case import VerificationCase


def case_of(source: str) -> VerificationCase:
    """A design under the moments of P1P2, with what is printed of it."""
    return VerificationCase(
        fes_mj.load_design(source),
        fes_mj.load_moments("p1p2"),
        expected=table1().get(source),
        file=design_path(source),
    )


def muscle_case_of(source: str, group: str = "p1p2", timing: str = "best") -> VerificationCase:
    """A design under the most probable rider's muscles."""
    return VerificationCase(fes_mj.load_design(source), fes_mj.load_muscles(group, timing), file=design_path(source))


@pytest.fixture(scope="module")
def muscle_case() -> VerificationCase:
    return muscle_case_of("d1")


@pytest.fixture(scope="module")
def case() -> VerificationCase:
    return case_of("d1")

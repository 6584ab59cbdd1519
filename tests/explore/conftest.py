"""A page that can be asked, of D1 with the group P1P2."""

import pytest

import fes_mj
from fes_mj.explore.answers import Answers


@pytest.fixture
def answers() -> Answers:
    return Answers(fes_mj.load_design("d1"), fes_mj.load_moments())

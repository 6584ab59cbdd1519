"""A page that can be asked, of D1 with the group P1P2, and what it sends."""

from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.common.reading import Section
from fes_mj.explore.answers import Answers


def question(**content: Any) -> Section:
    return Section(Path("the page"), "", content)


@pytest.fixture
def answers() -> Answers:
    return Answers(fes_mj.load_design("d1"), fes_mj.load_moments())

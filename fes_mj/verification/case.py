"""What is verified: a design under the joint moments of a group at a cadence."""

from __future__ import annotations

from typing import NamedTuple

from fes_mj.checks import Check, check
from fes_mj.design import Design
from fes_mj.paper.printed import Table1Row
from fes_mj.torque import JointMoments


class Case(NamedTuple):
    """A design, joint moments, the crank speed in rad/s, and the paper's row if this is one of its designs."""

    design: Design
    moments: JointMoments
    cadence: float
    printed: Table1Row | None = None

    @property
    def name(self) -> str:
        return f"{self.design.name} {self.moments.name}"

    def check(self, name: str, value: float) -> Check:
        """A measured value of this case beside its limit."""
        return check(name, value, self.name)

"""One thing that a trial says of itself, beside what is declared or assumed of it."""

from typing import NamedTuple

from fes_mj.moments.joint_moments import Misreading


class Comparison(NamedTuple):
    """One thing that a file says, beside what is declared or assumed of it.

    advice: what it can mean where they do not agree, and what to do.
    """

    name: str
    quantity: str
    recorded: str
    declared: str
    agrees: bool
    advice: str = ""

    @property
    def misreading(self) -> Misreading:
        """The contradiction as a warning."""
        return Misreading(self.name, f"{self.quantity}: {self.recorded} recorded, {self.declared}; {self.advice}")

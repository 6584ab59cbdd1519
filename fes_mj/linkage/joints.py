"""The two driven joints of a leg, and the pair of values that belongs to them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T", covariant=True)
U = TypeVar("U")
JOINTS = ("knee", "hip")


@dataclass(frozen=True)
class PerJoint(Generic[T]):
    """A value for the knee and one for the hip; iterates in this order, and pair["knee"] reads one by name."""

    knee: T
    hip: T

    def __getitem__(self, joint: str) -> T:
        return {"knee": self.knee, "hip": self.hip}[joint]

    def __iter__(self) -> Iterator[T]:
        return iter((self.knee, self.hip))

    def items(self) -> Iterator[tuple[str, T]]:
        """Name and value of each joint."""
        return zip(JOINTS, self, strict=True)

    def map(self, function: Callable[[T], U]) -> "PerJoint[U]":
        """The pair of function(value)."""
        return PerJoint(function(self.knee), function(self.hip))

    @classmethod
    def of(cls, function: Callable[[str], T]) -> "PerJoint[T]":
        """The pair of function(name)."""
        return cls(function("knee"), function("hip"))

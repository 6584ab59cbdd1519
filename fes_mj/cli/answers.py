"""The two numbers of a design that may be quoted, on a terminal."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

from fes_mj.budget.answer import Answer, answer
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import LoadOptions
from fes_mj.cli.tables import heading
from fes_mj.common.console import print_table, say
from fes_mj.moments.files import load_moments
from fes_mj.statics.friction import BearingLoss
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import DrivenTurn, QuasiStatic, quasi_static

AS_ASSUMED, FOR_A_RIDER, PER_TRT = (
    "as the paper assumes: moments by joint angle, W",
    "for a rider: muscles, best timing, mean, W",
    "times the traditional tricycle's: to be quoted",
)


class Turns(Protocol):
    """A design's turn of one leg, or of several that differ, with its mean power, W: LegTurns and MuscleStatic."""

    @property
    def first(self) -> DrivenTurn: ...
    @property
    def turns(self) -> Sequence[DrivenTurn]: ...
    @property
    def legs(self) -> int: ...
    @property
    def power_mean(self) -> float: ...
    def ratio(self, other: Any) -> tuple[float, float | None]: ...
    def summary(self) -> dict[str, Any]: ...


@dataclass(frozen=True, eq=False)
class Answered:
    """A design whose turn is known, what its bearings lose, and both numbers, found when they are asked for."""

    drive: DriveOptions
    options: LoadOptions
    result: Turns
    loss: BearingLoss | None = None

    @property
    def name(self) -> str:
        return self.result.first.design.name

    @cached_property
    def answer(self) -> Answer:
        """Of own moments or muscles that number which they can give."""
        drive, options, first = self.drive, self.options, self.result.first
        cadence = None if options.cadence is None else first.cadence
        if isinstance(first, MuscleStatic):
            riders = first.stimulated.riders
            assumed = () if drive.muscles else (quasi_static(first.design, load_moments(riders.name), first.cadence),)
            return answer(first.design, assumed, riders, cadence, drive.duty)
        moved = [turn for turn in self.result.turns if isinstance(turn, QuasiStatic)]
        return answer(first.design, moved, None if options.moments else drive.load_riders(options), cadence)


def print_answer(result: Turns, answer: Answer, *more: tuple[str, float]) -> None:
    """Print both numbers, where each of them lies, and more powers of the same design, W."""
    rows = []
    if answer.paper_mean is not None:
        uncertain = answer.paper_power
        rows.append((AS_ASSUMED, f"{answer.paper_mean:.2f}", uncertain.interval(2) if uncertain else "not known"))
    rows += [(name, f"{power:.2f}", "") for name, power in more]
    for name, estimate, digits in ((FOR_A_RIDER, answer.rider_power, 1), (PER_TRT, answer.rider_ratio, 2)):
        if estimate:
            rows.append((name, f"{estimate.value:.{digits}f}", estimate.interval(digits)))
    print_table(heading(result.first, result.legs), ("mean crank power of a leg", "", "5 to 95 %"), rows)
    if answer.missing:
        say(f"for a rider: {answer.missing}")

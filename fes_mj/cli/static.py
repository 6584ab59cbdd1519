"""`fes_mj static`: the quasi-static solver alone, of one design or of several side by side."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from fes_mj.cli import tables
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import BearingOptions, DesignName, Flag, RunOptions
from fes_mj.common.console import print_table, say
from fes_mj.linkage.turning import CRANK_ZERO, FROM_TOP, turning
from fes_mj.moments.uncertainty import with_sd
from fes_mj.statics.friction import BearingLoss, Bearings
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import DrivenTurn, LegTurns, QuasiStatic, quasi_static


class Result(Protocol):
    """What moments and muscles have in common: a turn of one leg or several, with its mean power, W."""

    @property
    def first(self) -> DrivenTurn: ...
    @property
    def turns(self) -> Sequence[DrivenTurn]: ...
    @property
    def legs(self) -> int: ...
    @property
    def power_mean(self) -> float: ...
    @property
    def power_sd(self) -> float | None: ...
    def ratio(self, other: Any) -> tuple[float, float | None]: ...
    def summary(self) -> dict[str, Any]: ...


def static(
    design: DesignName,
    /,
    *others: DesignName,
    options: RunOptions = RunOptions(),
    drive: DriveOptions = DriveOptions(),
    bearings: BearingOptions = BearingOptions(),
    curves: Flag = False,
) -> None:
    """Mean crank power of a design by statics, without masses and without MuJoCo; of several beside each other.

    Args:
        curves: Also the curves over the turn: a row every 10 deg, with --json 360 points.
    """

    def solved(name: str) -> Result:
        by_muscles = drive.drive == "muscles"
        return drive.solve(options, name) if by_muscles else LegTurns.solve(*options.load(name), options.legs)

    results, friction = [solved(name) for name in (design, *others)], bearings.load()
    if others:
        options.show(lambda: _comparison(results, curves, friction), lambda: _print_comparison(results, friction))
    else:
        options.show(
            lambda: _content(results[0], curves, friction),
            lambda: _print(results[0], curves, friction, options.verbose),
        )


def _loss(result: Result, bearings: Bearings | None) -> BearingLoss | None:
    return BearingLoss(JointForces(result.first), bearings) if bearings else None


def _content(result: Result, curves: bool, bearings: Bearings | None) -> dict[str, Any]:
    """The result of one design as JSON names and units it."""
    content = result.summary()
    if isinstance(result, LegTurns):
        from fes_mj.budget.budget import error_budget, summary

        content |= summary(error_budget(*result.turns))
    loss = _loss(result, bearings)
    content["friction_loss_W"] = loss.power if loss else 0.0
    return content | JointForces(result.first).summary() | (_curves(result, 360) if curves else {})


def _comparison(results: list[Result], curves: bool, bearings: Bearings | None) -> dict[str, Any]:
    """Several designs as JSON, and the mean power of each per the first's."""
    keys = ("design", "power_ratio", "power_ratio_sd")
    ratios = [(result.first.design.name, *result.ratio(results[0])) for result in results]
    return {
        "designs": [_content(result, curves, bearings) for result in results],
        "ratios": [dict(zip(keys, ratio, strict=True)) for ratio in ratios],
    }


def _print(result: Result, curves: bool, bearings: Bearings | None, verbose: bool) -> None:
    first, turns = result.first, result.turns
    sides = ("quasi-static",) if len(turns) == 1 else ("right", "left")
    rows = tables.beside(*map(tables.power_rows, turns))
    print_table(tables.heading(first, result.legs), ("", *sides), rows)
    if isinstance(result, MuscleStatic):
        say("+- is over the riders who may have been measured")
        tables.print_stimulation(result)
    elif verbose and isinstance(result, LegTurns):
        tables.print_budget(*result.turns)
    elif result.power_sd is not None:
        say("+- is the error of the moments alone; --verbose adds the whole error budget")
    together = "quasi-static" if result.legs == 1 else "both legs"
    print_table("The turn", ("", together), tables.turn_rows(result.summary()))
    tables.print_forces(JointForces(first))
    tables.print_friction(_loss(result, bearings))
    if verbose:
        print_table("Joint reactions", ("joint", "mean N", "largest N"), tables.force_rows(first.reactions))
    if curves:
        _print_curves(_curves(result, 36))
    for turn in turns:
        tables.print_notes(turn, f"{turn.driver}: " if len(turns) > 1 else "")


def _print_comparison(results: list[Result], bearings: Bearings | None) -> None:
    """One column a design."""
    summaries, ratios = [result.summary() for result in results], [result.ratio(results[0]) for result in results]
    rows = [
        ("cadence, rpm", *(f"{content['cadence_rpm']:.1f}" for content in summaries)),
        (
            "mean crank power of one leg, W",
            *(tables.with_error(result.power_mean, result.power_sd) for result in results),
        ),
        ("  per the first design's", *(with_sd(ratio, deviation or None, 3) for ratio, deviation in ratios)),
    ]
    rows += tables.beside(*(tables.power_rows(result.first)[1:] for result in results))
    rows += tables.beside(*map(tables.turn_rows, summaries))
    if bearings:
        losses = [loss.power for result in results if (loss := _loss(result, bearings))]
        rows.append(("lost in the bearings, W", *(f"{loss:.2f}" for loss in losses)))
    names = [result.first.design.name for result in results]
    print_table(f"{results[0].first.driver}, quasi-static", ("", *names), rows)
    for result in results:
        tables.print_notes(result.first, f"{result.first.design.name}: ")


def _curves(result: Result, points: int) -> dict[str, Any]:
    """Curves of the first leg over so many crank angles; of muscles, a part of those that there are."""
    turn = result.first
    if isinstance(turn, QuasiStatic):
        turn = quasi_static(turn.design, turn.moments, turn.cadence, points)
    every = slice(None, None, len(turn.crank_angle) // points)
    angles, moments = turn.joint_angle.items(), turn.joint_moment.items()
    return {
        "crank_angle_deg": np.degrees(turn.crank_angle[every]).round(),  # whole degrees, but for rounding
        FROM_TOP: turning(turn.design).degrees_from_top(turn.crank_angle[every]),
        "crank_moment_Nm": turn.crank_moment[every],
        **{f"{joint}_deg": np.degrees(angle[every]) for joint, angle in angles},
        **{f"{joint}_Nm": moment[every] for joint, moment in moments},
    }


def _print_curves(curves: dict[str, Any]) -> None:
    heads = ("crank deg", "from tdc deg", "crank N m", "knee deg", "hip deg", "knee N m", "hip N m")
    cells = (
        [f"{value:.0f}" if name == "crank_angle_deg" else f"{value:.2f}" for value in column]
        for name, column in curves.items()
    )
    print_table(f"Over the turn; crank angle 0: {CRANK_ZERO}; tdc: top dead centre", heads, zip(*cells, strict=True))

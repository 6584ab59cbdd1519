"""`fes_mj static`: the quasi-static solver alone, of one design or of several side by side."""

from typing import Any

import numpy as np

from fes_mj.cli import tables
from fes_mj.cli.options import BearingOptions, DesignName, Flag, Loaded, RunOptions
from fes_mj.common.console import print_table, say
from fes_mj.linkage.turning import CRANK_ZERO, FROM_TOP, turning
from fes_mj.moments.uncertainty import with_sd
from fes_mj.statics.friction import BearingLoss, Bearings
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.turn import LegTurns, QuasiStatic, quasi_static


def static(
    design: DesignName,
    /,
    *others: DesignName,
    options: RunOptions = RunOptions(),
    bearings: BearingOptions = BearingOptions(),
    curves: Flag = False,
) -> None:
    """Mean crank power of a design by statics, without masses and without MuJoCo; of several beside each other.

    Args:
        curves: Also the curves over the turn: a row every 10 deg, with --json 360 points.
    """
    loaded = [options.load(name) for name in (design, *others)]
    results = [LegTurns.solve(*named, options.legs) for named in loaded]
    first, result, friction = loaded[0], results[0], bearings.load()
    if others:
        options.show(
            lambda: _comparison(loaded, results, curves, friction), lambda: _print_comparison(results, friction)
        )
    else:
        options.show(
            lambda: _content(first, result, curves, friction),
            lambda: _print(first, result, curves, friction, options.verbose),
        )


def _loss(result: LegTurns, bearings: Bearings | None) -> BearingLoss | None:
    return BearingLoss(JointForces(result.first), bearings) if bearings else None


def _content(loaded: Loaded, result: LegTurns, curves: bool, bearings: Bearings | None) -> dict[str, Any]:
    """The result of one design as JSON names and units it."""
    from fes_mj.budget.budget import error_budget, summary

    content = result.summary() | summary(error_budget(*result.turns)) | JointForces(result.first).summary()
    loss = _loss(result, bearings)
    content["friction_loss_W"] = loss.power if loss else 0.0
    return content | (_curves(quasi_static(*loaded, points=360)) if curves else {})


def _comparison(
    loaded: list[Loaded], results: list[LegTurns], curves: bool, bearings: Bearings | None
) -> dict[str, Any]:
    """Several designs as JSON, and the mean power of each per the first's."""
    designs = [_content(named, result, curves, bearings) for named, result in zip(loaded, results, strict=True)]
    keys = ("design", "power_ratio", "power_ratio_sd")
    ratios = [(result.first.design.name, *result.ratio(results[0])) for result in results]
    return {"designs": designs, "ratios": [dict(zip(keys, ratio, strict=True)) for ratio in ratios]}


def _print(loaded: Loaded, result: LegTurns, curves: bool, bearings: Bearings | None, verbose: bool) -> None:
    first = result.first
    sides = ("quasi-static",) if len(result.turns) == 1 else ("right", "left")
    rows = tables.beside(*map(tables.power_rows, result.turns))
    print_table(tables.heading(first, result.legs), ("", *sides), rows)
    if verbose:
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
        _print_curves(_curves(quasi_static(*loaded, points=36)))
    for turn in result.turns:
        tables.print_notes(turn, f"{turn.moments.name}: " if len(result.turns) > 1 else "")


def _print_comparison(results: list[LegTurns], bearings: Bearings | None) -> None:
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
    print_table(f"{results[0].first.moments.name}, quasi-static", ("", *names), rows)
    for result in results:
        tables.print_notes(result.first, f"{result.first.design.name}: ")


def _curves(result: QuasiStatic) -> dict[str, Any]:
    degrees = np.degrees(result.crank_angle)
    return {
        "crank_angle_deg": degrees.round(),  # whole degrees, but for rounding
        FROM_TOP: turning(result.design).degrees_from_top(result.crank_angle),
        "crank_moment_Nm": result.crank_moment,
        **{f"{joint}_deg": np.degrees(angle) for joint, angle in result.joint_angle.items()},
        **{f"{joint}_Nm": moment for joint, moment in result.joint_moment.items()},
    }


def _print_curves(curves: dict[str, Any]) -> None:
    heads = ("crank deg", "from tdc deg", "crank N m", "knee deg", "hip deg", "knee N m", "hip N m")
    cells = (
        [f"{value:.0f}" if name == "crank_angle_deg" else f"{value:.2f}" for value in column]
        for name, column in curves.items()
    )
    print_table(f"Over the turn; crank angle 0: {CRANK_ZERO}; tdc: top dead centre", heads, zip(*cells, strict=True))

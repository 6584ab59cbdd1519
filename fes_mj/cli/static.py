"""`fes_mj static`: the quasi-static solver alone, of one design or of several side by side."""

from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from fes_mj.budget.budget import budget_summary, error_budget
from fes_mj.cli import tables
from fes_mj.cli.answers import Answered, Turns, print_answer
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import BearingOptions, DesignName, Flag, RunOptions
from fes_mj.common.console import print_table, say
from fes_mj.common.units import RPM
from fes_mj.linkage.design_file import design_path, design_toml
from fes_mj.linkage.turning import CRANK_ZERO, FROM_TOP, turning
from fes_mj.muscles.rules import BEST
from fes_mj.statics.friction import BearingLoss
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import LegTurns, QuasiStatic, quasi_static


def static(
    *names: Annotated[DesignName, Parameter(name="DESIGN", required=True)],
    options: RunOptions = RunOptions(),
    drive: DriveOptions = DriveOptions(),
    bearings: BearingOptions = BearingOptions(),
    curves: Flag = False,
) -> None:
    """Mean crank power of a design by statics, without masses and without MuJoCo; of several beside each other.

    Args:
        curves: Also the curves over the turn: a row every 10 deg, with --json 360 points.
    """
    friction = bearings.load()

    def solved(name: str) -> Answered:
        by_muscles = drive.drive == "muscles"
        result = drive.solve(options, name) if by_muscles else LegTurns.solve(*options.load(name), options.legs)
        loss = BearingLoss(JointForces(result.first), friction) if friction else None
        return Answered(drive, options, result, loss)

    designs = [solved(name) for name in names]

    def source() -> dict[str, Any]:
        from fes_mj.common.provenance import provenance

        files = [design_path(name, options.dims) for name in names]
        return {"provenance": provenance(files + drive.inputs(options))}

    if len(designs) > 1:
        options.show(
            lambda: _comparison(designs, curves) | source(),
            lambda: _print_comparison(designs, options.verbose),
        )
    else:
        options.show(
            lambda: _content(designs[0], curves) | source(),
            lambda: _print(designs[0], curves, options.verbose),
        )


def _content(design: Answered, curves: bool) -> dict[str, Any]:
    """The result of one design as JSON names and units it."""
    result = design.result
    content = result.summary() | design.answer.summary() | {"design_toml": design_toml(result.first.design)}
    if isinstance(result, LegTurns):
        content |= budget_summary(error_budget(*result.turns))
    content["friction_loss_W"] = design.loss.power if design.loss else 0.0
    return content | JointForces(result.first).summary() | (_curves(result, 360) if curves else {})


def _comparison(designs: list[Answered], curves: bool) -> dict[str, Any]:
    """Several designs as JSON, and the powers of each per the first's."""

    def ratio(design: Answered) -> dict[str, Any]:
        value, deviation = design.result.ratio(designs[0].result)
        of_both = zip(("paper", "rider"), design.answer.per(designs[0].answer), strict=True)
        named = {"design": design.name, "power_ratio": value, "power_ratio_sd": deviation}
        for name, estimate in of_both:
            named |= {f"{name}_power_ratio": estimate and estimate.value}
            named |= {f"{name}_power_ratio_interval": estimate and estimate[1:]}
        return named

    return {"designs": [_content(design, curves) for design in designs], "ratios": [*map(ratio, designs)]}


def _print(design: Answered, curves: bool, verbose: bool) -> None:
    result, turns = design.result, design.result.turns
    of_rule = [] if not isinstance(result, MuscleStatic) or result.rule == BEST else [(result.rule, result.power_mean)]
    print_answer(result, design.answer, *((f"stimulated {rule}, expected, W", power) for rule, power in of_rule))
    if isinstance(result, MuscleStatic):
        tables.say_stimulation(result)
    if design.loss:
        say(tables.friction(design.loss))
    if verbose:
        sides = ("quasi-static",) if len(turns) == 1 else ("right", "left")
        rows = tables.beside(*map(tables.power_rows, turns))
        print_table("As everything is known best", ("", *sides), rows)
        if isinstance(result, LegTurns):
            tables.print_budget(*result.turns)
        together = "quasi-static" if result.legs == 1 else "both legs"
        print_table("The turn", ("", together), tables.turn_rows(result.summary()))
        tables.print_forces(JointForces(result.first))
        tables.print_friction(design.loss)
        print_table("Joint reactions", ("joint", "mean N", "largest N"), tables.force_rows(result.first.reactions))
    if curves:
        _print_curves(_curves(result, 36))
    for turn in turns:
        tables.print_notes(turn, f"{turn.driver}: " if len(turns) > 1 else "")


def _missing(designs: list[Answered]) -> dict[str, list[str]]:
    """Why there is no number for a rider, and of which designs."""
    reasons: dict[str, list[str]] = {}
    for design in designs:
        if design.answer.missing:
            reasons.setdefault(design.answer.missing, []).append(design.name)
    return reasons


def _print_comparison(designs: list[Answered], verbose: bool) -> None:
    """A row a design; with more, a column a design."""
    base = designs[0]
    rows = []
    for design in designs:
        answer, (paper, rider) = design.answer, design.answer.per(base.answer)
        estimates = ((paper, 2), (answer.rider_power, 1), (rider, 2), (answer.rider_ratio, 2))
        cells = [estimate.text(digits) if estimate else "-" for estimate, digits in estimates]
        assumed = answer.paper_power.text(2) if answer.paper_power else tables.or_dash(answer.paper_mean, ".2f")
        rows.append((design.name, f"{design.result.first.cadence / RPM:.1f}", assumed, *cells))
    per = f"per {base.name}"
    heads = ["design", "rpm", "as the paper assumes, W", per, "for a rider, W", per, "per equally timed TRT"]
    if no_more := all(row[-1] in (row[-2], "-") for row in rows):  # no more than the ratio to the first design says
        heads, rows = heads[:-1], [row[:-1] for row in rows]
    print_table(f"{base.result.first.driver}; mean crank power of a leg (5 to 95 %)", heads, rows)
    for reason, names in _missing([row for row in designs if row.answer.rider is None or not no_more]).items():
        say(f"for a rider, {', '.join(names)}: {reason}")
    for design in designs:
        if design.loss:
            say(f"{design.name}: {tables.friction(design.loss)}")
    if verbose:
        results = [design.result for design in designs]
        beside = tables.beside(*(tables.power_rows(result.first) for result in results))
        beside += tables.beside(*(tables.turn_rows(result.summary()) for result in results))
        print_table("As everything is known best", ("", *(design.name for design in designs)), beside)
    for design in designs:
        tables.print_notes(design.result.first, f"{design.name}: ")


def _curves(result: Turns, points: int) -> dict[str, Any]:
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

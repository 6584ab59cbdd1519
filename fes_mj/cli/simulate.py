"""`fes_mj simulate`: generate the model, run it, measure, compare with statics, say whether they agree."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Group, Parameter
from cyclopts.validators import Number

import fes_mj
from fes_mj.budget.answer import Answer
from fes_mj.budget.budget import budget_summary, error_budget
from fes_mj.cli import tables
from fes_mj.cli.answers import Answered, print_answer
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import BearingOptions, DesignName, Flag, Out, RunOptions, needs
from fes_mj.common.checks import Check
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.common.writing import json_text, require_results, require_writable, write_results
from fes_mj.linkage.design_file import design_path, design_toml
from fes_mj.simulation.time_step import LONGEST_TIMESTEP
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import LegTurns

_VIDEO = Group("Video", validator=needs("--render"))
TURN_SHOWN = (0.1, 60.0)  # s, shortest and longest of a turn in a video


def simulate(
    design: DesignName,
    /,
    *,
    options: RunOptions = RunOptions(),
    drive: DriveOptions = DriveOptions(),
    bearings: BearingOptions = BearingOptions(),
    out: Out | None = None,
    timestep: Annotated[float | None, Parameter(validator=Number(gt=0, lte=LONGEST_TIMESTEP))] = None,
    turns: Annotated[int, Parameter(validator=Number(gte=1, lte=1000))] = 1,
    render: Annotated[Path | None, Parameter(group=_VIDEO)] = None,
    speed: Annotated[float | None, Parameter(group=_VIDEO)] = None,
    view: Flag = False,
) -> int:
    """Simulate a design in MuJoCo and compare its crank power with statics; exit code 1 if they disagree.

    Args:
        out: Folder for the result (JSON), the cycle (CSV) and the model (MJCF); it is made if its parent exists.
        timestep: Step of the simulation in s, rounded to a whole number of steps per turn. By default it is chosen
            beforehand, by how sharply the linkage moves at its cadence.
        turns: Measured turns.
        render: Write a video (.mp4) of the moving legs and linkage beside the crank power.
        speed: Of the video: 1 is the true one. By default a turn takes 4 s.
        view: Then watch it run in MuJoCo's interactive viewer, with two legs, where there is a screen.
    """
    loaded, inputs = drive.load(options, design), drive.inputs(options, design)
    require_writable(render, "the video", ".mp4", inputs)
    if render:
        from fes_mj.viewing.render import require_video

        require_video()
    if speed is not None:
        _check_speed(speed, loaded.cadence)
    from fes_mj.common.provenance import provenance
    from fes_mj.verification.suite import quick_groups, verify

    one_leg = drive.case(options, design, timestep=timestep, turns=turns, bearings=bearings.load())
    case = one_leg if options.legs == 1 else one_leg.two_legs
    stem = f"{case.design.name} {case.drive.name}".replace(" ", "-")
    paths = require_results(out, [f"{stem}.{kind}" for kind in ("json", "csv", "xml")], inputs) if out else []
    # bearings lose energy, which every other check takes for an error
    checks = case.checks if case.bearings else [*verify(one_leg, quick_groups(options.legs))]
    agrees = all(check.ok for check in checks)
    numbers = Answered(drive, options, case.statics)
    content: dict[str, Any] = {}
    if paths or options.json:
        content = _content(case, numbers.answer, checks, provenance([design_path(design, options.dims), *inputs[1:]]))
    if paths:
        write_results(dict(zip(paths, (json_text(content), *_texts(case)), strict=True)))
    options.show(lambda: content, lambda: _print(case, numbers.answer, checks, options.verbose))
    if render:
        from fes_mj.viewing.render import render_video

        render_video(case, render, speed, options.quiet, numbers.answer)
        options.name_files(video=render)
    if view:
        from fes_mj.viewing import viewer

        viewer.show(*loaded)
    return 0 if agrees else 1


def _content(case: fes_mj.Case, answer: Answer, checks: Sequence[Check], source: dict[str, Any]) -> dict[str, Any]:
    """The result as JSON names and units it, and what it was made from."""
    return (
        case.summary()
        | answer.summary()
        | ({} if isinstance(case.statics, MuscleStatic) else budget_summary(error_budget(*case.statics.turns)))
        | {"agrees": all(check.ok for check in checks), "checks": [check.as_json() for check in checks]}
        | {"design_toml": design_toml(case.design), "provenance": source}
    )


def _check_speed(speed: float, cadence: float) -> None:
    """Refuse a speed at which a turn at this cadence (rad/s) is too short or too long to watch."""
    longest, shortest = (2 * np.pi / (cadence * seconds) for seconds in TURN_SHOWN)
    if not shortest <= speed <= longest:
        raise InputError(
            f"--speed is {speed:g}; at {cadence / RPM:.1f} rpm it must be from {shortest:.3g} to {longest:.3g}, with "
            f"which a turn takes {TURN_SHOWN[1]:g} to {TURN_SHOWN[0]:g} s"
        )


def _print(case: fes_mj.Case, answer: Answer, checks: Sequence[Check], verbose: bool) -> None:
    statics, run = case.statics, case.simulation
    powers = [("as the paper assumes, simulated, W", run.power_mean)]
    if isinstance(statics, MuscleStatic):
        whose = f"the most probable rider alone, timing {statics.rule}"
        powers = [(f"{whose}, W", case.static_power_mean), ("the same, simulated, W", run.power_mean)]
    print_answer(statics, answer, *powers)
    if isinstance(statics, MuscleStatic):
        tables.say_stimulation(statics)
    if case.steps.friction:
        say(tables.friction(case.steps.friction))
    if verbose:
        _print_turn(case)
    if verbose or not all(check.ok for check in checks):
        more = [check for check in checks if not (check.ok or check in case.checks)]
        tables.print_checks("Checks", [*case.checks, *more])
    for turn in statics.turns:
        tables.print_notes(turn, f"{turn.driver}: " if len(statics.turns) > 1 else "")
    tables.conclude_checks("Dynamic and static", checks, f": mean power differs by {case.difference_text}")


def _print_turn(case: fes_mj.Case) -> None:
    """Print what else is known of the turn, statics beside dynamics."""
    run, turns = case.simulation, case.statics.turns
    dynamic = (
        f"{run.power_mean:.3f}",
        f"{run.work_per_turn:.3f}",
        *(tables.span(ends) for ends in run.joint_range_deg),
    )
    sides = ("",) if len(turns) == 1 else (", right", ", left")
    rows = zip(tables.beside(*map(tables.power_rows, turns)), dynamic, strict=True)
    heads = ("", *(f"quasi-static{side}" for side in sides), "dynamic")
    print_table("As everything is known best", heads, [(*row, measured) for row, measured in rows])
    if isinstance(case.statics, LegTurns):
        tables.print_budget(*case.statics.turns)
    summary = case.static.summary()
    rows_of_turn = tables.beside(*map(tables.turn_rows, (summary, summary | case.characteristics)))
    together = "dynamic" if len(run.legs) == 1 else "dynamic, both legs"
    print_table("The turn", ("", f"quasi-static{sides[0]}", together), rows_of_turn)
    tables.print_forces(case.joint_forces)
    tables.print_friction(case.steps.friction)
    terms = [(name.replace("_", " "), f"{value:.5f}") for name, value in run.energy.as_json().items()]
    print_table("Energy over the measured turns", ("term", "J"), terms)
    print_table("Constraint forces", ("loop", "mean N", "largest N"), tables.force_rows(run.loop_force))


def _texts(case: fes_mj.Case) -> tuple[str, str]:
    """The cycle and the model."""
    from fes_mj.simulation.export import mjcf_text

    spec = fes_mj.build_mjcf(case.design, cadence=case.cadence, timestep=case.simulation.timestep, legs=case.legs)
    case.steps.edit_model(spec)
    return case.cycle_csv(), mjcf_text(spec)

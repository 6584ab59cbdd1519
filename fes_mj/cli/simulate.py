"""`fes_mj simulate`: generate the model, run it, measure, compare with statics, say whether they agree."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from fes_mj.budget.budget import error_budget, summary
from fes_mj.cli.options import RunOptions
from fes_mj.cli.static import (
    force_rows,
    heading,
    print_budget,
    print_forces,
    print_notes,
    rows,
    span,
    turn_rows,
    with_error,
)
from fes_mj.common.console import conclude, number, print_table, say, verdict
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.common.writing import json_text, require_folder, require_replaceable, require_writable, write_files
from fes_mj.simulation.time_step import LONGEST_TIMESTEP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.text import Text

    from fes_mj.common.checks import Check
    from fes_mj.crosscheck.turn_case import Case

_DEFAULTS = RunOptions()
MOST_TURNS = 1000
TURN_SHOWN = (0.1, 60.0)  # s, shortest and longest of a turn in a video


def simulate(
    design: str,
    /,
    *,
    options: RunOptions = _DEFAULTS,
    render: Path | None = None,
    speed: float | None = None,
    out: Path | None = None,
    timestep: float | None = None,
    turns: int = 1,
    legs: Literal[1, 2] = 1,
) -> int:
    """Simulate a design in MuJoCo and compare its crank power with statics; exit code 1 if they disagree.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    render
        Write a video (.mp4) of the moving legs and linkage beside the crank power.
    speed
        Of the video: 1 is the true one. By default a turn takes 4 s.
    out
        Existing folder for the result (JSON), the cycle (CSV) and the model (MJCF).
    timestep
        Step of the simulation in s, rounded to a whole number of steps per turn. By default it is chosen beforehand,
        by how sharply the linkage moves at its cadence.
    turns
        Measured turns.
    legs
        One leg, or two half a turn apart on the same crank.
    """
    loaded, inputs = options.load(design, legs), options.inputs(design)
    _check(timestep, turns)
    if render:
        require_writable(render, "the video", ".mp4", inputs)
    _check_speed(speed, loaded.cadence, render)
    from fes_mj.crosscheck.turn_case import Case

    case = Case(*loaded, timestep, turns, legs)
    results = _results(case, out, inputs) if out else []
    if results:
        _write(case, *results)
    if options.json:
        sys.stdout.write(_content(case))
    elif not options.quiet:
        _print(case, options.verbose)
    if render:
        from fes_mj.viewing.render import render_video

        render_video(case, render, speed, options.quiet)
        if not options.silent:
            say(f"video: {render}")
    return 0 if case.agrees else 1


def _content(case: Case) -> str:
    """The result as JSON text."""
    from fes_mj.crosscheck.turn_output import turn_summary

    return json_text(turn_summary(case) | summary(error_budget(*case.statics)))


def _check(timestep: float | None, turns: int) -> None:
    """Refuse unusable options before anything runs."""
    if timestep is not None and not 0 < timestep <= LONGEST_TIMESTEP:
        raise InputError(f"--timestep is {timestep:g}; it must be above 0 and at most {LONGEST_TIMESTEP:g} s")
    if not 1 <= turns <= MOST_TURNS:
        raise InputError(f"--turns is {turns}; it must be from 1 to {MOST_TURNS}")


def _check_speed(speed: float | None, cadence: float, render: Path | None) -> None:
    """Refuse a speed of no video, or one at which a turn at this cadence (rad/s) is too short or too long to watch."""
    if speed is None:
        return
    if not render:
        raise InputError("--speed is that of a video; it needs --render OUT.mp4")
    longest, shortest = (2 * np.pi / (cadence * seconds) for seconds in TURN_SHOWN)
    if not shortest <= speed <= longest:
        raise InputError(
            f"--speed is {speed:g}; at {cadence / RPM:.1f} rpm it must be from {shortest:.3g} to {longest:.3g}, with "
            f"which a turn takes {TURN_SHOWN[1]:g} to {TURN_SHOWN[0]:g} s"
        )


def check_rows(checks: Sequence[Check]) -> list[tuple[str, str, str, Text]]:
    """Name, value, limit and verdict of checks, as text."""
    return [
        (each.name, number(each.value, each.unit), number(each.limit, each.unit), verdict(each.ok)) for each in checks
    ]


def conclude_checks(who: str, checks: Sequence[Check], agreeing: str = "") -> None:
    """Say whether two ways to the same numbers agree, and what more there is to say if they do."""
    failed = ", ".join(check.name for check in checks if not check.ok)
    if failed:
        conclude(False, f"{who} do not agree", f": {failed}; `fes_mj explain CHECK` says more.")
    else:
        conclude(True, f"{who} agree", f"{agreeing}.")


def _print(case: Case, verbose: bool) -> None:
    from fes_mj.crosscheck.turn_output import turn_summary

    run = case.simulation
    dynamic = (
        with_error(run.power_mean, case.power_sd),  # the mean is the same functional of the moments
        f"{2 * np.pi * run.power_mean / run.cadence:.3f}",
        *(span(ends) for ends in run.joint_range_deg),
    )
    sides = ("",) if len(case.statics) == 1 else (", right", ", left")
    names = [name for name, _ in rows(case.static)]
    columns = [[value for _, value in rows(each)] for each in case.statics]
    print_table(
        heading(case.static, len(run.legs)),
        ("", *(f"quasi-static{side}" for side in sides), "dynamic"),
        [*zip(names, *columns, dynamic, strict=True)],
    )
    print_budget(*case.statics)
    quasi, measured = (turn_rows(each) for each in (case.static.summary(), turn_summary(case)))
    turn = [(name, value, other) for (name, value), (_, other) in zip(quasi, measured, strict=True)]
    together = "dynamic" if len(run.legs) == 1 else "dynamic, both legs"
    print_table("The turn", ("", f"quasi-static{sides[0]}", together), turn)
    print_forces(case.joint_forces)
    print_table("Checks", ("check", "value", "limit", "verdict"), check_rows(case.checks))
    if verbose:
        terms = [(name.replace("_", " "), f"{value:.5f}") for name, value in run.energy.as_json().items()]
        print_table("Energy over the measured turns", ("term", "J"), terms)
        print_table("Constraint forces", ("loop", "mean N", "largest N"), force_rows(run.loop_force))
    for each in case.statics:
        print_notes(each, f"{each.moments.name}: " if len(case.statics) > 1 else "")
    conclude_checks("Dynamic and static", case.checks, f": mean power differs by {case.difference_text}")


def _results(case: Case, folder: Path, inputs: Sequence[Path]) -> list[Path]:
    """Where result, cycle and model go. Raises InputError, before anything runs, if files of others are there."""
    from fes_mj.simulation.export import MARKS

    require_folder(folder, "the results")
    marks = {"json": '"group": ', "csv": ",inverse_dynamics_power_W,", "xml": MARKS["model"]}
    paths = {folder / f"{case.design.name}-{case.moments.name}.{suffix}": mark for suffix, mark in marks.items()}
    for path, mark in paths.items():
        require_replaceable(path, "the results", mark, inputs)
    return [*paths]


def _write(case: Case, result: Path, cycle: Path, model: Path) -> None:
    from fes_mj.crosscheck.turn_output import cycle_csv
    from fes_mj.simulation.export import mjcf_text
    from fes_mj.simulation.mjcf import build_mjcf

    spec = build_mjcf(case.design, cadence=case.cadence, timestep=case.simulation.timestep, legs=case.legs)
    write_files({result: _content(case), cycle: cycle_csv(case), model: mjcf_text(spec)})

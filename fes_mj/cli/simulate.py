"""`fes_mj simulate`: generate the model, run it, measure, compare with statics, say whether they agree."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from fes_mj.cli.options import RunOptions
from fes_mj.cli.static import force_rows, heading, print_notes, rows, span, with_error
from fes_mj.console import number, output, print_table, say, verdict
from fes_mj.errors import InputError
from fes_mj.files import json_text, require_folder, require_writable, write_text
from fes_mj.time_step import LONGEST_TIMESTEP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fes_mj.checks import Check
    from fes_mj.crosscheck import Case

_DEFAULTS = RunOptions()
MOST_TURNS = 1000


def simulate(
    design: str,
    /,
    *,
    options: RunOptions = _DEFAULTS,
    render: Path | None = None,
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
    loaded = options.load(design)
    _check(render, out, timestep, turns)
    from fes_mj.crosscheck import Case

    case = Case(*loaded, timestep, turns, legs)
    if out:
        _write(case, out)
    if options.json:
        sys.stdout.write(json_text(case.summary()))
    elif not options.quiet:
        _print(case, options.verbose)
    if render:
        from fes_mj.viewing.render import render_video

        render_video(case, render, quiet=options.quiet)
        if not options.silent:
            say(f"video: {render}")
    return 0 if case.agrees else 1


def _check(render: Path | None, out: Path | None, timestep: float | None, turns: int) -> None:
    """Refuse unusable options before anything runs."""
    if render:
        require_writable(render, "the video", ".mp4")
    if out:
        require_folder(out, "the results")
    if timestep is not None and not 0 < timestep <= LONGEST_TIMESTEP:
        raise InputError(f"--timestep is {timestep:g}; it must be above 0 and at most {LONGEST_TIMESTEP:g} s")
    if not 1 <= turns <= MOST_TURNS:
        raise InputError(f"--turns is {turns}; it must be from 1 to {MOST_TURNS}")


def check_rows(checks: Sequence[Check]) -> list[tuple[str, str, str, str]]:
    """Name, value, limit and verdict of checks, as text."""
    return [
        (each.name, number(each.value, each.unit), number(each.limit, each.unit), verdict(each.ok)) for each in checks
    ]


def _print(case: Case, verbose: bool) -> None:
    run = case.simulation
    dynamic = (
        with_error(run.power_mean, case.static.power_sd),  # the mean is the same functional of the moments
        f"{2 * np.pi * run.power_mean / run.cadence:.3f}",
        *(span(ends) for ends in run.joint_range_deg),
    )
    both = [(name, value, other) for (name, value), other in zip(rows(case.static), dynamic, strict=True)]
    print_table(heading(case.static, len(run.legs)), ("", "quasi-static", "dynamic"), both)
    print_table("Checks", ("check", "value", "limit", "verdict"), check_rows(case.checks))
    if verbose:
        terms = [(name.replace("_", " "), f"{value:.5f}") for name, value in run.energy.as_json().items()]
        print_table("Energy over the measured turns", ("term", "J"), terms)
        print_table("Constraint forces", ("loop", "mean N", "largest N"), force_rows(run.loop_force))
    print_notes(case.static)
    if case.agrees:
        output.print(f"[bold green]Dynamic and static agree[/]: mean power differs by {case.difference_text}.")
    else:
        failed = ", ".join(check.name for check in case.checks if not check.ok)
        output.print(f"[bold red]Dynamic and static do not agree[/]: {failed}; `fes_mj explain CHECK` says more.")


def _write(case: Case, out: Path) -> None:
    """Result, cycle and model, each whole or not at all."""
    from fes_mj.simulation.export import mjcf_text
    from fes_mj.simulation.mjcf import build_mjcf

    run, stem = case.simulation, f"{case.design.name}-{case.moments.name}"
    model = build_mjcf(case.design, cadence=case.cadence, timestep=run.timestep, legs=case.legs)
    write_text(out / f"{stem}.json", json_text(case.summary()))
    write_text(out / f"{stem}.csv", case.cycle_csv())
    write_text(out / f"{stem}.xml", mjcf_text(model))

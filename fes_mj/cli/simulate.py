"""`fes_mj simulate`: generate the model, run it, measure, compare with statics, say whether they agree."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fes_mj.cli.options import Loaded, RunOptions
from fes_mj.cli.output import json_text, number, output, print_json, print_table, verdict
from fes_mj.cli.static import heading, print_notes, rows, summary, with_error
from fes_mj.errors import InputError
from fes_mj.files import require_folder, require_writable, write_text

if TYPE_CHECKING:
    from fes_mj.crosscheck import CrossCheck

_DEFAULTS = RunOptions()
LONGEST_TIMESTEP = 0.02  # s
MOST_TURNS = 1000
MOST_STEPS = 4_000_000  # of one run; its record takes a gigabyte


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
        Step of the simulation in s, rounded to a whole number of steps per turn. By default near 0.00025, and
        a quarter or a sixteenth of it for a linkage that moves too sharply for that.
    turns
        Measured turns.
    legs
        One leg, or two half a turn apart on the same crank.
    """
    loaded = options.load(design)
    _check(render, out, timestep, turns)
    _check_steps(loaded.cadence, timestep, turns)
    from fes_mj.crosscheck import cross_check, refined_cross_check

    fixed: dict[str, Any] = {"cadence": loaded.cadence, "turns": turns, "legs": legs}
    if timestep is None:
        result = refined_cross_check(loaded.design, loaded.moments, **fixed)
    else:
        result = cross_check(loaded.design, loaded.moments, timestep=timestep, **fixed)
    if out:
        _write(result, out)
    if options.json:
        print_json(_summary(result))
    elif not options.quiet:
        _print(result, loaded, options.verbose)
    if render:
        from fes_mj.render import render_video

        render_video(result, render, quiet=options.quiet)
        if not (options.json or options.quiet):
            output.print(f"video: {render}", markup=False, soft_wrap=True)
    return 0 if result.agrees else 1


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


def _check_steps(cadence: float, timestep: float | None, turns: int) -> None:
    """Refuse runs whose record would not fit into memory."""
    from fes_mj.mjcf import steps_per_turn

    steps = turns * steps_per_turn(cadence, timestep)
    if steps > MOST_STEPS:
        raise InputError(
            f"--turns {turns} would take {steps:.3g} time steps; at most {MOST_STEPS:.0e} fit into memory: "
            "give fewer turns or a longer --timestep"
        )


def _summary(result: CrossCheck) -> dict[str, Any]:
    run, energy = result.simulation, result.simulation.energy
    return summary(result.static) | {
        "power_mean_W": run.power_mean,
        "work_per_turn_J": 2 * np.pi * run.power_mean / run.cadence,
        "knee_range_deg": _range(run.joint_angle, "knee"),
        "hip_range_deg": _range(run.joint_angle, "hip"),
        "static_power_mean_W": result.static.power_mean,
        "relative_difference": result.relative_difference,
        "loop_gap_max_m": run.loop_gap_max,
        "cadence_ripple": run.cadence_ripple,
        "agrees": result.agrees,
        "checks": [
            {"name": check.name, "value": check.value, "limit": check.limit, "unit": check.unit, "ok": check.ok}
            for check in result.checks
        ],
        "legs": len(run.legs),
        "turns": run.turns,
        "timestep_s": run.timestep,
        "loop_force_max_N": {loop: float(np.abs(force).max()) for loop, force in run.loop_force.items()},
        "energy_J": {
            "joint_work": energy.joint_work,
            "crank_work": energy.crank_work,
            "kinetic": energy.kinetic,
            "potential": energy.potential,
            "lost": energy.lost,
        },
        "versions": {name: version(name) for name in ("fes-mj", "mujoco", "numpy")},
    }


def _range(angles: dict[str, Any], joint: str) -> list[float]:
    both = np.degrees([angle for name, angle in angles.items() if name.endswith(joint)])
    return [float(both.min()), float(both.max())]


def _print(result: CrossCheck, loaded: Loaded, verbose: bool) -> None:
    run = result.simulation
    knee, hip = _range(run.joint_angle, "knee"), _range(run.joint_angle, "hip")
    dynamic = (
        with_error(run.power_mean, result.static.power_sd),  # the mean is the same functional of the moments
        f"{2 * np.pi * run.power_mean / run.cadence:.3f}",
        f"{knee[0]:.1f} to {knee[1]:.1f}",
        f"{hip[0]:.1f} to {hip[1]:.1f}",
    )
    both = [(name, value, other) for (name, value), other in zip(rows(result.static), dynamic, strict=True)]
    print_table(heading(result.static, len(run.legs)), ("", "quasi-static", "dynamic"), both)
    print_table(
        "Checks",
        ("check", "value", "limit", "verdict"),
        [
            (check.name, number(check.value, check.unit), number(check.limit, check.unit), verdict(check.ok))
            for check in result.checks
        ],
    )
    if verbose:
        _print_details(result)
    print_notes(result.static)
    if result.refinements:
        step = 1e3 * result.simulation.timestep
        output.print(f"note: the default step left a check failing; this is with {step:.3g} ms")
    if result.agrees:
        output.print(f"[bold green]Dynamic and static agree[/]: mean power differs by {result.difference_text}.")
    else:
        failed = ", ".join(check.name for check in result.checks if not check.ok)
        output.print(f"[bold red]Dynamic and static do not agree[/]: {failed}; `fes_mj explain CHECK` says more.")


def _print_details(result: CrossCheck) -> None:
    run, energy = result.simulation, result.simulation.energy
    terms = {
        "joint work": energy.joint_work,
        "crank work": energy.crank_work,
        "kinetic, change": energy.kinetic,
        "potential, change": energy.potential,
        "lost": energy.lost,
    }
    print_table("Energy over the measured turns", ("term", "J"), [(name, f"{v:.5f}") for name, v in terms.items()])
    forces = {loop.replace("_", " "): np.abs(force) for loop, force in run.loop_force.items()}
    cells = [(name, f"{force.mean():.1f}", f"{force.max():.1f}") for name, force in forces.items()]
    print_table("Constraint forces", ("loop", "mean N", "largest N"), cells)


def _write(result: CrossCheck, out: Path) -> None:
    """Result, cycle and model, each whole or not at all."""
    from fes_mj.crosscheck import cycle_csv
    from fes_mj.export import mjcf_text

    run = result.simulation
    stem = f"{run.design.name}-{run.moments.name}"
    model = mjcf_text(run.design, cadence=run.cadence, timestep=run.timestep, legs=len(run.legs))
    write_text(out / f"{stem}.json", json_text(_summary(result)))
    write_text(out / f"{stem}.csv", cycle_csv(result))
    write_text(out / f"{stem}.xml", model)

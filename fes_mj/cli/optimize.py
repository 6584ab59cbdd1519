"""`fes_mj optimize`: new designs within the limits of the paper, each winner simulated."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.output import output, print_json, print_table, progress_bar
from fes_mj.design import Design
from fes_mj.design_file import design_toml, load_design
from fes_mj.errors import InputError
from fes_mj.files import require_writable, write_text
from fes_mj.torque import GROUPS, JointMoments, load_moments

if TYPE_CHECKING:
    from fes_mj.optimization.pareto import Front
    from fes_mj.optimization.problem import Problem
    from fes_mj.optimization.winner import Winner

Methods = Literal["differential-evolution", "cma-es", "nsga-ii", "random-pursuit"]
_PARETO_BUDGET = 50_000


def optimize(
    kind: Literal["crt", "cdt"],
    /,
    *,
    group: Literal["p1p2", "p1p3"] | None = None,
    moments: Path | None = None,
    method: Methods = "differential-evolution",
    budget: int | None = None,
    searches: int = 4,
    seed: int = 0,
    start: str | None = None,
    speeds_of: str = "trt",
    knee_speed_limit: float | None = None,
    hip_speed_limit: float | None = None,
    caution: float = 0.0,
    smooth: Annotated[bool, Parameter(negative="")] = False,
    problem: Path | None = None,
    jobs: int = 1,
    cluster: str | None = None,
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    report: Path | None = None,
    json: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False,
) -> int:
    """Find the linkage with the most mean crank power; exit code 1 if its simulation disagrees with statics.

    Parameters
    ----------
    kind
        Which six-bar: crt (pedal on the rocker) or cdt (pedal on the coupler).
    group
        Rider group whose recovered joint moments are used (default p1p2); nsga-ii weighs both.
    moments
        Your own joint moments instead: a CSV with the header crank_angle_deg,knee_Nm,hip_Nm.
    method
        The method; cma-es and nsga-ii come with the extra `optimize`.
    budget
        Evaluations of each search (default 50,000; random pursuit stops by itself).
    searches
        Independent searches, of which the best counts (nsga-ii makes one).
    seed
        Of the random numbers; the same seed finds the same design, however many jobs.
    start
        A feasible design to start from (trt, r1, ..., or a file); by default random ones.
    speeds_of
        The design whose mean joint speeds are the limits, and whose power is compared.
    knee_speed_limit
        Largest mean absolute knee speed in deg/s instead (107.1 in the TRT).
    hip_speed_limit
        Largest mean absolute hip speed in deg/s instead (69.1 in the TRT).
    caution
        Take so many standard deviations of the gain off it: finds designs that win for sure (not with --moments).
    smooth
        With nsga-ii: also the least coefficient of fluctuation.
    problem
        Your own limits, search ranges and design space: an edited copy of optimization.toml.
    jobs
        Processes; each search is a task.
    cluster
        Dask scheduler, tcp://host:port, to send the searches to.
    out
        The design file to write (.toml); its model (.xml), and the front (.csv), appear beside it.
    report
        A page on the design (.html): numbers, motion, power, constraints.
    json
        Print one JSON object and nothing else.
    quiet
        Print nothing.
    """
    _check(budget, searches, seed, caution, moments, group, smooth, method)
    _check_files(out, report)
    from fes_mj.optimization.parallel import Workers
    from fes_mj.optimization.winner import assess

    given = load_moments(moments or group or "p1p2")
    rival = load_design(speeds_of)
    first = load_design(start) if start else None
    if first and first.linkage.kind != kind:
        raise InputError(f"--start {start} is a {first.linkage.kind}, not a {kind}; start from a design of that kind")
    task = _problem(kind, given, rival, first, problem, caution, (knee_speed_limit, hip_speed_limit))
    name = out.stem if out else f"{kind}-{given.name}"
    front = None
    if method == "nsga-ii":
        sets = tuple(load_moments(each) for each in GROUPS)
        front, x, evaluations = _front(task, sets, budget or _PARETO_BUDGET, seed, smooth)
    else:
        options = {"searches": searches, "budget": budget, "seed": seed, "workers": Workers(jobs, cluster)}
        x0 = task.variables(first) if first else None
        x, evaluations = _search(task, method, quiet or json, start=x0, **options)
    design = task.design(x, name)
    told = f"Found by fes_mj optimize {kind} --method {method} --seed {seed}, {evaluations} evaluations."
    files = _write(design, front, out, told) if out else {}  # first: what was found stays, whatever its simulation does
    winner = assess(design, rival, given, seed)
    if report:
        from fes_mj.optimization.page import page_html

        write_text(report, page_html(winner, told, rows(winner), limits_table(task, x), task.limits.space))
        files["report"] = str(report)
    if json:
        print_json(_summary(winner, task, x, method, evaluations, front) | {"design_file": None, **files})
    elif not quiet:
        _print(winner, task, x, method, evaluations, front)
        for what, file in files.items():
            output.print(f"{what.replace('_', ' ')}: {file}", markup=False, soft_wrap=True)
    return 0 if winner.check.agrees else 1


def _check(
    budget: int | None,
    searches: int,
    seed: int,
    caution: float,
    moments: Path | None,
    group: str | None,
    smooth: bool,
    method: str,
) -> None:
    """Refuse unusable options before anything runs."""
    if group and moments:
        raise InputError("--group and --moments exclude each other; a file of moments is a group of its own")
    if budget is not None and budget < 1000:
        raise InputError(f"--budget is {budget}; it must be at least 1000 evaluations (a second makes 50,000)")
    if searches < 1:
        raise InputError(f"--searches is {searches}; it must be at least 1")
    if seed < 0:
        raise InputError(f"--seed is {seed}; it must not be negative")
    if not 0 <= caution <= 10:
        raise InputError(f"--caution is {caution:g}; it must be from 0 to 10 standard deviations")
    if caution and (moments or method == "nsga-ii"):
        raise InputError(
            "--caution needs the error bars of one group's recovered moments: not with --moments or nsga-ii"
        )
    if smooth and method != "nsga-ii":
        raise InputError("--smooth is an objective of its own: it needs --method nsga-ii")


def _check_files(out: Path | None, report: Path | None) -> None:
    """Refuse files that could not be written, before anything runs."""
    if out:
        require_writable(out, "the design", ".toml")
    if report:
        from fes_mj.optimization.page import require_packages

        require_writable(report, "the page", ".html")
        require_packages()


def _problem(
    kind: str,
    moments: JointMoments,
    rival: Design,
    start: Design | None,
    file: Path | None,
    caution: float,
    speeds: tuple[float | None, float | None],
) -> Problem:
    """The problem that the options describe."""
    from fes_mj.optimization.confidence import uncertain_table
    from fes_mj.optimization.cycles import WorkTable, cycles, joint_speeds
    from fes_mj.optimization.problem import Problem
    from fes_mj.optimization.problem_file import DEFAULT, load_limits

    limits = load_limits(file or DEFAULT)
    table = uncertain_table(moments) if caution else WorkTable.of(moments)
    # the rider, seat and coupler angle of the start, or of the printed six-bars
    template = start or load_design("r1" if kind == "crt" else "d1")
    own = joint_speeds(rival, table)
    # a hair above, so that the design itself is within its own limits
    knee, hip = (
        own[joint] * (1 + 1e-9) if given is None else given
        for joint, given in zip(("knee", "hip"), speeds, strict=True)
    )
    baseline = cycles(rival, table).work[0] * rival.linkage.cadence / (2 * math.pi)
    return Problem(template, table, limits, knee, hip, caution, baseline)


def _search(task: Problem, method: str, silent: bool, **options: Any) -> tuple[Any, int]:
    from fes_mj.optimization.optimize import optimize as run

    with progress_bar(f"{method}, searches", options["searches"], silent) as advance:
        results = run(task, method, progress=lambda _: advance(1), **options)
    return results[0].x, sum(result.evaluations for result in results)


def _front(
    task: Problem, sets: tuple[JointMoments, ...], budget: int, seed: int, smooth: bool
) -> tuple[Front, Any, int]:
    """The front, and of it the design with the most power averaged over both groups (the paper's recommendation)."""
    from fes_mj.optimization.cycles import WorkTable
    from fes_mj.optimization.pareto import pareto_front

    front = pareto_front(replace(task, table=WorkTable.of(*sets), baseline=0.0), sets, budget, seed, smooth)
    return front, front.x[int(np.argmax(front.power.mean(axis=1)))], front.evaluations


def _summary(
    winner: Winner, task: Problem, x: Any, method: str, evaluations: int, front: Front | None
) -> dict[str, Any]:
    evaluation, check = task.evaluate(x[None]), winner.check
    summary: dict[str, Any] = {
        "kind": winner.design.linkage.kind,
        "group": check.static.moments.name,
        "method": method,
        "power_mean_W": check.static.power_mean,
        "work_per_turn_J": check.static.work_per_turn,
        "cadence_rpm": check.static.cadence * 30 / math.pi,
        "feasible": bool(evaluation.feasible[0]),
        "violations": task.violations(evaluation),
        "evaluations": evaluations,
        "mean_knee_speed_deg_s": winner.speeds["knee"],
        "mean_hip_speed_deg_s": winner.speeds["hip"],
        "reversals_per_turn": winner.reversals,
        "simulated_power_mean_W": check.simulation.power_mean,
        "relative_difference": check.relative_difference,
        "timestep_s": check.simulation.timestep,
        "agrees": check.agrees,
        "compared_with": winner.rival.name,
        "gain_W": winner.gain.mean if winner.gain else None,
        "gain_deviation_W": winner.gain.deviation if winner.gain else None,
        "tolerance_manufacturing": winner.manufacturing._asdict(),
        "tolerance_rider": winner.rider._asdict(),
        "design_space": task.limits.space,
    }
    if front:
        summary["front"] = [
            {"power_mean_W": dict(zip(GROUPS, power, strict=True)), "x": list(row)}
            | ({} if front.fluctuation is None else {"fluctuation": front.fluctuation[number]})
            for number, (power, row) in enumerate(zip(front.power.tolist(), front.x.tolist(), strict=True))
        ]
    return summary


def rows(winner: Winner) -> list[tuple[str, str]]:
    """What was found out about a winner, as text."""
    check, static = winner.check, winner.check.static
    found = [
        ("mean crank power by statics, W", f"{static.power_mean:.3f}"),
        ("mean crank power simulated, W", f"{check.simulation.power_mean:.3f}"),
        ("time step of the simulation, ms", f"{1e3 * check.simulation.timestep:.3g}"),
        ("work per turn, J", f"{static.work_per_turn:.3f}"),
        ("cadence, rpm", f"{static.cadence * 30 / math.pi:.1f}"),
        ("mean knee speed, deg/s", f"{winner.speeds['knee']:.1f}"),
        ("mean hip speed, deg/s", f"{winner.speeds['hip']:.1f}"),
        ("reversals of knee and hip in a turn", f"{winner.reversals['knee']}, {winner.reversals['hip']}"),
    ]
    if winner.gain:
        found.append((f"gain over {winner.rival.name}, W", f"{winner.gain.mean:+.2f} ± {winner.gain.deviation:.2f}"))
    for what, tolerance in (("lengths ±1 mm", winner.manufacturing), ("thigh, shank ±5 cm", winner.rider)):
        found.append((f"{what}: can turn", f"{100 * tolerance.turning:.1f} %"))
        found.append((f"{what}: 5th percentile of power, W", f"{tolerance.power_low:.2f}"))
    return found


def limits_table(task: Problem, x: Any) -> list[tuple[str, str, str, str]]:
    """Constraint, value, limit and whether it is active, as text."""
    evaluation = task.evaluate(x[None])
    return [
        (
            f"{c.name.replace('_', ' ')}, {c.unit}".rstrip(", "),
            f"{value:.4g}",
            f"{'>=' if c.at_least else '<='} {c.limit:.4g}",
            "active" if abs(margin) < 0.01 * c.scale else "",
        )
        for c, value, margin in zip(task.constraints, evaluation.values[0], evaluation.margins[0], strict=True)
    ]


def _print(winner: Winner, task: Problem, x: Any, method: str, evaluations: int, front: Front | None) -> None:
    title = f"{winner.design.name}: {winner.design.linkage.architecture.title}; {winner.check.static.moments.name}"
    print_table(f"{title}; {method}, {evaluations:,} evaluations", ("", "value"), rows(winner))
    print_table("Constraints", ("constraint", "value", "limit", ""), limits_table(task, x))
    if front:
        keep = np.unique(np.linspace(0, len(front.x) - 1, 12).astype(int))
        cells = [(f"{number}", *(f"{power:.2f}" for power in front.power[number])) for number in keep]
        print_table(f"Front, {len(keep)} of {len(front.x)} designs", ("design", *(f"{g}, W" for g in GROUPS)), cells)
    if winner.gain and winner.gain.mean > 0 and not winner.gain.beyond_error:
        output.print(
            "note: the gain is within the error bar of the recovered moments; --caution 1 looks for a surer one"
        )
    if winner.reversals["knee"] > 2:
        output.print("note: the knee swings more than once per turn of the crank; can the muscles follow?")
    output.print("note: the design space is an assumption, see --problem", soft_wrap=True)


def _write(design: Design, front: Front | None, out: Path, told: str) -> dict[str, str]:
    """Design file, model, and the front as CSV; each whole or not at all."""
    from fes_mj.export import mjcf_text
    from fes_mj.optimization.problem_file import VARIABLES

    write_text(out, design_toml(design, told))
    model = out.with_suffix(".xml")
    write_text(model, mjcf_text(design))
    files = {"design_file": str(out), "model_file": str(model)}
    if front:
        table = np.column_stack([front.power, front.x])
        lines = [",".join([*(f"power_{group}_W" for group in GROUPS), *VARIABLES])]
        lines += [",".join(f"{value:.6g}" for value in row) for row in table.tolist()]
        files["front_file"] = str(out.with_name(f"{out.stem}-front.csv"))
        write_text(Path(files["front_file"]), "\n".join(lines) + "\n")
    return files

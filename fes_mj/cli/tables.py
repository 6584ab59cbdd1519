"""What several commands print of a turn and of checks."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from rich.text import Text

from fes_mj.common.arrays import ComplexArray
from fes_mj.common.checks import Check
from fes_mj.common.console import check_word, conclude, number, print_table, say
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import CRANK_ZERO
from fes_mj.statics.friction import BearingLoss
from fes_mj.statics.joint_forces import JointForces, KneeLoad, peaks
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import DrivenTurn, QuasiStatic


def heading(result: DrivenTurn, legs: int = 1) -> str:
    """Which design, what drives it, how fast."""
    which = "one leg" if legs == 1 else "two legs, values of one"
    return f"{what_moves(result.design, result.driver)}; {result.cadence / RPM:.1f} rpm; {which}"


def what_moves(design: Design, driver: str) -> str:
    """Which design, what drives it."""
    return f"{design.name}, {design.linkage.title}; {driver}"


def power_rows(result: DrivenTurn) -> list[tuple[str, str]]:
    """Quantity and quasi-static value, as text."""
    of = "riders" if isinstance(result, MuscleStatic) else "moments"
    part = "" if result.power_sd is None else f" (+-: {of} alone)"
    return [
        (f"mean crank power, W{part}", with_error(result.power_mean, result.power_sd)),
        ("work per turn, J", f"{result.work_per_turn:.3f}"),
        *((f"{joint} angle, deg", span(ends)) for joint, ends in result.joint_range_deg.items()),
    ]


def turn_rows(summary: Mapping[str, Any]) -> list[tuple[str, str]]:
    """How even the power is, how well the linkage transmits, how large it is, as text."""
    return [
        ("inactive zone, % of the turn", f"{100 * summary['inactive_zone_share']:.1f}"),
        ("power peak to peak, W", f"{summary['power_peak_to_peak_W']:.1f}"),
        ("power peak to mean", f"{summary['power_peak_to_mean']:.2f}"),
        ("coefficient of fluctuation of energy", f"{summary['energy_fluctuation']:.3f}"),
        ("smallest transmission angle, deg", f"{summary['transmission_angle_min_deg']:.1f}"),
        ("length x height, cm", f"{100 * summary['length_m']:.0f} x {100 * summary['height_m']:.0f}"),
    ]


def say_stimulation(result: MuscleStatic) -> None:
    """Print when each group is stimulated, where the rule has windows."""
    windows = result.windows_deg or {}
    ends = {group: "never" if pair is None else "{:.0f} to {:.0f}".format(*pair) for group, pair in windows.items()}
    if ends:
        windows_text = ", ".join(f"{group} {pair}" for group, pair in ends.items())
        say(f"stimulated, deg of crank, 0 where {CRANK_ZERO}: {windows_text}")


def print_forces(joint_forces: JointForces) -> None:
    """Print the peak forces of the joints, the knee's load in body weights; joint_forces.NET_FORCE is left out."""
    both = (joint_forces.static.reactions, joint_forces.with_masses)
    cells = [(joint.replace("_", " "), *(f"{peaks(forces)[joint]:.0f}" for forces in both)) for joint in both[0]]
    knees = [joint_forces.knee(forces) for forces in both]
    cells += [
        (f"knee {kind}, body weights", *(f"{getattr(knee, kind):.3f}" for knee in knees)) for kind in KneeLoad._fields
    ]
    print_table("Largest net forces, N", ("joint", "moments alone", "with masses"), cells)


def friction(loss: BearingLoss) -> str:
    """What the bearings of one leg's linkage lose, in words."""
    return f"lost in the bearings: {loss.power:.3f} W, {loss.forces.static.power_mean - loss.power:.3f} W left"


def print_friction(loss: BearingLoss | None) -> None:
    """Print what each bearing of one leg's linkage loses, if there is friction."""
    if loss:
        rows = [(joint.replace("_", " "), f"{power:.3f}") for joint, power in loss.by_joint.items()]
        print_table("Friction in the bearings", ("bearing", "loss, W"), rows)


def beside(*results: list[tuple[str, str]]) -> list[tuple[str, ...]]:
    """Rows of several results as one table: the quantity, then what it is in each."""
    return [(rows[0][0], *(value for _, value in rows)) for rows in zip(*results, strict=True)]


def span(ends: Sequence[float]) -> str:
    """A range of numbers."""
    return f"{ends[0]:.1f} to {ends[1]:.1f}"


def with_error(power: float, deviation: float | None) -> str:
    """A power in W, with its standard deviation where that is known."""
    return f"{power:.3f}" if deviation is None else f"{power:.2f} +- {deviation:.2f}"


def or_dash(value: float | None, spec: str, missing: str = "-") -> str:
    """A number as text, or what stands for one that is missing."""
    return missing if value is None else format(value, spec)


def force_rows(forces: Mapping[str, ComplexArray]) -> list[tuple[str, str, str]]:
    """Mean and largest size of forces over the turn, N."""
    sizes = {name.replace("_", " "): np.abs(force) for name, force in forces.items()}
    return [(name, f"{size.mean():.1f}", f"{size.max():.1f}") for name, size in sizes.items()]


def print_budget(*legs: QuasiStatic) -> None:
    """Print how sure the mean power is, all in all, if the error of the moments is known."""
    from fes_mj.budget.budget import error_budget  # draws hundreds of linkages: as long as all else together

    if budget := error_budget(*legs):
        say(f"error budget of the mean power: {budget.brief}")


def print_notes(result: DrivenTurn, of: str = "") -> None:
    """Print what a reader must know of a result, if anything; of: which one, where there are several."""
    for note in result.notes:
        say(f"note: {of}{note}")
    if isinstance(result, QuasiStatic) and result.extrapolation.verdict:
        conclude(False, f"{of}EXTRAPOLATED", f": {result.extrapolation.verdict}.")


def print_checks(title: str, checks: Sequence[Check]) -> None:
    """Print name, value, limit and verdict of checks; nothing is green where one fails."""
    good = check_word(True) if all(check.ok for check in checks) else "ok"
    rows: list[tuple[str | Text, ...]] = []
    for check in checks:
        value, limit = (number(size, check.unit) for size in (check.value, check.limit))
        rows.append((check.name, value, limit, good if check.ok else check_word(False)))
    print_table(title, ("check", "value", "limit", "verdict"), rows)


def conclude_checks(who: str, checks: Sequence[Check], agreeing: str = "") -> None:
    """Say whether two ways to the same numbers agree, and what more there is to say if they do; the worst is named."""
    failed = ", ".join(check.name for check in checks if not check.ok)
    if failed:
        conclude(False, f"{who} do not agree", f": {failed}; `fes_mj validate --explain CHECK` says more.")
    else:
        worst = max(checks, key=lambda check: check.factor)
        nearest = f"nearest to its limit {worst.name}, at {worst.factor:.2g} of it"
        conclude(True, f"{who} agree", f"{agreeing}; all {len(checks)} checks hold, {nearest}.")

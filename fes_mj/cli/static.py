"""`fes_mj static`: the quasi-static solver alone."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.options import RunOptions
from fes_mj.cli.output import output, print_json, print_table
from fes_mj.statics import QuasiStatic, quasi_static
from fes_mj.torque import reference_ranges

_DEFAULTS = RunOptions()


def static(
    design: str, /, *, options: RunOptions = _DEFAULTS, curves: Annotated[bool, Parameter(negative="")] = False
) -> int:
    """Mean crank power of a design by statics, without masses and without MuJoCo.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    curves
        With --json: also the curves over the turn, 360 points.
    """
    loaded = options.load(design)
    result = quasi_static(*loaded)
    if options.json:
        print_json(summary(result) | (_curves(quasi_static(*loaded, points=360)) if curves else {}))
    elif not options.quiet:
        print_table(heading(result), ("", "quasi-static"), rows(result))
        if options.verbose:
            print_table("Joint reactions", ("joint", "mean N", "largest N"), _reaction_rows(result))
        print_notes(result)
    return 0


def summary(result: QuasiStatic) -> dict[str, Any]:
    """The keys that every result of a run has."""
    return {
        "design": result.design.name,
        "group": result.moments.name,
        "torque_velocity": relation.name if (relation := result.moments.torque_velocity) else None,
        "cadence_rpm": result.cadence * 30 / math.pi,
        "power_mean_W": result.power_mean,
        "power_sd_W": result.power_sd,
        "work_per_turn_J": result.work_per_turn,
        "knee_range_deg": _range(result.knee_angle),
        "hip_range_deg": _range(result.hip_angle),
        "notes": notes(result),
    }


def heading(result: QuasiStatic, legs: int = 1) -> str:
    """Which design, whose moments, how fast."""
    kind = result.design.linkage.architecture.title
    rpm = result.cadence * 30 / math.pi
    which = "one leg" if legs == 1 else "two legs, values of one"
    relation = result.moments.torque_velocity
    faster = f" with the torque-velocity relation of {relation.name.title()}" if relation else ""
    return f"{result.design.name}, {kind}; {result.moments.name}{faster}; {rpm:.1f} rpm; {which}"


def rows(result: QuasiStatic) -> list[tuple[str, str]]:
    """Quantity and quasi-static value, as text."""
    knee, hip = _range(result.knee_angle), _range(result.hip_angle)
    return [
        ("mean crank power, W", with_error(result.power_mean, result.power_sd)),
        ("work per turn, J", f"{result.work_per_turn:.3f}"),
        ("knee angle, deg", f"{knee[0]:.1f} to {knee[1]:.1f}"),
        ("hip angle, deg", f"{hip[0]:.1f} to {hip[1]:.1f}"),
    ]


def with_error(power: float, deviation: float | None) -> str:
    """A power in W, with its standard deviation where that is known."""
    return f"{power:.3f}" if deviation is None else f"{power:.2f} +- {deviation:.2f}"


def notes(result: QuasiStatic) -> list[str]:
    """What a reader must know of the result: joint angles for which the torque map has no data."""
    remarks = []
    angles = {"knee": result.knee_angle, "hip": result.hip_angle}
    for joint, (low, high) in reference_ranges().items():
        beyond = max(low - angles[joint].min(), angles[joint].max() - high)
        if beyond > math.radians(0.01):
            remarks.append(
                f"the {joint} moves {math.degrees(beyond):.1f} deg beyond the range of the moments "
                f"({math.degrees(low):.1f} to {math.degrees(high):.1f} deg); the moment at its end is kept there"
            )
    return remarks


def print_notes(result: QuasiStatic) -> None:
    """Print the notes, if any."""
    for note in notes(result):
        output.print(f"note: {note}", markup=False, soft_wrap=True)


def _curves(result: QuasiStatic) -> dict[str, Any]:
    return {
        "crank_angle_deg": np.arange(360.0),
        "crank_moment_Nm": result.crank_moment,
        "knee_deg": np.degrees(result.knee_angle),
        "hip_deg": np.degrees(result.hip_angle),
    }


def _reaction_rows(result: QuasiStatic) -> list[tuple[str, str, str]]:
    sizes = {point: np.abs(force) for point, force in result.reactions.items()}
    return [(point.replace("_", " "), f"{size.mean():.1f}", f"{size.max():.1f}") for point, size in sizes.items()]


def _range(angle: Any) -> list[float]:
    return [math.degrees(angle.min()), math.degrees(angle.max())]

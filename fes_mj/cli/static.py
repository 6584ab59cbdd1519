"""`fes_mj static`: the quasi-static solver alone."""

import sys
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

from fes_mj.cli.options import RunOptions
from fes_mj.common.console import conclude, print_table, say
from fes_mj.common.units import RPM
from fes_mj.common.writing import json_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import CRANK_ZERO, FROM_TOP, turning
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.joint_forces import NET_FORCE, JointForces, KneeLoad, peaks
from fes_mj.statics.turn import QuasiStatic, quasi_static

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
        Also the curves over the turn: a row every 10 deg, with --json 360 points.
    """
    loaded = options.load(design)
    result = quasi_static(*loaded)
    if options.json:
        from fes_mj.budget.budget import error_budget, summary

        content = result.summary() | summary(error_budget(result)) | JointForces(result).summary()
        sys.stdout.write(json_text(content | (_curves(quasi_static(*loaded, points=360)) if curves else {})))
    elif not options.quiet:
        print_table(heading(result), ("", "quasi-static"), rows(result))
        if options.verbose:
            print_budget(result)
        elif result.power_sd is not None:
            say("+- is the error of the moments alone; --verbose adds the whole error budget")
        print_table("The turn", ("", "quasi-static"), turn_rows(result.summary()))
        print_forces(JointForces(result))
        if options.verbose:
            print_table("Joint reactions", ("joint", "mean N", "largest N"), force_rows(result.reactions))
        if curves:
            _print_curves(_curves(quasi_static(*loaded, points=36)))
        print_notes(result)
    return 0


def heading(result: QuasiStatic, legs: int = 1) -> str:
    """Which design, whose moments, how fast."""
    which = "one leg" if legs == 1 else "two legs, values of one"
    return f"{what_moves(result.design, result.moments)}; {result.cadence / RPM:.1f} rpm; {which}"


def what_moves(design: Design, moments: JointMoments) -> str:
    """Which design, whose moments."""
    relation = moments.torque_velocity
    faster = f" with the torque-velocity relation of {relation.name.title()}" if relation else ""
    return f"{design.name}, {design.linkage.architecture.title}; {moments.name}{faster}"


def rows(result: QuasiStatic) -> list[tuple[str, str]]:
    """Quantity and quasi-static value, as text."""
    return [
        ("mean crank power, W", with_error(result.power_mean, result.power_sd)),
        ("work per turn, J", f"{result.work_per_turn:.3f}"),
        *((f"{joint} angle, deg", span(ends)) for joint, ends in result.joint_range_deg.items()),
    ]


def turn_rows(summary: dict[str, Any]) -> list[tuple[str, str]]:
    """How even the power is, how well the linkage transmits, how large it is, as text."""
    return [
        ("inactive zone, % of the turn", f"{100 * summary['inactive_zone_share']:.1f}"),
        ("power peak to peak, W", f"{summary['power_peak_to_peak_W']:.1f}"),
        ("power peak to mean", f"{summary['power_peak_to_mean']:.2f}"),
        ("coefficient of fluctuation of energy", f"{summary['energy_fluctuation']:.3f}"),
        ("smallest transmission angle, deg", f"{summary['transmission_angle_min_deg']:.1f}"),
        ("length x height, cm", f"{100 * summary['length_m']:.0f} x {100 * summary['height_m']:.0f}"),
    ]


def print_forces(joint_forces: JointForces) -> None:
    """Print the peak forces of the joints, the knee's load in body weights, and what that leaves out."""
    forces = (joint_forces.static.reactions, joint_forces.with_masses)
    cells = [(joint.replace("_", " "), *(f"{peaks(each)[joint]:.0f}" for each in forces)) for joint in forces[0]]
    knees = [joint_forces.knee(each) for each in forces]
    cells += [
        (f"knee {kind}, body weights", *(f"{getattr(knee, kind):.3f}" for knee in knees)) for kind in KneeLoad._fields
    ]
    print_table("Largest forces, N", ("joint", "moments alone", "with masses"), cells)
    say(f"note: {NET_FORCE[0].lower()}{NET_FORCE[1:]}")


def span(ends: list[float]) -> str:
    """A range of angles."""
    return f"{ends[0]:.1f} to {ends[1]:.1f}"


def with_error(power: float, deviation: float | None) -> str:
    """A power in W, with its standard deviation where that is known."""
    return f"{power:.3f}" if deviation is None else f"{power:.2f} +- {deviation:.2f}"


def force_rows(forces: dict[str, Any]) -> list[tuple[str, str, str]]:
    """Mean and largest size of forces over the turn, N."""
    sizes = {name.replace("_", " "): np.abs(force) for name, force in forces.items()}
    return [(name, f"{size.mean():.1f}", f"{size.max():.1f}") for name, size in sizes.items()]


def print_budget(*legs: QuasiStatic) -> None:
    """Print how sure the mean power is, all in all, if the error of the moments is known."""
    from fes_mj.budget.budget import error_budget  # draws hundreds of linkages: as long as all else together

    budget = error_budget(*legs)
    if budget:
        say(f"error budget of the mean power: {budget.text}")


def print_notes(result: QuasiStatic, of: str = "") -> None:
    """Print what a reader must know of a result, if anything; of: which one, where there are several."""
    for note in result.notes:
        say(f"note: {of}{note}")
    if result.extrapolation.verdict:
        conclude(False, f"{of}EXTRAPOLATED", f": {result.extrapolation.verdict}.")


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

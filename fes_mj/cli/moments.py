"""`fes_mj moments`: what is understood of a file of joint moments."""

from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.cli.options import Flag, Out, PrintOptions, warn_of
from fes_mj.cli.tables import span, with_error
from fes_mj.common.console import check_word, print_table, progress_bar, say
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.units import RPM
from fes_mj.common.writing import PICTURES, require_replaceable, require_writable, write_files
from fes_mj.moments.files import load_moments, measurement_toml, moments_csv
from fes_mj.moments.identification import identify_tricycle as identify_tricycle
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.moments.measurement import Measurement, load_measurement, measured_files
from fes_mj.muscles.identification import STAGES
from fes_mj.muscles.posterior import MEMBERS
from fes_mj.muscles.trial import fit_muscles as fit_riders, quantities

_CANDIDATES, _STEPS = 3000, 100  # of a fit of muscles, together a minute on one core


def moments(
    file: str,
    /,
    *,
    options: PrintOptions = PrintOptions(),
    plot: Path | None = None,
    out: Out | None = None,
    identify: Flag = False,
    fit_muscles: Flag = False,
) -> None:
    """Show what is understood of a file of joint moments, and warn of what looks misread.

    Args:
        file: A CSV with the header crank_angle_deg,knee_Nm,hip_Nm, a measurement file (.toml), p1p2 or p1p3.
        plot: Draw the moments over crank angle and over joint angle (.png or .svg).
        out: Write them as plain CSV, a row a degree from top dead centre, and beside it a measurement file (.toml) that
            keeps the tricycle, which a plain CSV does not know.
        identify: Find R1, R2 and the seat's angle from the recorded angles of knee and hip.
        fit_muscles: Find muscles that may have given these moments, and write them with -o (.npz) for `--drive muscles
            --muscles`; takes a minute.
    """
    path = None if file in RIDER_GROUPS else Path(file)
    if fit_muscles and not path:
        raise InputError(f"--fit-muscles: the muscles of {file} are known: --drive muscles --group {file}")
    if fit_muscles and not out:
        raise InputError(
            "--fit-muscles takes a minute and needs a place for what it finds: "
            f"`fes_mj moments {file} --fit-muscles -o RIDER.npz`"
        )
    inputs = measured_files(path) if path else []
    require_writable(plot, "the plot", PICTURES, inputs)
    require_writable(out, *(("the riders", ".npz") if fit_muscles else ("the moments", ".csv")), inputs)
    beside = out.with_suffix(".toml") if out and path and not fit_muscles else None
    require_replaceable([beside] if beside else [], "the tricycle of the moments", inputs)
    measurement = load_measurement(path) if path else Measurement.of(load_moments(file))
    joint_moments = measurement.moments
    warn_of(joint_moments)
    content = measurement.summary()
    if identify:
        numbers = identify_tricycle(measurement.turns, joint_moments.measured_on)
        content["identified"] = [number._asdict() for number in numbers]
    if plot:
        require_extra("report", "matplotlib")
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.moments_plot import moments_figure

        write_figure(plot, moments_figure, measurement)
    if out and fit_muscles:
        content["fitted"] = _fitted(joint_moments, out, options)
    elif out:
        kept = {beside: measurement_toml(joint_moments, out)} if beside else {}
        write_files({out: moments_csv(joint_moments), **kept}, unnamed=kept)
    written = {"riders" if fit_muscles else "moments": out, "measurement_file": beside}
    options.show(lambda: content, lambda: _print(measurement, content, out), plot=plot, **written)


def _fitted(moments: JointMoments, out: Path, options: PrintOptions) -> dict[str, Any]:
    """Write riders who may have given the moments to `out`; what came out, as JSON names it."""
    with progress_bar("riders", STAGES * _CANDIDATES + _STEPS * MEMBERS, options.silent) as advance:
        riders, share = fit_riders(moments, _CANDIDATES, _STEPS, advance=advance)
    riders.save(out)
    return {
        "members": len(riders),
        "explained_share": share,
        "muscles": [row._asdict() | {"identified": row.identified} for row in quantities(riders)],
    }


def _print(measurement: Measurement, content: dict[str, Any], out: Path | None) -> None:
    moments = measurement.moments
    counted = ", ".join(
        f"{content[what]} {what[:-1]}{'s' * (content[what] > 1)}" for what in ("riders", "trials", "turns", "samples")
    )
    rows = [
        ("knee moment, N m (extension positive)", span(content["knee_Nm"])),
        ("hip moment, N m (extension positive)", span(content["hip_Nm"])),
        ("data", counted),
        ("largest gap, deg of crank angle", f"{content['largest_gap_deg']:.1f}"),
        (
            "mean power on the tricycle of the measurement, W",
            with_error(content["power_mean_W"], content["power_sd_W"]),
        ),
        *((f"  of the {joint}, W", f"{power:.3f}") for joint, power in moments.power_mean.items()),
        ("work per turn there, J", f"{content['work_per_turn_J']:.3f}"),
    ]
    print_table(f"{moments.name}, measured on {_tricycle(moments)}", ("", "understood"), rows)
    if measurement.comparisons:
        compared = [
            (row.quantity, row.recorded, row.declared, check_word(row.agrees, "contradicts"))
            for row in measurement.comparisons
        ]
        print_table("Is it plausible?", ("", "recorded", "declared or expected", ""), compared)
    if "identified" in content:
        numbers = [
            (f"{symbol}, {unit}", f"{value:.3f} +- {deviation:.3f}", f"{declared:.3f}")
            for symbol, unit, value, deviation, declared in map(dict.values, content["identified"])
        ]
        print_table("The tricycle by the angles of knee and hip", ("", "identified", "declared"), numbers)
    if "fitted" in content:
        _print_fitted(content["fitted"], out)


def _tricycle(moments: JointMoments) -> str:
    reference = moments.measured_on
    design, top = reference.design, np.degrees(reference.top_dead_centre)
    centre, rider = design.linkage.crank_centre, design.rider
    return (
        f"a traditional tricycle (R1 [{centre.real:.3f}, {centre.imag:.3f}], R2 {design.linkage.crank:.3f}, R6 "
        f"{design.linkage.foot:.3f} m; thigh {rider.thigh:.3f}, shank {rider.shank:.3f} m; top dead centre "
        f"{top:.1f} deg after the crank points backwards) at {reference.cadence / RPM:.2f} rpm"
    )


def _print_fitted(content: dict[str, Any], out: Path | None) -> None:
    """The riders' muscles, posterior beside prior, and what to do with the file."""
    rows = []
    for row in content["muscles"]:
        ends = (f"{middle:.3g} ({low:.3g} to {high:.3g})" for low, middle, high in (row["prior"], row["posterior"]))
        narrowed = f"{row['narrowed_to']:.2f}" if row["identified"] else "not identified"
        rows.append((f"{row['name']}, {row['unit']}", *ends, narrowed))
    print_table("The rider's muscles: median (5 to 95 %)", ("", "before", "by the trial", "narrowed to"), rows)
    say(
        f"{content['members']} riders, who explain {100 * content['explained_share']:.0f} % of the variance of these "
        "moments"
    )
    say(f"go on with: fes_mj static DESIGN --drive muscles --muscles {out}")

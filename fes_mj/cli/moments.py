"""`fes_mj moments`: what is understood of a file of joint moments."""

from pathlib import Path

import numpy as np

from fes_mj.cli.muscle_fit import fitted, print_fitted, require_trial
from fes_mj.cli.options import Flag, Out, PrintOptions, warn_of
from fes_mj.cli.tables import span, with_error
from fes_mj.common.console import print_table, verdict
from fes_mj.common.errors import require_extra
from fes_mj.common.units import RPM
from fes_mj.common.writing import PICTURES, require_replaceable, require_writable, write_files
from fes_mj.moments.files import load_moments, measurement_toml, moments_csv
from fes_mj.moments.identification import Identified, identify as identify_tricycle
from fes_mj.moments.joint_moments import GROUPS, JointMoments
from fes_mj.moments.measurement import Measurement, load_measurement, measured_files


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
    if fit_muscles:
        require_trial(file, out)
    path = None if file in GROUPS else Path(file)
    inputs = measured_files(path) if path else []
    require_writable(plot, "the plot", PICTURES, inputs)
    if fit_muscles:
        require_writable(out, "the riders", ".npz", inputs)
    else:
        require_writable(out, "the moments", ".csv", inputs)
    beside = out.with_suffix(".toml") if out and path and not fit_muscles else None
    require_replaceable([beside] if beside else [], "the tricycle of the moments", inputs)
    measurement = load_measurement(path) if path else Measurement.of(load_moments(file))
    warn_of(measurement.moments)
    numbers = identify_tricycle(measurement.turns, measurement.moments.measured_on) if identify else []
    if plot:
        require_extra("report", "matplotlib")
        from fes_mj.viewing.charts import write_figure
        from fes_mj.viewing.moments_plot import moments_figure

        write_figure(plot, moments_figure, measurement)
    riders = fitted(measurement.moments, out, options) if fit_muscles and out else {}
    if out and not fit_muscles:
        kept = {beside: measurement_toml(measurement.moments, out)} if beside else {}
        write_files({out: moments_csv(measurement.moments), **kept}, unnamed=kept)
    identified = {"identified": [number._asdict() for number in numbers]} if identify else {}

    def tables() -> None:
        _print(measurement, numbers)
        if riders and out:
            print_fitted(riders, out)

    written = {"riders" if riders else "moments": out, "measurement_file": beside}
    options.show(
        lambda: measurement.summary() | identified | ({"fitted": riders} if riders else {}),
        tables,
        plot=plot,
        **written,
    )


def _print(measurement: Measurement, numbers: list[Identified]) -> None:
    content, own = measurement.summary(), measurement.moments
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
        *((f"  of the {joint}, W", f"{power:.3f}") for joint, power in own.power_mean.items()),
        ("work per turn there, J", f"{content['work_per_turn_J']:.3f}"),
    ]
    print_table(f"{own.name}, measured on {_tricycle(own)}", ("", "understood"), rows)
    if measurement.comparisons:
        compared = [
            (row.quantity, row.recorded, row.declared, verdict(row.agrees, "contradicts"))
            for row in measurement.comparisons
        ]
        print_table("Is it plausible?", ("", "recorded", "declared or expected", ""), compared)
    if numbers:
        found = [
            (f"{row.symbol}, {row.unit}", f"{row.identified:.3f} +- {row.sd:.3f}", f"{row.declared:.3f}")
            for row in numbers
        ]
        print_table("The tricycle by the angles of knee and hip", ("", "identified", "declared"), found)


def _tricycle(own: JointMoments) -> str:
    reference = own.measured_on
    design, top = reference.design, np.degrees(reference.top_dead_centre)
    centre, rider = design.linkage.crank_centre, design.rider
    return (
        f"a traditional tricycle (R1 [{centre.real:.3f}, {centre.imag:.3f}], R2 {design.linkage.crank:.3f}, R6 "
        f"{design.linkage.foot:.3f} m; thigh {rider.thigh:.3f}, shank {rider.shank:.3f} m; top dead centre "
        f"{top:.1f} deg after the crank points backwards) at {reference.cadence / RPM:.2f} rpm"
    )

"""Joint moments as they were understood: over crank angle, and over joint angle by direction."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.style import COLOURS, FAINT, literal
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.files import Measurement
from fes_mj.moments.fourier import WIDEST_GAP, fourier, gaps
from fes_mj.moments.torque_map import torque_map

_SAMPLES = 2000  # of a turn that are drawn at most


def moments_figure(measurement: Measurement) -> Figure:
    """Three plots beside each other: both moments over crank angle, either joint's over its own angle."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    over_crank, knee, hip = figure.subplots(1, 3, width_ratios=[1.6, 1, 1])
    _over_crank(over_crank, measurement)
    for axes, joint in ((knee, "knee"), (hip, "hip")):
        _over_joint(axes, measurement, joint)
    title = literal(f"{measurement.moments.name}: joint moments of one leg, extension positive")
    figure.suptitle(title, weight="bold", x=0.01, ha="left")
    figure.legend(*over_crank.get_legend_handles_labels(), loc="outside lower left", ncols=4)
    return figure


def _over_crank(axes: Axes, measurement: Measurement) -> None:
    """Samples of every turn, smooth curves with their standard deviation, both zeros; grey where there is no data."""
    moments, angle = measurement.moments, np.radians(np.arange(361.0))
    for turn in measurement.turns:
        for start, width in zip(*map(np.degrees, gaps(turn.crank_angle)), strict=True):
            if width > np.degrees(WIDEST_GAP):
                for whole in (0, 360):  # the gap can go round the end of the axis
                    axes.axvspan(start - whole, start + width - whole, color=FAINT, alpha=0.12, lw=0)
    curves, terms = moments.at(angle), fourier(angle)
    for joint in JOINTS:
        for turn in measurement.turns:
            step = max(1, len(turn.knee) // _SAMPLES)
            at = np.degrees(turn.crank_angle[::step]) % 360
            axes.plot(at, getattr(turn, joint)[::step], ".", color=COLOURS[joint], ms=4, alpha=0.5)
        axes.plot(np.degrees(angle), curves[joint], color=COLOURS[joint], label=joint)
        if moments.covariance is not None:
            deviation = np.linalg.norm(terms @ moments.deviations[joint], axis=-1)
            ends = curves[joint] - deviation, curves[joint] + deviation
            axes.fill_between(np.degrees(angle), *ends, color=COLOURS[joint], alpha=0.2, lw=0, label="one sd")
    horizontal = float(np.degrees(-moments.measured_on.top_dead_centre) % 360)
    for zero, text in ((0.0, "top dead centre"), (horizontal, "crank points backwards:\nzero of all outputs")):
        axes.axvline(zero, color=FAINT, lw=1, ls=(0, (4, 2)))
        right = zero < 180
        axes.annotate(
            text, (zero, 1.0), xycoords=("data", "axes fraction"), xytext=(4 if right else -4, -4),
            textcoords="offset points", va="top", ha="left" if right else "right", fontsize=8, color=FAINT,
        )  # fmt: skip
    axes.axhline(0, color="black", lw=0.7)
    axes.set(xlim=(0, 360), xticks=range(0, 361, 60))
    axes.set(xlabel="crank angle from top dead centre, deg", ylabel="joint moment, N m")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))  # room for what is written above the curves


def _over_joint(axes: Axes, measurement: Measurement, joint: str) -> None:
    """The torque map of a joint: moment over joint angle, extending and flexing."""
    torque = torque_map(measurement.moments)
    angle = np.linspace(*torque.reference.ranges[joint], 200)
    for label, rate, style in (("extending", 1.0, "-"), ("flexing", -1.0, "--")):
        moment = torque.at_source(joint, torque.source_angle(joint, angle, rate))
        axes.plot(np.degrees(angle), moment, style, color=COLOURS[joint], label=label)
    axes.axhline(0, color="black", lw=0.7)
    axes.set(xlabel=f"{joint} angle, deg")
    axes.set_title(joint, loc="left")
    axes.legend()

"""Joint moments as they were understood: over crank angle, and over joint angle by direction."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fes_mj.common.arrays import FloatArray
from fes_mj.common.style import COLOURS, FAINT, literal
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.fourier import WIDEST_GAP, fourier, gaps
from fes_mj.moments.measurement import Measurement
from fes_mj.moments.recorded_angles import recorded_curve
from fes_mj.moments.torque_map import torque_map
from fes_mj.viewing.charts import legend_of_all

_SAMPLES = 2000  # of a turn that are drawn at most


def moments_figure(measurement: Measurement) -> Figure:
    """Both moments over crank angle, either joint's over its own, and recorded joint angles over the tricycle's."""
    recorded = any(turn.joint_angle for turn in measurement.turns)
    figure = Figure(figsize=(10.0, 7.4 if recorded else 4.2), layout="constrained")
    if recorded:
        axes = figure.subplot_mosaic([["moments", "knee"], ["angles", "hip"]], width_ratios=[1.6, 1])
    else:
        axes = figure.subplot_mosaic([["moments", "knee", "hip"]], width_ratios=[1.6, 1, 1])
    _over_crank(axes["moments"], measurement)
    if recorded:
        _angles(axes["angles"], measurement)
    for joint in JOINTS:
        _over_joint(axes[joint], measurement, joint)
    title = literal(f"{measurement.moments.name}: joint moments of one leg, extension positive")
    figure.suptitle(title, weight="bold", x=0.01, ha="left")
    legend_of_all(figure, axes.values(), loc="outside lower left", ncols=6)
    return figure


def _samples(axes: Axes, joint: str, crank_angle: FloatArray, values: FloatArray) -> None:
    """Samples over the crank angle (rad), faint and behind the curves."""
    step = max(1, len(values) // _SAMPLES)
    at = np.degrees(crank_angle[::step]) % 360
    axes.plot(at, values[::step], ".", color=COLOURS[joint], ms=2, alpha=0.3, zorder=1)


def _from_top(axes: Axes, quantity: str) -> None:
    axes.set(xlim=(0, 360), xticks=range(0, 361, 60), xlabel="crank angle from top dead centre, deg", ylabel=quantity)


def _angles(axes: Axes, measurement: Measurement) -> None:
    """Recorded joint angles over the crank angle, and those of the declared tricycle."""
    angle, reference = np.arange(361.0), measurement.moments.measured_on
    pose = solve(reference.design, np.radians(angle) + reference.top_dead_centre).joint_angle
    for turn in measurement.turns:
        for joint, values in turn.joint_angle.items():
            if turn.pose is not None:
                _samples(axes, joint, turn.pose, np.degrees(values))
    for joint in JOINTS:
        recorded = recorded_curve(measurement.turns, joint)
        if recorded is not None:
            axes.plot(angle[:-1], recorded, color=COLOURS[joint], label=joint)
        axes.plot(angle, np.degrees(pose[joint]), ":", color=COLOURS[joint], label=f"{joint} of the declared tricycle")
    _from_top(axes, "joint angle, deg")


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
            _samples(axes, joint, turn.crank_angle, getattr(turn, joint))
        axes.plot(np.degrees(angle), curves[joint], color=COLOURS[joint], label=joint)
        if moments.covariance is not None:
            deviation = np.linalg.norm(terms @ moments.deviations[joint], axis=-1)
            ends = curves[joint] - deviation, curves[joint] + deviation
            axes.fill_between(np.degrees(angle), *ends, color=COLOURS[joint], alpha=0.2, lw=0, label=f"{joint}, one sd")
    horizontal = float(np.degrees(-moments.measured_on.top_dead_centre) % 360)
    for zero, text in ((0.0, "top dead centre"), (horizontal, "crank points backwards:\nzero of all outputs")):
        axes.axvline(zero, color=FAINT, lw=1, ls=(0, (4, 2)))
        right = zero < 180
        axes.annotate(
            text, (zero, 1.0), xycoords=("data", "axes fraction"), xytext=(4 if right else -4, -4),
            textcoords="offset points", va="top", ha="left" if right else "right", fontsize=8, color=FAINT,
        )  # fmt: skip
    axes.axhline(0, color="black", lw=0.7)
    _from_top(axes, "joint moment, N m")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.25 * (high - low))  # room for what is written above the curves


def _over_joint(axes: Axes, measurement: Measurement, joint: str) -> None:
    """The torque map of a joint: moment over joint angle, extending and flexing."""
    torque = torque_map(measurement.moments)
    angle = np.linspace(*torque.reference.ranges[joint], 200)
    for label, rate, style in ((joint, 1.0, "-"), (f"{joint}, flexing", -1.0, "--")):
        moment = torque.at_source(joint, torque.source_angle(joint, angle, rate))
        axes.plot(np.degrees(angle), moment, style, color=COLOURS[joint], label=label)
    axes.axhline(0, color="black", lw=0.7)
    axes.set(xlabel=f"{joint} angle, deg")
    axes.set_title(f"{joint}, extending and flexing", loc="left")

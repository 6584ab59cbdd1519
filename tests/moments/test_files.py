"""Measurement files: the same moments told in many ways, on many tricycles, and what is refused with which words."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.common.writing import csv_text
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.averaging import mean_of, turn_coefficients, weights_on
from fes_mj.moments.files import load_moments, moments_csv, moments_of, sampled_coefficients, sampled_moments
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.moments.measurement import Measurement, load_measurement, measured_files
from fes_mj.moments.measurement_file import Description
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.simulation.bench import simulate
from fes_mj.simulation.stepping import FORCE_EVERY
from fes_mj.statics.turn import quasi_static
from tools.make_trial import FOLDER, invented, trial

TURN = np.radians(np.arange(360.0))
HEADS = ("crank_angle_deg", "knee_Nm", "hip_Nm")
SLOW = ReferenceTricycle(PAPER_TRICYCLE.design, 47 * RPM)
TRIAL = """[moments]
file = "id.sto"
kinematics = "ik.mot"
knee = "knee_angle_r_moment"
hip = "hip_flexion_r_moment"
extension = { hip = "negative" }
[measured_on]
cadence_rpm = 47
"""


def plain(folder: Path, step: float = 10.0) -> Path:
    """The invented moments as a plain CSV."""
    degrees = np.arange(0, 360, step)
    path = folder / "plain.csv"
    path.write_text(csv_text(dict(zip(HEADS, (degrees, *invented(np.radians(degrees))), strict=True))))
    return path


def described(folder: Path, text: str) -> Path:
    path = folder / "described.toml"
    path.write_text(text)
    return path


def write_trial(folder: Path, measured_on: ReferenceTricycle, turns: float, noise: float, seed: int = 1) -> None:
    for name, text in zip(("ik.mot", "id.sto"), trial(measured_on, turns, noise, seed), strict=True):
        (folder / name).write_text(text)


def power(path: Path) -> float:
    return quasi_static(load_design("d1"), load_moments(path)).power_mean


def test_radians_from_the_horizontal_with_flipped_signs_per_kg(tmp_path: Path) -> None:
    after = np.radians(np.arange(0, 360, 5.0))
    moment = invented(after)
    angle = -(after + PAPER_TRICYCLE.top_dead_centre)  # counted backwards, from the crank pointing backwards
    columns = {"theta": angle, "Mk": -moment.knee / 68.5, "Mh": -moment.hip / 68.5, "comment": 0 * angle}
    (tmp_path / "odd.csv").write_text(csv_text(columns))
    path = described(
        tmp_path,
        '[moments]\nfile = "odd.csv"\ncrank = "theta"\nknee = "Mk"\nhip = "Mh"\nangle_unit = "rad"\n'
        'zero = "horizontal"\nturning = "backward"\nunit = "N m/kg"\n'
        'extension = { knee = "negative", hip = "negative" }\n[measured_on.rider]\nmass = 68.5\n',
    )
    assert power(path) == pytest.approx(power(plain(tmp_path)), rel=1e-3)
    assert load_moments(path).misreadings == ()


@pytest.mark.parametrize("zero", [-90.0, 37.0])
def test_any_zero(zero: float, tmp_path: Path) -> None:
    after = np.arange(0, 360, 5.0)
    (tmp_path / "a.csv").write_text(
        csv_text(dict(zip(HEADS, (after - zero, *invented(np.radians(after))), strict=True)))
    )
    path = described(tmp_path, f'[moments]\nfile = "a.csv"\nzero = {zero}\n')
    assert power(path) == pytest.approx(power(plain(tmp_path)), rel=1e-6)


def test_a_trial_without_noise(tmp_path: Path) -> None:
    """What the knee's dead centre and the sampling cost: less than a thousandth of the power."""
    write_trial(tmp_path, SLOW, 4.4, 0.0)
    assert power(described(tmp_path, TRIAL)) == pytest.approx(power(plain(tmp_path)), rel=1e-3)


def by_scatter(measurement: Measurement) -> JointMoments:
    """The moments with the error that the scatter of their turns has, without that of tape measure and cadence."""
    rows = np.stack([turn_coefficients(turn) for turn in measurement.turns])
    weights = weights_on(measurement.moments.measured_on)
    _, covariance = mean_of(rows, [turn.source for turn in measurement.turns], weights)
    return replace(measurement.moments, covariance=covariance)


@pytest.mark.long
def test_three_noisy_turns_are_within_their_own_error_bar(tmp_path: Path) -> None:
    """Of fifty such trials about 68 % are within one standard deviation, and all within half a percent."""
    exact, within = power(plain(tmp_path)), 0
    for seed in range(50):
        write_trial(tmp_path, SLOW, 3.4, 0.03, seed)
        measurement = load_measurement(described(tmp_path, TRIAL))
        assert len(measurement.turns) == 3
        result = quasi_static(load_design("d1"), by_scatter(measurement), points=720)
        assert result.power_sd is not None
        assert result.power_mean == pytest.approx(exact, rel=5e-3)
        within += abs(result.power_mean - exact) < math.hypot(result.power_sd, 5e-4 * exact)  # beside dead centres
    assert 0.5 < within / 50 < 0.86  # 0.68 +- 2.7 binomial standard deviations


def test_the_error_bar_is_the_scatter_of_the_turns(tmp_path: Path) -> None:
    """Mean power is linear in the moments: its error is that of the mean of the turns' own powers."""
    write_trial(tmp_path, SLOW, 5.4, 0.8)
    measurement = load_measurement(described(tmp_path, TRIAL))
    powers = [
        sum(
            Measurement.of(
                replace(measurement.moments, crank_angle=t.crank_angle, knee=t.knee, hip=t.hip)
            ).moments.power_mean
        )
        for t in measurement.turns
    ]
    assert sum(measurement.moments.power_mean) == pytest.approx(np.mean(powers), rel=1e-6)
    student = stats.t.ppf(stats.norm.cdf(1), len(powers) - 1)  # few turns know their own scatter badly
    assert measurement.declared_sd is not None
    assert measurement.power_sd == pytest.approx(math.hypot(student * stats.sem(powers), measurement.declared_sd))


@pytest.mark.parametrize("turning", ["forward", "backward"])
def test_a_trial_with_a_crank_angle_is_cut_into_turns(turning: str, tmp_path: Path) -> None:
    after = np.radians(np.arange(100.0, 100 + 3 * 360, 4.0))
    angle = np.degrees(after) * (1 if turning == "forward" else -1) % 360
    columns = {"time": after / SLOW.cadence, **dict(zip(HEADS, (angle, *invented(after)), strict=True))}
    (tmp_path / "a.csv").write_text(csv_text(columns))
    path = described(tmp_path, f'[moments]\nfile = ["a.csv", "a.csv"]\nturning = "{turning}"\n')
    assert len(load_measurement(path).turns) == 6
    assert power(path) == pytest.approx(power(plain(tmp_path)), rel=1e-6)
    other = {"forward": "backward", "backward": "forward"}[turning]
    with pytest.raises(InputError, match=r"moments\.turning"):
        load_moments(described(tmp_path, f'[moments]\nfile = "a.csv"\nturning = "{other}"\n'))


def test_moments_have_in_their_own_tricycle_the_power_they_had_there() -> None:
    measurement = load_measurement(FOLDER / "trial.toml")
    reference = measurement.moments.measured_on
    design = replace(reference.design, name="own")
    result = quasi_static(design, measurement.moments, reference.cadence)
    assert reference.design.linkage.crank == 0.13
    assert result.power_mean == pytest.approx(sum(measurement.moments.power_mean), rel=1e-6)
    assert result.power_sd == pytest.approx(measurement.power_sd, rel=1e-6)
    elsewhere = quasi_static(load_design("trt"), measurement.moments, reference.cadence)
    assert abs(elsewhere.power_mean / result.power_mean - 1) > 0.05


def test_defaults_are_the_papers() -> None:
    assert load_moments().measured_on is PAPER_TRICYCLE


def test_the_shipped_trial_is_what_the_tool_makes() -> None:
    written = trial(Description.read(FOLDER / "trial.toml").measured_on, 4.4, 0.8)
    assert written == tuple((FOLDER / name).read_text() for name in ("ik.mot", "id.sto"))
    assert [path.name for path in measured_files(FOLDER / "trial.toml")] == ["trial.toml", "id.sto", "ik.mot"]


def test_the_plain_csv_reads_back(tmp_path: Path) -> None:
    moments = load_moments(plain(tmp_path))
    (tmp_path / "again.csv").write_text(moments_csv(moments))
    angle = np.linspace(0, 2 * np.pi, 1000)
    again = load_moments(tmp_path / "again.csv").at(angle)
    assert np.abs(again.knee - moments.at(angle).knee).max() < 1e-5
    assert np.abs(again.hip - moments.at(angle).hip).max() < 1e-5


def misreadings(folder: Path, change: str) -> set[str]:
    """Names of the warnings for a changed plain file."""
    degrees = np.arange(0, 360, 10.0)
    angle, (knee, hip) = degrees, invented(np.radians(degrees))
    if change == "radians":
        angle = np.radians(degrees)
    elif change == "per kg":
        knee, hip = knee / 75, hip / 75
    elif change == "signs":
        knee, hip = -knee, -hip
    elif change == "knee's sign":
        knee = -knee
    elif change == "half a turn":
        angle, knee, hip = angle[:18], knee[:18], hip[:18]
    path = folder / "a.csv"
    path.write_text(csv_text(dict(zip(HEADS, (angle, knee, hip), strict=True))))
    return {misreading.name for misreading in load_moments(path).misreadings}


@pytest.mark.parametrize(
    ("change", "names"),
    [
        ("nothing", set()),
        ("radians", {"radians", "gap"}),
        ("per kg", {"per_kg"}),
        ("signs", {"negative_power", "exchanged"}),
        ("knee's sign", {"negative_power", "exchanged"}),
        ("half a turn", {"gap"}),
    ],
)
def test_what_looks_misread(change: str, names: set[str], tmp_path: Path) -> None:
    assert misreadings(tmp_path, change) >= names
    if not names:
        assert misreadings(tmp_path, change) == names


def test_degrees_declared_as_radians(tmp_path: Path) -> None:
    plain(tmp_path)
    path = described(tmp_path, '[moments]\nfile = "plain.csv"\nangle_unit = "rad"\n')
    assert "degrees" in {misreading.name for misreading in load_moments(path).misreadings}


REFUSED = [
    ('file = "plain.csv"\nknee = "M"', r"plain\.csv: line 1: .*'M'"),
    ('file = "none.csv"', r"none\.csv: .*No such file"),
    ('knee = "M"', r"moments\.file is missing"),
    ("file = 3", r"moments\.file is 3"),
    ("file = []", r"moments\.file is \[\]"),
    ('file = "plain.csv"\nangle_unit = "grad"', r"moments\.angle_unit is 'grad'"),
    ('file = "plain.csv"\nzero = "bdc"', r"moments\.zero is 'bdc'"),
    ('file = "plain.csv"\nzero = 1000', r"moments\.zero is 1000"),
    ('file = "plain.csv"\nturning = "left"', r"moments\.turning is 'left'"),
    ('file = "plain.csv"\nextension = { ankle = "positive" }', r"unknown key moments\.extension\.ankle"),
    ('file = "plain.csv"\nunit = "N m/kg"', r"measured_on\.rider\.mass is missing; moments\.unit is N m/kg"),
    ('file = "plain.csv"\nunits = "N m"', r"unknown key moments\.units"),
    ('file = "one.csv"', r"one\.csv: 1 row"),
    ('file = "twice.csv"', r"twice\.csv: line 1: .*'hip_Nm'"),
    ('file = "stuck.csv"', r"stuck\.csv: line 4: time is 1 after 1 s"),
    ('file = "short.csv"', r"short\.csv: crank_angle_deg .*200 deg"),
    ('file = "plain.csv"\nkinematics = "ik.mot"\ncrank = "crank_angle_deg"', r"crank angle in two ways"),
    ('file = ["id.sto", "id.sto"]\nkinematics = "ik.mot"', r"names 2 and moments\.kinematics 1 files"),
    ('file = "id.sto"\nkinematics = "none.mot"', r"none\.mot: "),
    ('file = "id.sto"\nkinematics = "ik.mot"', r"id\.sto: line 7: .*'knee_Nm'"),
    ('file = "id.sto"\nkinematics = "ik.mot"\nknee_angle = "hip_l"', r"ik\.mot: line 7: .*'hip_l'"),
    ('file = "late.sto"\nkinematics = "ik.mot"\nknee = "knee_angle_r_moment"\nhip = "hip_flexion_r_moment"',
     r"late\.sto: .*time .*100 to"),
    ('file = "id.sto"\nkinematics = "brief.mot"\nknee = "knee_angle_r_moment"\nhip = "hip_flexion_r_moment"',
     r"brief\.mot: knee_angle_r .*fewer than 2 times"),
    ('file = "headless.sto"', r"headless\.sto: .*'endheader'"),
    ('file = "kinds.sto"\nangle_unit = "deg"', r"kinds\.sto: .*rad, moments\.angle_unit"),
    ('file = "plain.csv"\npedal_force = "F"', r"moments\.pedal_force is 'F'"),
    ('file = "plain.csv"\npedal_force = ["x", "y"]\nknee = "M"', r"moments\.knee and moments\.pedal_force"),
    ('file = "plain.csv"\n[measured_on]\nR2 = 0.6', r"measured_on: .*close"),
    ('file = "plain.csv"\n[measured_on]\nkind = "crt"', r"measured_on\.kind is 'crt'"),
    ('file = "plain.csv"\n[measured_on]\ncadence_rpm = 900', r"measured_on\.cadence_rpm is 900"),
    ('file = "plain.csv"\n[measured_on.rider]\nthigh = 52', r"measured_on\.rider\.thigh is 52; .*centimetres"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_what_cannot_be_used_is_named(text: str, words: str, tmp_path: Path) -> None:
    plain(tmp_path)
    write_trial(tmp_path, SLOW, 2.4, 0.0)
    opensim = (tmp_path / "id.sto").read_text().splitlines()
    late = [f"{float(row.split()[0]) + 100}\t{row.split(chr(9), 1)[1]}" for row in opensim[7:]]
    (tmp_path / "late.sto").write_text("\n".join([*opensim[:7], *late]) + "\n")
    brief = (tmp_path / "ik.mot").read_text().splitlines()
    (tmp_path / "brief.mot").write_text("\n".join(brief[:50]).replace(brief[2], "nRows=43") + "\n")
    (tmp_path / "headless.sto").write_text("time\tcrank_angle_deg\n0\t1\n")
    (tmp_path / "kinds.sto").write_text("a\ninDegrees=no\nendheader\ntime\tcrank_angle_deg\tknee_Nm\thip_Nm\n0 1 1 1\n")
    (tmp_path / "stuck.csv").write_text("time," + ",".join(HEADS) + "\n0,0,1,1\n1,90,2,2\n1,180,1,1\n2,270,1,1\n")
    (tmp_path / "one.csv").write_text("time," + ",".join(HEADS) + "\n0,0,1,1\n")
    (tmp_path / "twice.csv").write_text(",".join([*HEADS, HEADS[-1]]) + "\n0,1,1,1\n90,1,1,1\n200,1,1,1\n")
    (tmp_path / "short.csv").write_text("time," + ",".join(HEADS) + "\n0,0,1,1\n1,100,2,2\n2,200,1,1\n")
    with pytest.raises(InputError, match=words):
        load_moments(described(tmp_path, f"[moments]\n{text}\n"))


def test_each_leg_has_its_own(tmp_path: Path) -> None:
    moments = load_moments("p1p2", "p1p3")
    assert moments.of_leg("right_knee").name == "p1p2"
    assert moments.of_leg("left_knee").name == "p1p3"


def test_pedal_forces_of_a_simulation_give_its_moments_back(tmp_path: Path) -> None:
    """Moments -> MuJoCo -> force at the pedal -> moments by inverse dynamics: the way back knows nothing of MuJoCo."""
    design, moments = load_design("trt"), load_moments("p1p3")
    run = simulate(design, moments)
    force = run.loop_force["pedal"]
    angle = np.degrees(run.crank_angle[::FORCE_EVERY])
    (tmp_path / "pedal.csv").write_text(csv_text({"crank_angle_deg": angle, "Fx": force.real, "Fy": force.imag}))
    linkage, rider = design.linkage, design.rider
    path = described(
        tmp_path,
        '[moments]\nfile = "pedal.csv"\npedal_force = ["Fx", "Fy"]\nzero = "horizontal"\n[measured_on]\n'
        f"R1 = [{linkage.ground.real!r}, {linkage.ground.imag!r}]\nR2 = {linkage.crank!r}\nR6 = {linkage.foot!r}\n"
        f"seat_angle = {math.degrees(linkage.seat_angle)!r}\ngear_ratio = {linkage.gear_ratio!r}\n"
        f"[measured_on.rider]\nthigh = {rider.thigh!r}\nshank = {rider.shank!r}\nmass = {rider.mass!r}\n",
    )
    recovered = load_measurement(path).moments
    given = run.torque.along(kinematics.solve(design, TURN), run.cadence)
    back = recovered.at(TURN - recovered.measured_on.top_dead_centre)
    for joint in JOINTS:
        error = back[joint] - given[joint]
        assert np.sqrt(np.mean(error**2)) < 5e-3 * np.abs(given[joint]).max()
    assert sum(recovered.power_mean) == pytest.approx(run.power_mean, rel=5e-3)


ROUNDING = 0.5e-4  # N m, of the files


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_mean_and_covariance_are_those_of_the_drawn_curves(group: str) -> None:
    curves, shipped = sampled_coefficients(group), fes_mj.load_moments(group)
    assert curves.shape == (1000, 98)
    mean = moments_of(curves.mean(axis=0), group)
    assert np.abs(mean.knee - shipped.knee).max() < 1.01 * ROUNDING
    assert np.abs(mean.hip - shipped.hip).max() < 1.01 * ROUNDING
    assert shipped.covariance is not None
    assert np.allclose(shipped.covariance, np.cov(curves.T), atol=1e-6)


@pytest.mark.parametrize("name", DESIGNS)
def test_power_and_its_error_are_those_of_the_drawn_curves(name: str) -> None:
    """Linear: to the rounding of the files and of the interpolation, not to a sampling error."""
    for group in RIDER_GROUPS:
        shipped = quasi_static(fes_mj.load_design(name), fes_mj.load_moments(group))
        powers = sampled_coefficients(group) @ shipped.power_weights
        assert shipped.power_mean == pytest.approx(powers.mean(), abs=2e-3)
        assert shipped.power_sd == pytest.approx(np.hypot(powers.std(ddof=1), shipped.extrapolation.sd), rel=1e-3)


def test_drawn_moments_are_their_coefficients() -> None:
    moments, curves = sampled_moments("p1p3"), sampled_coefficients("p1p3")
    assert len(moments) == len(curves)
    assert [curve.name for curve in moments[:2]] == ["p1p3 1", "p1p3 2"]
    angle = np.radians([0.0, 7.0, 359.0])
    for number in (0, 17, 999):
        knee, hip = moments[number].at(angle)
        assert knee == pytest.approx(fourier(angle) @ curves[number, :49])
        assert hip == pytest.approx(fourier(angle) @ curves[number, 49:])

"""`--drive muscles`: the promised JSON, and what does not go together."""

import pytest

from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.muscles.riders import load_riders
from tests.cli.conftest import answer, result

MUSCLES = ("--drive", "muscles")


def test_static_of_muscles_has_the_promised_keys(capsys):
    code, content = answer(capsys, "static", "d1", *MUSCLES, "--curves")
    assert code == 0
    assert (content["drive"], content["timing"], content["group"]) == ("muscles", "best", "p1p2")
    assert set(content) >= {
        "power_mean_W", "power_sd_W", "power_mode_W", "muscle_power_W", "power_two_legs_min_W", "negative_share",
        "activation_rise_s", "activation_fall_s", "delay_s", "hip_flexion_offset_deg", "length_scale", "windows_deg",
        "ramp_s", "duty", "knee_range_deg", "peak_force_N", "extrapolated_share", "transmission_angle_min_deg",
    }  # fmt: skip
    assert set(content["muscles"][0]) == {
        "name", "group", "strength", "max_isometric_force_N", "optimal_fibre_length_m", "tendon_slack_length_m",
        "pennation_rad", "max_speed_fibre_lengths_per_s",
    }  # fmt: skip
    assert content["crank_angle_deg"] == list(range(360))
    work = sum(content["crank_moment_Nm"]) / 360 * content["cadence_rpm"] * 3.141592653589793 / 30
    assert work == pytest.approx(content["power_mean_W"])


def test_simulate_runs_the_most_probable_rider(capsys, tmp_path):
    code, content = answer(capsys, "simulate", "trt", *MUSCLES, "--timing", "measured", "-o", str(tmp_path))
    assert (code, content["agrees"], content["timing"]) == (0, True, "measured")
    assert content["power_mean_W"] == pytest.approx(content["static_power_mean_W"], rel=5e-4)
    assert content["static_power_mean_W"] == pytest.approx(content["power_mode_W"], rel=1e-3)
    names = {check["name"] for check in content["checks"]}
    assert {"muscle_moments", "muscle_activation", "mujoco_inverse"} <= names
    assert "torque_map" not in names
    names = {file.name for file in tmp_path.iterdir()}
    assert {f"trt-p1p2-muscles-measured.{kind}" for kind in ("csv", "json", "xml")} <= names


def test_validate_of_muscles_by_angle_checks_their_map(capsys):
    code, content = answer(capsys, "validate", "r1", *MUSCLES, "--timing", "by-angle", "--group", "p1p3", "--quick")
    assert (code, content["ok"]) == (0, True)
    assert {"torque_map", "map_feedback"} <= {check["name"] for check in content["checks"]}
    assert (content["runs"][0]["drive"], content["runs"][0]["timing"]) == ("muscles", "by-angle")


@pytest.mark.parametrize("command", ["simulate", "validate"])
def test_a_seat_beyond_the_lengths_is_refused_by_joint(capsys, command, tmp_path):
    design = load_design("trt")
    (tmp_path / "near.toml").write_text(design_toml(design.with_linkage(ground=0.8 * design.linkage.ground)))
    code, out, err = result(capsys, command, str(tmp_path / "near.toml"), *MUSCLES)
    assert (code, out) == (2, "")
    assert "muscle lengths are known from" in err


def test_designs_are_compared_and_text_names_the_windows(capsys):
    content = answer(capsys, "static", "trt", "d1", *MUSCLES, "--group", "p1p3", "--duty", "0.2")[1]
    assert [row["design"] for row in content["ratios"]] == ["trt", "d1"]
    assert content["ratios"][0]["power_ratio"] == 1
    assert max(content["designs"][1]["duty"].values()) <= 0.2
    code, out, _ = result(capsys, "static", "trt", *MUSCLES, "--curves", "-v")
    assert code == 0
    assert "p1p2 muscles, timing best" in out
    assert "quadriceps" in out
    assert result(capsys, "static", "trt", "d1", *MUSCLES)[0] == 0


def test_own_riders_are_those_of_the_file(capsys, tmp_path):
    load_riders("p1p2").taken(slice(0, 5)).save(tmp_path / "mine.npz")
    content = answer(capsys, "static", "trt", *MUSCLES, "--muscles", str(tmp_path / "mine.npz"))[1]
    assert content["group"] == "mine"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--timing", "best"), "--drive"),
        (("--duty", "0.2"), "--duty 0.2 needs --drive muscles"),
        (("--drive", "moments", "--timing", "measured"), "--timing measured needs --drive muscles"),
        ((*MUSCLES, "--muscles", "r.npz", "--moments", "m.csv"), "exclusive arguments: {--moments, --muscles}"),
        ((*MUSCLES, "--muscles", "r.npz", "--group", "p1p3"), "exclusive arguments: {--group, --muscles}"),
        ((*MUSCLES, "--duty", "0"), '"0.0" for --duty'),
        ((*MUSCLES, "--duty", "1.5"), '"1.5" for --duty. It must be a share of the turn'),
        ((*MUSCLES, "--moments", "mine.csv"), "--muscles"),
        ((*MUSCLES, "--muscles", "nowhere.npz"), "nowhere.npz"),
    ],
)
def test_what_does_not_go_together_is_refused_in_one_line(capsys, arguments, said):
    code, out, err = result(capsys, "static", "trt", *arguments)
    assert (code, out) == (2, "")
    assert said in err
    assert len(err.strip().splitlines()) == 1


@pytest.mark.parametrize("command", ["static", "simulate", "ride", "validate", "explore", "stimulation"])
def test_own_moments_have_no_muscles_but_those_that_fit_them(capsys, command):
    code, out, err = result(capsys, command, "d1", *MUSCLES, "--moments", "mine.csv")
    assert (code, out) == (2, "")
    assert "`fes_mj moments mine.csv --fit-muscles -o RIDER.npz`" in err


@pytest.mark.parametrize(
    "option", [("--timing", "measured"), ("--duty", "0.1"), ("--muscles", "r.npz"), ("--timing", "best")]
)
def test_moments_take_no_options_of_muscles_where_these_are_the_default(capsys, option):
    code, out, err = result(capsys, "ride", "d1", "--drive", "moments", *option)
    assert (code, out) == (2, "")
    assert f"{' '.join(option)} needs --drive muscles." in err


def test_optimize_finds_a_design_for_muscles(capsys, tmp_path):
    load_riders("p1p2").most_probable.save(tmp_path / "mine.npz")
    best, ensemble = str(tmp_path / "best.toml"), ("--muscles", str(tmp_path / "mine.npz"))
    search = (
        "optimize",
        "trt",
        *MUSCLES,
        *ensemble,
        "--start",
        "trt",
        "--budget",
        "1000",
        "--searches",
        "1",
        "--limits",
        "paper",
    )
    code, content = answer(capsys, *search, "-o", best)
    assert code == 0
    assert (content["drive"], content["timing"], content["evaluations"]) == ("muscles", "best", 1000)
    assert (content["feasible"], content["violations"]) == (True, [])
    assert content["gain_W"] > 0
    assert "--drive=muscles" in content["command"]
    again = answer(capsys, "static", best, *MUSCLES, *ensemble)[1]
    for key in ("power_mean_W", "power_sd_W", "cadence_rpm"):
        assert again[key] == pytest.approx(content[key]), key
    assert again["windows_deg"] == content["windows_deg"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--timing", "measured"), "--timing measured"),
        (("--caution", "1"), "--caution"),
        (("--method", "nsga-ii"), "nsga-ii"),
        (("--duty", "0"), '"0.0" for --duty'),
        (("--moments", "mine.csv"), "--muscles"),
        (("--report", "page.html"), "--report"),
    ],
)
def test_optimize_refuses_what_is_of_moments_alone(capsys, arguments, said):
    code, out, err = result(capsys, "optimize", "trt", *MUSCLES, *arguments)
    assert (code, out) == (2, "")
    assert said in err
    assert err.count("\n") <= 3

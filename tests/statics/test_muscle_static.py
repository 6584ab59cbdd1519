import numpy as np
import pytest

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.power import muscle_turn
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.timing import Windows
from fes_mj.statics.muscle_static import MuscleStatic

D1 = load_design("d1")
CADENCE = D1.linkage.cadence


@pytest.fixture(scope="module")
def static():
    return MuscleStatic.solve(D1, load_riders("p1p2"), CADENCE, "best")


def test_free_body_equilibrium_gives_the_power_of_the_muscles(static):
    content = static.summary()
    assert static.power == pytest.approx(static.stimulated.power.mean(axis=0), abs=1e-9)
    assert content["power_mean_W"] == pytest.approx(content["muscle_power_W"], rel=1e-12)
    assert content["power_sd_W"] == pytest.approx(static.stimulated.power.mean(axis=1).std())


def test_what_json_says_of_the_most_probable_rider_is_enough_to_compute_its_power(static):
    content = static.summary()
    muscles = content["muscles"]
    known = anatomy()
    values = {
        "quadriceps_strength": muscles[known.names.index("vas_lat")]["strength"],
        "hamstrings_strength": muscles[known.names.index("semimem")]["strength"],
        "gluteus_strength": muscles[known.names.index("glut_max1")]["strength"],
        "rise_s": content["activation_rise_s"],
        "fall_per_rise": content["activation_fall_s"] / content["activation_rise_s"],
        "delay_s": content["delay_s"],
        "max_speed": muscles[0]["max_speed_fibre_lengths_per_s"],
        "hip_offset_deg": content["hip_flexion_offset_deg"],
    }
    values["rectus_recruitment"] = muscles[known.names.index("rect_fem")]["strength"] / values["quadriceps_strength"]
    for group, name in (("quadriceps", "vas_lat"), ("hamstrings", "semimem"), ("gluteus", "glut_max1")):
        row = muscles[known.names.index(name)]
        shift = known.slack[known.names.index(name)] - row["tendon_slack_length_m"]
        values[f"{group}_fibre_shift"] = shift / row["optimal_fibre_length_m"]
    rider = Riders("said", {name: np.array([value]) for name, value in values.items()}, np.zeros(1))
    on, off = np.array([content["windows_deg"][group] for group in ("quadriceps", "hamstrings", "gluteus")]).T
    windows = Windows(on[:, None, None], ((off - on) % 360)[:, None, None])
    # activation closes its turn to 1e-7
    assert muscle_turn(rider, D1, CADENCE, windows).power_mean[0, 0] == pytest.approx(content["power_mode_W"], rel=1e-6)


def test_two_legs_and_dead_spots(static):
    content = static.summary()
    both = static.power + np.roll(static.power, 180)
    assert content["power_two_legs_min_W"] == pytest.approx(both.min())
    assert content["negative_share"] == pytest.approx(np.mean(both < 0))
    assert content["duty"] == {"quadriceps": 100 / 360, "hamstrings": 100 / 360, "gluteus": 100 / 360}
    assert content["legs"] == 1
    two = MuscleStatic.solve(D1, static.stimulated.riders, CADENCE, "best", legs=2).summary()
    assert two["inactive_zone_share"] == content["negative_share"]


def test_ratio_to_another_design(static):
    trt = MuscleStatic.solve(load_design("trt"), static.stimulated.riders, load_design("trt").linkage.cadence, "best")
    ratio, deviation = static.ratio(trt)
    assert ratio == pytest.approx(static.power_mean / trt.power_mean)
    assert 0 < deviation < 1
    assert static.ratio(static) == (1.0, 0.0)


def test_rules_without_windows_say_none(static):
    content = MuscleStatic.solve(D1, static.stimulated.riders, CADENCE, "by-angle").summary()
    assert (content["windows_deg"], content["muscle_power_W"], content["duty"]) == (None, None, None)

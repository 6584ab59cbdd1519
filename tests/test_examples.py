"""Every example runs, and what it computes is held against an exact or independent value."""

import re
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fes_mj import load_design, load_moments
from fes_mj.cli.app import run
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import ride
from fes_mj.statics.turn import quasi_static

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"


def test_crank_length() -> None:
    names = runpy.run_path(str(EXAMPLES / "crank_length.py"))
    assert names["result"].agrees
    assert names["powers"][160] == pytest.approx(names["powers"][162], rel=0.01)  # a millimetre is no leap


def test_own_moments() -> None:
    """A constant moment in extension alone does moment times swing, whatever the linkage."""
    names = runpy.run_path(str(EXAMPLES / "own_moments.py"))
    assert names["static"].work_per_turn == pytest.approx(20 * names["swing"], rel=1e-4)


def test_pedal_force() -> None:
    names = runpy.run_path(str(EXAMPLES / "pedal_force.py"))
    simulated, exact = np.abs(names["run"].loop_force["pedal"]), np.abs(names["reactions"]["pedal"])
    assert simulated.mean() == pytest.approx(exact.mean(), rel=1e-3)


@pytest.fixture(scope="module")
def ride_env() -> dict[str, Any]:
    pytest.importorskip("gymnasium")
    return runpy.run_path(str(EXAMPLES / "ride_env.py"))


@pytest.mark.parametrize("actions", ["stimulation", "moments"])
@pytest.mark.parametrize("variants", [("ride",), ("ride", "fixed-gear", "compatible")], ids="+".join)
def test_ride_env(ride_env: dict[str, Any], actions: str, variants: tuple[str, ...]) -> None:
    """Gymnasium's own checker, with every warning an error; the same seed rides the same way."""
    from gymnasium import make
    from gymnasium.utils.env_checker import check_env

    env = make("fes_mj/Ride-v0", actions=actions, variants=variants, duration=0.4).unwrapped
    check_env(env)
    assert env.action_space.shape == ((6,) if actions == "stimulation" else (4,))
    runs = []
    for _ in range(2):
        env.action_space.seed(1)
        runs.append(ride_env["roll_out"](env, ride_env["random_policy"](env), seed=3))
    assert np.array_equal(runs[0]["distance"], runs[1]["distance"])
    assert runs[0]["time"][-1] == pytest.approx(0.4)
    assert len(runs[0]["time"]) == 21


def test_ride_env_rewards_the_table(ride_env: dict[str, Any]) -> None:
    """A table of stimulation beats chance, for less effort; the reward adds up to what info says."""
    env = ride_env["RideEnv"]("r2", duration=6.0)
    env.action_space.seed(0)
    table, chance = (ride_env["roll_out"](env, ride_env[f"{name}_policy"](env)) for name in ("table", "random"))
    for episode in (table, chance):
        expected = episode["distance"][-1] - ride_env["EFFORT"] * episode["effort"][-1]
        assert episode["reward"].sum() == pytest.approx(expected)
    assert table["reward"].sum() > chance["reward"].sum() + 1
    assert table["effort"][-1] < chance["effort"][-1]
    assert table["speed"][-1] > table["speed"][0]


def test_ride_env_does_what_its_documentation_says(ride_env: dict[str, Any]) -> None:
    """It rolls to a stop without stimulation; activations rise late; a moment is its share of the range."""
    env = ride_env["RideEnv"]("trt", duration=100.0)
    episode = ride_env["roll_out"](env, lambda _: np.zeros(6, np.int8))
    assert episode["time"][-1] < 100
    assert episode["speed"][-1] < ride_env["STOPPED"]
    assert episode["effort"][-1] == 0
    env.reset(seed=0)
    for step in range(1, 9):
        observation, *_ = env.step(np.ones(6, np.int8))
        late = max(0.0, step * ride_env["PERIOD"] - env.muscles.delay)
        within = ride_env["TICK"] / env.muscles.rise
        assert observation[4:] == pytest.approx(1 - np.exp(-late / env.muscles.rise), abs=within)
    direct = ride_env["RideEnv"]("trt", actions="moments")
    direct.reset(seed=0)
    direct.step(np.array([0.5, -1.0, 0.0, 1.0], np.float32))
    assert direct.data.ctrl == pytest.approx([0.5, -1, 0, 1] * direct.model.actuator_ctrlrange[:, 1])


@pytest.mark.long
def test_ride_env_rides_as_fast_as_the_equation_of_motion(ride_env: dict[str, Any]) -> None:
    """Though its stimulator switches 50 times a second."""
    env = ride_env["RideEnv"]("trt", variants=("ride", "fixed-gear"))
    distance = ride_env["roll_out"](env, ride_env["table_policy"](env))["distance"]
    expected = ride(Ride(env.design, env.rider, duration=env.duration, transmission="fixed"))
    over = 3.0  # s, some turns
    ridden = expected.distance[-1] - np.interp(env.duration - over, expected.time, expected.distance)
    assert distance[-1] - distance[-1 - round(over / ride_env["PERIOD"])] == pytest.approx(ridden, rel=0.02)


@pytest.mark.long
def test_mjx_rollout() -> None:
    """Copies with different leads part, the loops of all hold, and a lead of half a turn is worst."""
    pytest.importorskip("jax")
    pytest.importorskip("mujoco.mjx")
    rollout = runpy.run_path(str(EXAMPLES / "mjx_rollout.py"))["roll_out"](copies=4, duration=0.5)
    assert np.isfinite(rollout["distance"]).all()
    assert rollout["loop_gap"].max() < 1e-5
    assert rollout["distance"].argmin() == 3  # the leads go from -90 to 180 deg
    assert 0.5 < rollout["distance"].min() < rollout["distance"].max() < 1.0


def replayed(*arguments: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Exit code, output and errors of the example, run where fes_mj cannot be imported."""
    code = 0
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "fes_mj", None)
        patch.setattr(sys, "argv", ["replay_moments.py", *arguments])
        patch.chdir(folder)
        try:
            runpy.run_path(str(EXAMPLES / "replay_moments.py"), run_name="__main__")
        except SystemExit as end:
            code = int(end.code or 0)
    said = capsys.readouterr()
    return code, said.out, said.err


def replay(model: Path, capsys: pytest.CaptureFixture[str]) -> float:
    """Mean crank power that it prints, W."""
    code, out, err = replayed(str(model), folder=model.parent, capsys=capsys)
    assert code == 0, err
    return float(re.search(r"crank power ([\d.-]+) W", out)[1])  # type: ignore[index]


@pytest.mark.parametrize("name", DESIGNS)
def test_replay_moments(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The files of mjcf/ and MuJoCo alone give the power of statics."""
    expected = quasi_static(load_design(name), load_moments()).power_mean
    assert replay(ROOT / "mjcf" / name / f"{name}.xml", capsys) == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("variant", ["two-legs", "compatible", "bodies"])
def test_replay_moments_of_variants(variant: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = tmp_path / "model.xml"
    arguments = ["export", "d1", "--group", "p1p3", "-o", str(model), "--variant", variant]
    assert run(arguments) == 0
    legs = 2 if variant == "two-legs" else 1
    expected = legs * quasi_static(load_design("d1"), load_moments("p1p3")).power_mean
    assert replay(model, capsys) == pytest.approx(expected, rel=5e-3)


def test_replay_moments_notices_wrong_moments(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exchanged joints miss the power by far more than the limit of the tests above."""
    (tmp_path / "model.xml").write_text((ROOT / "mjcf/d1/d1.xml").read_text())
    table = (ROOT / "mjcf/d1/d1.csv").read_text()
    (tmp_path / "model.csv").write_text(
        table.replace("knee_Nm", "x").replace("hip_Nm", "knee_Nm").replace("x", "hip_Nm")
    )
    expected = quasi_static(load_design("d1"), load_moments()).power_mean
    assert abs(replay(tmp_path / "model.xml", capsys) / expected - 1) > 0.1


@pytest.fixture(scope="module")
def wrong_files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with models and tables that are not what the example needs."""
    folder = tmp_path_factory.mktemp("wrong")
    for name, variants in {"model": [], "passive": ["passive"], "free": ["free"]}.items():
        flags = [flag for variant in variants for flag in ("--variant", variant)]
        assert run(["export", "trt", "-o", str(folder / f"{name}.xml"), *flags]) == 0
    (folder / "folder").mkdir()
    model = (folder / "model.xml").read_text()
    tables = {"words": "a,b\n1,two\n", "empty": "", "other": "crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n"}
    for name, table in tables.items():
        (folder / f"{name}.xml").write_text(model)
        (folder / f"{name}.csv").write_text(table)
    scene = (ROOT / "mjcf/trt/scene.xml").read_text().replace("trt.xml", "model.xml")
    (folder / "scene.xml").write_text(scene)
    return folder


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("", "give one model of `fes_mj export`"),
        ("nowhere.xml", "nowhere.xml: there is no such file"),
        ("model.csv", "model.csv: MuJoCo cannot load it"),
        ("folder", "folder: there is no such file"),
        ("scene.xml", "scene.csv: cannot read the table of joint moments: No such file or directory; give the model"),
        ("passive.xml", "passive.xml: it has no motors knee, hip; export it without the variants passive"),
        ("free.xml", "free.xml: nothing holds its crank"),
        ("words.xml", "words.csv: this is no table of numbers"),
        ("empty.xml", "empty.csv: this is no table of numbers"),
        ("other.xml", "other.csv: the columns crank_Nm are not there"),
    ],
)
def test_replay_moments_of_a_wrong_file_is_one_message(
    file: str, said: str, wrong_files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = replayed(*([file] if file else []), folder=wrong_files, capsys=capsys)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("replay_moments.py: ")
    assert said in err


def test_no_example_is_left_out() -> None:
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in EXAMPLES.glob("*.py")} <= tested

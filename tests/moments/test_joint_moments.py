"""Joint moments from CSV files: what is read, and what is refused with which words."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments

HEADER = "crank_angle_deg,knee_Nm,hip_Nm\n"


def test_rows_may_come_in_any_order_and_spacing(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text("\ufeff" + HEADER + "270, 3, -1\n\n10,1,0\n40.5,2,5\n", encoding="utf-8")
    moments = load_moments(path)
    assert moments.name == "mine"
    curves = moments.at(np.radians([10, 40.5, 270]))
    assert curves.knee == pytest.approx([1, 2, 3], abs=0.02)  # bridges across wide gaps have corners there
    assert curves.hip == pytest.approx([0, 5, -1], abs=0.02)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "the header is ''"),
        (
            "angle,knee,hip\n0,1,1\n",
            "header is 'angle,knee,hip'; of a plain file it must be 'crank_angle_deg,knee_Nm,hip_",
        ),
        ("crank_angle_deg|knee_Nm|hip_Nm\n0|1|1\n", "the header is 'crank_angle_deg|knee_Nm|hip_Nm'"),
        ("crank_angle_deg,from_tdc,knee_Nm,hip_Nm\n0,1,1,1\n", "in a measurement file (.toml)"),
        (HEADER, "0 row"),
        (HEADER + "0,1,1\n", "1 row of moments at one crank angle; at least 2 crank angles are needed"),
        (HEADER + "0,1,1\n90,nan,1\n", "line 3: knee_Nm is 'nan'; it must be a finite number"),
        (HEADER + "0,1,1\n90,1,inf\n", "line 3: hip_Nm is 'inf'"),
        (HEADER + "0,1,1\n90,,1\n", "line 3: knee_Nm is ''"),
        (HEADER + "0,1,1\n90,twenty,1\n", "line 3: knee_Nm is 'twenty'"),
        (HEADER + "0,1,1\n90,1\n", "line 3 has 2 values; the header names 3 columns"),
        (HEADER + "0,1,1\n1e9,1,1\n", "line 3: crank_angle_deg is 1e+09; it must be from -1e+07 to 1e+07"),
        (HEADER + "0,1,1\n90,1e5,1\n", "line 3: knee_Nm is 100000; it must be from -10000 to 10000"),
        (HEADER + "0,1,1\n360,1,1\n-360,2,2\n", "3 rows of moments at one crank angle; at least 2 crank angles"),
    ],
)
def test_what_cannot_be_used_is_named(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_moments(path)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        load_moments(tmp_path / "nothing.csv")
    with pytest.raises(InputError, match="Is a directory"):
        load_moments(tmp_path)
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"binary\.csv: .*CSV"):
        load_moments(tmp_path / "binary.csv")


def test_a_worker_process_gets_what_linear_algebra_made_of_them() -> None:
    """Its library has fewer threads: the last bits of coefficients that it made itself could be others."""
    for name in ("p1p2", Path("examples/trial/trial.toml")):
        moments = load_moments(name)
        vars(sent := pickle.loads(pickle.dumps(moments))).pop("crank_angle")  # nothing can be made anew
        for joint in JOINTS:
            np.testing.assert_array_equal(sent.coefficients[joint], moments.coefficients[joint])
            np.testing.assert_array_equal(sent.deviations[joint], moments.deviations[joint])
        deviations = np.concatenate([*moments.deviations])
        assert deviations @ deviations.T == pytest.approx(moments.covariance, abs=1e-7)


def test_moments_of_unknown_error_have_no_deviations(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(HEADER + "0,1,1\n120,2,2\n240,3,3\n")
    with pytest.raises(InputError, match=r"^mine: .* error"):
        _ = load_moments(path).deviations


@pytest.mark.parametrize("name", ["crank_angle", "knee", "hip"])
def test_numbers_that_are_not_finite_are_refused(name: str) -> None:
    arrays = {key: np.zeros(4) for key in ("crank_angle", "knee", "hip")}
    with pytest.raises(InputError, match=f"mine: {name} has"):
        JointMoments("mine", **arrays | {name: np.array([0.0, np.nan, 1.0, 2.0])})

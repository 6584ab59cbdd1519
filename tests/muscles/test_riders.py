import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.muscles.riders import load_riders


def test_saved_riders_come_back(riders, tmp_path):
    riders.save(tmp_path / "mine.npz")
    back = load_riders(tmp_path / "mine.npz")
    assert back.name == "mine"
    assert np.array_equal(back.likelihood, riders.likelihood)
    for name, values in riders.values.items():
        assert np.array_equal(back.values[name], values)


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04 cut", None])
def test_what_is_no_ensemble_is_refused_by_name(content, tmp_path):
    path = tmp_path / "bad.npz"
    if content is None:
        np.savez(path, likelihood=np.zeros(2))
    else:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"bad\.npz"):
        load_riders(path)
    with pytest.raises(InputError, match=r"nowhere\.npz"):
        load_riders(tmp_path / "nowhere.npz")


@pytest.mark.parametrize("wrong", ["shorter", "nan", "empty", "tricycle"])
def test_columns_that_do_not_fit_each_other_are_refused(wrong, riders, tmp_path):
    path = tmp_path / "bad.npz"
    riders.save(path)
    with np.load(path) as stored:
        columns = {name: stored[name] for name in stored.files}
    if wrong == "empty":
        columns = {name: column if name == "measured_on" else column[:0] for name, column in columns.items()}
    else:
        name = "measured_on" if wrong == "tricycle" else "rise_s"
        columns[name] = columns[name] * np.nan if wrong == "nan" else columns[name][1:]
    np.savez(path, **columns)
    with pytest.raises(InputError, match=r"bad\.npz: an ensemble of riders with columns"):
        load_riders(path)

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


@pytest.mark.parametrize("content", [b"", b"no zip", None])
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

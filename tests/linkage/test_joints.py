"""The pair of a knee's and a hip's value: each under its own name, whichever way it is read."""

import pytest

from fes_mj.linkage.joints import PerJoint


def test_every_way_to_read_a_value_gives_that_joints() -> None:
    pair = PerJoint.of(str.upper)
    assert (pair.knee, pair.hip) == (pair["knee"], pair["hip"]) == tuple(pair) == ("KNEE", "HIP")
    assert dict(pair.items()) == {"knee": "KNEE", "hip": "HIP"}
    assert pair.map(str.lower) == PerJoint("knee", "hip")
    with pytest.raises(KeyError):
        pair["ankle"]

"""Charts: curves over a turn."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from fes_mj.viewing.charts import over_turn


def test_a_turn_in_any_order_is_drawn_from_end_to_end() -> None:
    angle = np.radians(np.arange(100.0, 460.0))
    degrees, curve = over_turn(angle, np.cos(angle))
    assert degrees == pytest.approx(np.arange(361))
    assert curve == pytest.approx(np.cos(np.radians(degrees)))

"""The one table of design variables: read, replaced, bounded the same everywhere."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.variables import (
    COMPONENTS,
    LENGTHS,
    VARIABLES,
    component,
    lengths,
    nearest_degrees,
    replaced,
    with_lengths,
)

OWNED = [name for name, (variable, _) in COMPONENTS.items() if variable.owner]


@pytest.mark.parametrize("name", OWNED)
def test_a_component_is_what_was_written(name: str) -> None:
    design, variable = fes_mj.load_design("d1"), COMPONENTS[name].variable
    changed = replaced(design, {name: 0.3})
    assert component(changed, name) == pytest.approx(0.3)
    assert replace(changed, **{variable.owner: getattr(design, variable.owner)}) == design  # and nothing else
    others = [other for other in OWNED if other != name]
    assert [component(changed, other) for other in others] == [component(design, other) for other in others]


def test_what_belongs_to_a_run_changes_no_design() -> None:
    design = fes_mj.load_design("d1")
    assert replaced(design, {"cadence_rpm": 90}) == design


def test_both_parts_of_a_vector_of_a_batch() -> None:
    both = replaced(fes_mj.load_design("d1"), {"R7x": -0.3, "R7y": np.full((2, 1), 0.1)})
    assert np.array_equal(both.linkage.pivot_to_crank, np.full((2, 1), -0.3 + 0.1j))


def test_lengths_read_back(design: fes_mj.Design) -> None:
    assert len(LENGTHS) == len(lengths(design)) == 9
    assert with_lengths(design, lengths(design)) == design
    batch = with_lengths(design, np.stack([lengths(design), 2 * lengths(design)], axis=1)[..., None])
    assert np.asarray(batch.linkage.crank).ravel() == pytest.approx([design.linkage.crank, 2 * design.linkage.crank])


@pytest.mark.parametrize("symbol", [s for s, v in VARIABLES.items() if v.owner and not v.vector])
def test_design_files_keep_to_the_bounds_of_the_table(symbol: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    from fes_mj.linkage.design_file import design_toml

    variable, path = VARIABLES[symbol], tmp_path_factory.mktemp("design") / "mine.toml"
    lines = design_toml(fes_mj.load_design("d1").with_rider(leg_mass_factor=0.9)).splitlines()
    for value, accepted in (
        (variable.low, True),
        (variable.high, True),
        (variable.low - 1e-3, False),
        (variable.high + 1e-3, False),
    ):
        text = [f"{symbol} = {value!r}" if line.split(" = ")[0] == symbol else line for line in lines]
        path.write_text("\n".join(text))
        if accepted:
            assert component(load_design(path), symbol) == pytest.approx(value)
        else:
            with pytest.raises(InputError, match=rf"\.{symbol} is .*; it must be {variable.allowed.split(' ')[0]}"):
                load_design(path)


@given(st.floats(-360, 360))
def test_degrees_read_as_an_angle_are_found_again(degrees: float) -> None:
    """math.degrees misses one in twenty."""
    angle = math.radians(degrees)
    assert math.radians(nearest_degrees(angle)) == angle


@given(st.floats(-2 * math.pi, 2 * math.pi))
def test_no_other_degrees_are_read_as_an_angle_nearer_to_one(angle: float) -> None:
    nearest = abs(math.radians(nearest_degrees(angle)) - angle)
    assert nearest <= math.ulp(angle)
    degrees = [math.degrees(angle)]
    for _ in range(20):
        degrees = [math.nextafter(degrees[0], -math.inf), *degrees, math.nextafter(degrees[-1], math.inf)]
    assert min(abs(math.radians(candidate) - angle) for candidate in degrees) == nearest

"""What a search refuses from Python, by name and value, before it begins."""

import pytest

import fes_mj
from fes_mj.optimization.stimulated import MuscleDrive


@pytest.mark.parametrize(
    ("kind", "options", "said"),
    [
        ("abc", {}, "kind is 'abc'; it must be one of crt, cdt, trt"),
        ("crt", {"method": "abc"}, "method is 'abc'; it must be one of differential-evolution"),
        ("crt", {"budget": 0}, "budget is 0; it must be at least 1"),
        ("crt", {"method": "nsga-ii", "budget": 0}, "budget is 0"),
        ("crt", {"searches": 0}, "searches is 0"),
        ("crt", {"seed": -1}, "seed is -1; it must be at least 0"),
        ("crt", {"start": "d1"}, "start is d1, a cdt, not a crt"),
        ("crt", {"like": "r1", "start": "r2"}, "like takes the place of start"),
        ("crt", {"like": "r1", "compared_with": "r2"}, "like takes the place of start and compared_with"),
        ("crt", {"caution": -1}, "caution is -1"),
        ("crt", {"ripple": -0.1}, "ripple is -0.1"),
        ("crt", {"build": {"height": 1}}, "'height'; it must be one of transmission_angle_min"),
        ("crt", {"smooth": True}, "smooth is an objective of its own"),
        ("crt", {"method": "nsga-ii", "caution": 1}, "not with caution or muscles"),
        ("crt", {"method": "nsga-ii", "muscles": "p1p2"}, "not with caution or muscles"),
    ],
    ids=str,
)
def test_what_cannot_be_searched_for(kind, options, said):
    if "muscles" in options:
        options = options | {"muscles": MuscleDrive(fes_mj.load_muscles("p1p2").riders)}
    with pytest.raises(fes_mj.InputError) as refused:
        fes_mj.optimize(kind, fes_mj.load_moments("p1p2"), **options)
    assert said in str(refused.value)

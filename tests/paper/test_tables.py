"""Table 1 of the paper beside ours."""

from fes_mj.paper.tables import explained_by


def test_what_explains_a_difference() -> None:
    cases = {0.004: "rounding", -0.3: "1 sd", 0.7: "2 sd", -0.9: "none: beyond 2 sd"}
    assert {difference: explained_by(difference, 0.4) for difference in cases} == cases

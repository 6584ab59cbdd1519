"""Who can ride the paper's designs: people instead of the one rider that the paper fitted to 15 W."""

from typing import Any

from fes_mj.common.markdown import Table
from fes_mj.fit.population import SEATS
from fes_mj.linkage.design import Rider
from fes_mj.linkage.riders import populations
from fes_mj.paper.captions import captioned
from fes_mj.paper.runs import Runs


def percentile_table() -> Table:
    """Thigh and shank of people beside the paper's."""
    rows: list[tuple[Any, ...]] = []
    for who, people in populations().items():
        legs = [100 * length for percentile in (5, 50, 95) for length in _legs(people.rider(percentile))]
        rows.append((who, *legs, people.correlation))
    rows.append(("the paper's", None, None, *(100 * length for length in _legs(Rider())), None, None, None))
    return captioned("people", rows)


def _legs(rider: Rider) -> tuple[float, float]:
    return rider.thigh, rider.shank


def population_table(runs: Runs) -> Table:
    """Share of people who can ride, and their power, with the seat as drawn and moved."""
    rows = []
    for name, study in runs.people.items():
        content = study.summary()
        for who in study.riders:
            for seat in SEATS:
                powers = (content[f"power_{which}_{seat}_W"][who] for which in ("mean", "p10"))
                share = 100 * content[f"share_{seat}"][who]
                rows.append((name.upper(), who, {"unmoved": "as drawn", "fitted": "moved"}[seat], share, *powers))
    error = max(study.map_error for study in runs.people.values())
    sizes = {str(study.summary()["samples"]) for study in runs.people.values()}
    return captioned("population", rows, samples=", ".join(sizes), error=f"{error:.2f}")

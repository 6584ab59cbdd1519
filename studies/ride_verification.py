"""Do the two solvers of `fes_mj ride` agree? The paper's designs, both groups, both transmissions, flat and uphill.

    python -m studies.ride_verification [--duration 60] [--out results/ride_verification.md]

On the flat with Hill's relation; uphill speed-free, on the slope that the mean power balances at 5.71 km/h.
"""

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from fes_mj.common.checks import Check
from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.riding.ride import TRANSMISSIONS, Ride, balancing_slope

ROOT = Path(__file__).parents[1]


def rides(duration: float) -> Iterator[Ride]:
    """All combinations."""
    hill = load_torque_velocity("hill")
    for name in DESIGNS:
        for group in GROUPS:
            moments = load_moments(group)
            for transmission in TRANSMISSIONS:
                ride = Ride(load_design(name), moments, transmission=transmission, duration=duration)
                yield replace(ride, moments=moments.at_speed(hill))
                yield replace(ride, road=replace(ride.road, slope=balancing_slope(ride)))


class Outcome(NamedTuple):
    """What is kept of a ride, whose records fill a hundred megabytes."""

    ride: Ride
    summary: dict[str, Any]
    checks: tuple[Check, ...]

    @property
    def worst(self) -> float:
        """The largest check, in limits."""
        return max(check.factor for check in self.checks)


def outcome(ride: Ride) -> Outcome:
    """Ride once, both ways."""
    case = RideCase(ride)
    return Outcome(ride, case.summary(), case.checks)


def tables(outcomes: list[Outcome]) -> Iterator[Table]:
    """What came out, and how far the solvers are apart."""
    columns = {
        "design": "",
        "group": "",
        "transmission": "",
        "slope, %": ".2f",
        "speed at the end, km/h": ".3f",
        "ripple, %": ".2f",
        "freewheeling, %": ".1f",
        "stopped after, s": ".2f",
        "worst check, in limits": ".2g",
    }
    rows = []
    for ride, result, checks in outcomes:
        ripple = result["speed_ripple"]
        rows.append(
            (
                ride.design.name.upper(),
                ride.moments.name,
                ride.transmission,
                result["slope_percent"],
                result["speed_kmh"],
                None if ripple is None else 100 * ripple,
                100 * result["freewheel_share"],
                result["stopped_at_s"],
                max(check.factor for check in checks),
            )
        )
    note = "Flat with Hill's relation, uphill speed-free on the slope that the mean power balances at 5.71 km/h."
    yield Table("Rides in MuJoCo", columns, rows, note)
    columns = {"check": "", "largest value": ".2g", "limit": "g", "unit": "", "in": ""}
    yield Table(
        "Checks",
        columns,
        [
            (check.name, check.value, check.limit, check.unit, check.subject)
            for same in zip(*(outcome.checks for outcome in outcomes), strict=True)
            for check in [max(same, key=lambda check: check.factor)]
        ],
    )


def main() -> None:
    """Ride all, write the page; exit code 1 if a check fails."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--duration", type=float, default=60.0)
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "ride_verification.md")
    arguments = parser.parse_args()
    outcomes = [outcome(ride) for ride in track([*rides(arguments.duration)], "rides")]
    title = "Do the two solvers of a ride agree?"
    origin = "Written by `python -m studies.ride_verification`; see docs/theory.md."
    pages = "\n".join(table.markdown() for table in tables(outcomes))
    write_text(arguments.out, f"# {title}\n\n{origin}\n\n{pages}")
    if max(outcome.worst for outcome in outcomes) > 1:
        raise SystemExit(1)


if __name__ == "__main__":
    main()

"""Do the two solvers of `fes_mj ride` agree? The paper's designs, and random linkages down to their dead centres.

    python -m studies.ride_verification [--part paper | random]

Both parts, each with a page of its own: results/ride_verification.md and results/ride_random.md.

The paper's designs with both groups and transmissions, for a minute: by muscles on the flat, and by muscles and by
moments on the slope that their mean power balances at 5.71 km/h. Random linkages 0.2 to 30 mm from their dead centres
for five seconds, or until nothing more can come, half of them by moments and half by muscles.
"""

import argparse
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.checks import Check, definitions
from fes_mj.common.console import track
from fes_mj.common.errors import InputError
from fes_mj.common.markdown import Table
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.muscles.drive import load_muscles
from fes_mj.riding.ride import TRANSMISSIONS, Ride, Road, balancing_slope
from fes_mj.riding.stimulated import StimulatedRider, stimulated_rider
from studies.random_linkages import random_design

ROOT = Path(__file__).parents[1]
DURATION, RANDOM_DURATION = 60.0, 5.0  # s
RANDOM_RIDES, SEED = 100, 1  # by moments, and as many by muscles
NEAREST = 2e-4  # m from a dead centre
SLOPES = (-0.06, 0.20)
DRIVES = ("moments", "muscles")


def paper_rides() -> Iterator[Ride]:
    """All combinations."""
    for name in DESIGNS:
        for group in RIDER_GROUPS:
            moments = load_moments(group)
            for transmission in TRANSMISSIONS:
                ride = Ride(load_design(name), moments, transmission=transmission, duration=DURATION)
                by_muscles = replace(ride, drive=stimulated_rider(load_muscles(group), ride.design))
                yield by_muscles
                yield from (replace(one, road=Road(slope=balancing_slope(one))) for one in (by_muscles, ride))


def random_rides() -> Iterator[Ride]:
    """Each on a linkage of its own; transmissions take turns. A quarter starts from rest."""
    rng = np.random.default_rng(SEED)
    for number in range(len(DRIVES) * RANDOM_RIDES):
        design, drive = _driven(rng, DRIVES[number // RANDOM_RIDES])
        yield Ride(
            design,
            drive,
            Road(slope=float(rng.uniform(*SLOPES))),
            transmission=TRANSMISSIONS[number % 2],
            launch=0.0 if rng.random() < 0.25 else float(rng.uniform(0.5, 5.0)),
            start=float(rng.uniform(0, 2 * np.pi)),
            duration=RANDOM_DURATION,
        )


def _driven(rng: np.random.Generator, drive: str) -> tuple[Design, JointMoments | StimulatedRider]:
    """A random linkage and what drives it, the joints within the angles for which muscle lengths are known."""
    group = str(rng.choice(RIDER_GROUPS))
    while True:
        design = random_design(rng, nearest=NEAREST)
        if drive == "moments":
            return design, load_moments(group)
        with suppress(InputError):
            return design, stimulated_rider(load_muscles(group), design)


class Outcome(NamedTuple):
    """What is kept of a ride, whose records fill a hundred megabytes; of one that was refused, why."""

    ride: Ride
    summary: dict[str, Any]
    checks: tuple[Check, ...]
    seconds: float
    refused: str = ""

    @property
    def worst(self) -> float:
        """The largest check, in limits."""
        return max((check.factor for check in self.checks), default=0.0)


def outcome(ride: Ride) -> Outcome:
    """Ride once, both ways."""
    case, start = RideCase(ride), time.process_time()
    try:
        return Outcome(ride, case.summary(), case.checks, time.process_time() - start)
    except InputError as error:
        return Outcome(ride, {}, (), 0.0, str(error))


def _refused(outcomes: Sequence[Outcome]) -> str:
    """Why rides were refused, for a note."""
    return "".join(f" Refused: {one.refused}." for one in outcomes if one.refused)


def paper_table(outcomes: Sequence[Outcome]) -> Table:
    """What came out, and how far the solvers are apart; a ride that is refused or whose checks fail has no row."""
    columns = {
        "design": "",
        "group": "",
        "by": "",
        "transmission": "",
        "slope, %": ".2f",
        "speed at the end, km/h": ".3f",
        "ripple, %": ".2f",
        "freewheeling, %": ".1f",
        "stopped after, s": ".2f",
        "worst check, in limits": ".2g",
        "time step, ms": ".3f",
        "uncertain by, %": ".2g",
    }
    rows = []
    for done in outcomes:
        ride, result = done.ride, done.summary
        if not result.get("agrees"):
            continue
        ripple = result["speed_ripple"]
        rows.append(
            (
                ride.design.name.upper(),
                result["group"],
                result["drive"],
                ride.transmission,
                result["slope_percent"],
                result["speed_kmh"],
                None if ripple is None else 100 * ripple,
                100 * result["freewheel_share"],
                result["stopped_at_s"],
                done.worst,
                1e3 * result["timestep_s"],
                100 * max(result["numerical_uncertainty"].values()),
            )
        )
    note = "By muscles on the flat, and by both on the slope that their mean power balances at 5.71 km/h."
    note += _refused(outcomes)
    return Table("Rides in MuJoCo", columns, rows, note)


def random_table(outcomes: Sequence[Outcome]) -> Table:
    """By drive and transmission: verdicts, refused and failed, and what they took."""
    columns = {
        "by": "",
        "transmission": "",
        "rides": "d",
        "refused": "d",
        "failed": "d",
        "verdicts": "",
        "worst check, in limits": ".2g",
        "uncertain by at most, %": ".2g",
        "smallest time step, ms": ".3f",
        "slowest, s": ".0f",
    }
    rows = []
    for drive, transmission in product(DRIVES, TRANSMISSIONS):
        of_kind = [
            one for one in outcomes if (one.ride.summary()["drive"], one.ride.transmission) == (drive, transmission)
        ]
        done = [one for one in of_kind if one.checks]
        words = [one.summary["verdict"] for one in done]
        rows.append(
            (
                drive,
                transmission,
                len(of_kind),
                len(of_kind) - len(done),
                sum(one.worst > 1 for one in done),
                ", ".join(f"{words.count(word)} {word}" for word in sorted(set(words))),
                max(one.worst for one in done),
                100 * max(max(one.summary["numerical_uncertainty"].values()) for one in done),
                1e3 * min(one.summary["timestep_s"] for one in done),
                max(one.seconds for one in done),
            )
        )
    failed = [one.ride.name for one in outcomes if one.worst > 1]
    return Table("Random linkages", columns, rows, f"Failed: {'; '.join(failed) or 'none'}.{_refused(outcomes)}")


def checks_table(outcomes: Sequence[Outcome]) -> Table:
    """The worst of each check."""
    checks = [check for one in outcomes for check in one.checks]
    names = [name for name in definitions() if any(check.name == name for check in checks)]
    worst = [max((check for check in checks if check.name == name), key=lambda check: check.factor) for name in names]
    columns = {"check": "", "largest value": ".2g", "limit": "g", "unit": "", "in": ""}
    rows = [(check.name, check.value, check.limit, check.unit, check.subject) for check in worst]
    return Table("Checks", columns, rows)


PARTS = {
    "paper": ("ride_verification", "Do the two solvers of a ride agree?", paper_rides, paper_table),
    "random": ("ride_random", "Do they agree on any linkage?", random_rides, random_table),
}


def main() -> None:
    """Ride all, write the pages; exit code 1 if a check fails."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", choices=PARTS)
    worst, only = 0.0, parser.parse_args().part
    for part in [only] if only else PARTS:
        stem, title, rides, table = PARTS[part]
        outcomes = [outcome(ride) for ride in track([*rides()], f"{part} rides")]
        pages = "\n".join(page.markdown() for page in (table(outcomes), checks_table(outcomes)))
        origin = f"Written by `python -m studies.ride_verification --part {part}`; see docs/theory.md."
        write_text(ROOT / "results" / f"{stem}.md", f"# {title}\n\n{origin}\n\n{pages}")
        worst = max(worst, *(one.worst for one in outcomes))
    if worst > 1:
        raise SystemExit(1)


if __name__ == "__main__":
    main()

"""What became of a ride in words: whether it rides, why it does not, and whether that is still within what is known."""

import math
from typing import NamedTuple

import numpy as np

from fes_mj.common.units import KMH, RPM
from fes_mj.linkage.joints import JOINTS
from fes_mj.riding.lookup import DRIVEN
from fes_mj.riding.trace import LEAST_ADVANCE, Trace

RIDES, STOPS, DOES_NOT_START, COASTS, NO_AGREEMENT = "rides", "stops", "does-not-start", "coasts", "no-agreement"
LEAST_DRIVE = 0.1  # of what the road takes, that muscles deliver to a tricycle which rides
MOST_COASTING = 0.9  # of the time, that the freewheel of one which rides runs free
HALF_TURN = 0.5  # turns, in which each leg pushes once: who comes no farther from rest has not started
NOT_AT_ALL = math.radians(1.0)  # of crank
# Twice the cadence at which the moments of the paper's riders were measured, as for the joints.
FASTEST_CADENCE = 120 * RPM
FASTEST_JOINTS = 2.0  # times the speed at which the moments were measured


class Verdict(NamedTuple):
    """One of the words above, and why; of what rides nothing need be said."""

    word: str
    reason: str | None = None


def verdict(trace: Trace) -> Verdict:
    """Of a ride by one solver."""
    if not trace.rides:
        from_rest = trace.ride.launch == 0 and trace.turns < HALF_TURN
        return Verdict(DOES_NOT_START if from_rest else STOPS, _obstacle(trace))
    downhill = min(trace.ride.load.climb, 0.0) * float(trace.distance[-1])
    taken, delivered = float(trace.road_work[-1]) - downhill, float(trace.muscle_work[-1])
    if trace.coasting_share > MOST_COASTING:
        return Verdict(COASTS, f"the freewheel runs free {100 * trace.coasting_share:.0f} % of the time")
    if delivered < LEAST_DRIVE * taken:
        return Verdict(COASTS, f"the muscles do {max(delivered, 0.0):.3g} J of the {taken:.3g} J that the road takes")
    return Verdict(RIDES)


def _obstacle(trace: Trace) -> str:
    """What a ride that stopped could not pass."""
    ride, table, stop = trace.ride, trace.ride.table, trace.stop or 0
    angle = float(trace.crank_angle[stop])
    push = table.push[:-1]
    asked = ride.travel * (ride.load.rolling + ride.load.climb)
    still = "the crank never turned: " if abs(angle - ride.start) < NOT_AT_ALL else ""
    if push.mean() <= asked:
        road = "the slope" if ride.road.slope > 0 else "the road"
        work = 2 * np.pi * np.array([asked, max(float(push.mean()), 0.0)])
        return f"{still}{road} takes {work[0]:.0f} J a turn of the crank, the muscles give {work[1]:.0f} J"
    return f"{still}dead centre at {math.degrees(angle) % 360:.0f} deg of the crank, where the legs push too little"


def rolls_back(trace: Trace) -> bool:
    """Whether it ends farther back than it had come."""
    return bool(trace.distance[-1] < trace.distance.max() - LEAST_ADVANCE)


def outside_known(trace: Trace) -> list[str]:
    """In what a ride goes beyond anything measured, over its last whole turns or, without any, all the way."""
    ride, part, beyond = trace.ride, trace.last_turns if trace.whole_turns else slice(None), []
    cadence = trace.cadence or 0.0
    if cadence > FASTEST_CADENCE:
        beyond.append(f"{cadence / RPM:.0f} rpm, where nothing beyond {FASTEST_CADENCE / RPM:.0f} rpm is known")
    turn = np.linspace(0, 2 * np.pi, len(ride.table.ahead) + 1)
    for joint in JOINTS:
        rates = [ride.table.joint_rate[row] for row, driven in enumerate(DRIVEN) if driven[1] == joint]
        angle, speed = trace.crank_angle[part] % (2 * np.pi), np.abs(trace.crank_speed[part])
        fastest = max(float((speed * np.abs(np.interp(angle, turn, rate))).max()) for rate in rates)
        reference = ride.drive.measured_on
        measured = reference.cadence * float(np.abs(reference.joint_rates(turn)[joint]).max())
        if fastest > FASTEST_JOINTS * measured:
            beyond.append(f"the {joint} at {fastest / measured:.1f} times the fastest that was measured")
    return beyond


def sentence(trace: Trace) -> str:
    """The verdict of a ride as a reader wants it."""
    word, reason = verdict(trace)
    speed = trace.mean_speed
    at = "" if speed is None else f": {speed / KMH:.2f} km/h at the end"
    if word in (RIDES, COASTS):
        text = f"It {word}{at}" + (f"; {reason}" if reason else "")
    elif word == DOES_NOT_START:
        text = f"It does not start: {reason}"
    else:
        text = f"It stops after {trace.stopped_at:.1f} s and {trace.distance.max():.1f} m: {reason}"
    if rolls_back(trace):
        text += "; then it rolls back"
    beyond = outside_known(trace)
    return f"{text}. Outside what is known: {'; '.join(beyond)}." if beyond else f"{text}."

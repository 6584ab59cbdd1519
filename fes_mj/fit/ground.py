"""A seat that hangs under the ground does not fit: where a design file says how high the ground is."""

from fes_mj.fit.seats import SeatLimits
from fes_mj.linkage.clearance import CLEARANCE
from fes_mj.linkage.design import Design
from fes_mj.linkage.shapes import PARTS, SEAT_DEPTH, lowest_point


def above_ground(design: Design, limits: SeatLimits) -> SeatLimits:
    """The limits without heights at which the seat itself would be too near to the ground, if others are left."""
    if design.frame.ground_height is None:
        return limits
    lowest = design.frame.ground_height + SEAT_DEPTH + PARTS["seat"].size + CLEARANCE
    return limits._replace(up=(min(max(limits.up[0], lowest), limits.up[1]), limits.up[1]))


def underground(design: Design) -> str | None:
    """By how much foot, linkage or seat come too near to the ground over the turn, if they do."""
    ground = design.frame.ground_height
    if ground is None or (above := lowest_point(design) - ground) >= CLEARANCE:
        return None
    where = f"{-1e3 * above:.0f} mm below" if above < 0 else f"within {1e3 * above:.1f} mm of"
    return f"{design.name}: foot, linkage or seat come {where} the ground; {1e3 * CLEARANCE:g} mm are needed"

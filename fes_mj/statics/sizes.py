"""Sizes of pins and links that bear their loads: what a workshop makes of a design, and what it weighs.

Pins stand out of one plate into the next: single shear.
"""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.linkage.clearance import WASHER, Side
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.layers import Stack, stack
from fes_mj.linkage.plates import Hole, Plate, hole_places
from fes_mj.statics.link_loads import LinkLoads
from fes_mj.statics.materials import Material, material, pin_stock, plate_stock
from fes_mj.statics.turn import QuasiStatic

YIELD_SAFETY = 2.0  # against yielding and buckling
FORCE_POINTS = 720  # crank angles at which forces are looked at
BOUGHT = "pedal"  # the joint whose pin and bearing come with what is screwed in
PEDAL_HOLE = 0.0142875  # m, 9/16 inch: every pedal's thread
WALL = 0.004  # m, least between two holes


@dataclass(frozen=True, eq=False)
class Build:
    """A design as it is made. turn: of the design with the masses of these links. pins: diameters by joint, m."""

    turn: QuasiStatic
    material: Material
    stack: Stack
    loads: LinkLoads

    @property
    def design(self) -> Design:
        """With the masses of its links."""
        return self.turn.design

    @property
    def plates(self) -> Mapping[str, Plate]:
        """By the name of the link."""
        return self.stack.side.plates

    @property
    def pins(self) -> Mapping[str, float]:
        """Diameters by joint, m."""
        return self.stack.side.pins

    @property
    def mass(self) -> dict[str, float]:
        """Of each link, kg."""
        return {body: float(inertia.mass) for body, inertia in self.design.links}


def build(turn: QuasiStatic, of: str = "aluminium", safety: float = YIELD_SAFETY) -> Build:
    """Size a design for the forces of its turn and of the pedal load: the lightest that plates in stock give.

    of: a name of materials(). safety: factor against yielding and buckling. Raises InputError for a material that is
    not known, holes that run into each other, links that cannot be laid out and loads that nothing in stock bears;
    MissingPartError without the extra `build`.
    """
    chosen, builds, refusals = material(of), [], []
    for thickness in plate_stock().thickness:
        try:
            builds.append(_sized(turn, chosen, safety, thickness))
        except InputError as error:
            refusals.append(error)
    if not builds:
        raise refusals[-1]
    return min(builds, key=lambda candidate: sum(candidate.mass.values()))


def _sized(turn: QuasiStatic, chosen: Material, safety: float, thickness: float) -> Build:
    """With plates of this thickness: sizes grow until layers, masses and loads ask for no more."""
    design, smallest = turn.design, pin_stock().diameter[0]
    joints = (joint for joint in design.linkage.architecture.joints if joint not in JOINTS)
    pins = dict.fromkeys(joints, smallest) | {BOUGHT: PEDAL_HOLE}
    widths = dict.fromkeys(hole_places(design), plate_stock().width[0])
    while True:
        plates = {body: _plate(design, body, pins, width, thickness) for body, width in widths.items()}
        layers = stack(Side(design, plates, pins))
        masses = tuple((body, plate.inertia(chosen.density)) for body, plate in plates.items())
        with_masses = replace(turn, motion=replace(turn.motion, design=replace(design, links=masses)))
        loads = LinkLoads.of(with_masses)
        larger = {joint: _pin(joint, loads, layers, safety) for joint in pins}
        wider = {body: _width(plate, loads, layers, chosen, safety) for body, plate in plates.items()}
        if (larger, wider) == (pins, widths):
            return Build(with_masses, chosen, layers, loads)
        pins, widths = larger, wider


def bush_wall(design: Design, joint: str, body: str, diameter: float) -> float:
    """Wall of the bush in a link's hole for a pin of this diameter, m: pins turn in the second body of their joint.

    The crank is fixed on its axle, the pedal screwed in: none there.
    """
    if joint in (BOUGHT, "crank_centre") or design.linkage.architecture.joints[joint][1] != body:
        return 0.0
    return pin_stock().bush_wall[pin_stock().diameter.index(diameter)]


def _plate(design: Design, body: str, pins: Mapping[str, float], width: float, thickness: float) -> Plate:
    """With holes for its pins and their bushes; refuses holes that run into each other."""
    holes = tuple(
        Hole(joint, place, pins[joint] + 2 * bush_wall(design, joint, body, pins[joint]))
        for joint, place in hole_places(design)[body].items()
    )
    for one, other in itertools.combinations(holes, 2):
        apart, least = abs(one.place - other.place), (one.diameter + other.diameter) / 2 + WALL
        if apart < least:
            raise InputError(
                f"{design.name}: the holes for {one.joint} and {other.joint} in the {body} are {1e3 * apart:.4g} mm "
                f"apart; with pins that bear their loads they need {1e3 * least:.3g} mm"
            )
    return Plate(body, holes, width / 2, thickness)


def _pin(joint: str, loads: LinkLoads, layers: Stack, safety: float) -> float:
    """Diameter of the thinnest pin that bears the forces on a joint, m, from the one that is there on.

    Held in the middle of one body it is pushed in that of the other: bent, the crank's axle also twisted, sheared, and
    pressed against its bush.
    """
    least, stock = layers.side.pins[joint], pin_stock()
    if joint == BOUGHT:
        return least
    force, lever = loads.largest(joint), layers.pin_lengths[joint]
    torque, allowed = loads.torque if joint == "crank_centre" else 0.0, stock.yield_strength / safety
    for diameter in (size for size in stock.diameter if size >= least):
        bent, twisted = 32 * force * lever / (math.pi * diameter**3), 16 * torque / (math.pi * diameter**3)
        sheared = 16 * force / (3 * math.pi * diameter**2)  # in the middle of a round section
        stress = max(math.hypot(bent, math.sqrt(3) * twisted), math.sqrt(3) * (sheared + twisted))
        if stress <= allowed and force <= stock.pressure * diameter * layers.thickness:
            return diameter
    raise InputError(
        f"{layers.side.design.name}: no pin in stock bears the {force:.0f} N on the {joint.replace('_', ' ')}, "
        f"{1e3 * lever:.0f} mm out; look for a larger transmission angle"
    )


def _width(plate: Plate, loads: LinkLoads, layers: Stack, chosen: Material, safety: float) -> float:
    """Width of the narrowest plate that bears its loads, m, from its own on.

    In every section pulled, bent in its plane and, as pins stand out on one side, across it; as a whole it may buckle.
    """
    thick, hole = plate.thickness, max(hole.diameter for hole in plate.holes)
    levers = {hole.joint: (thick + WASHER) / 2 for hole in plate.holes} | {BOUGHT: layers.pin_lengths[BOUGHT]}
    least, sections = max(plate.width, 2 * plate_stock().edge * hole), list(loads.sections(plate, levers))
    for width in (size for size in plate_stock().width if size >= least):
        net, modulus = thick * (width - hole), thick * (width**3 - hole**3) / (6 * width)
        bears = all(
            np.max(np.abs(part.pull) / net + np.abs(part.bending) / modulus + 6 * part.across / (net * thick)) * safety
            <= chosen.yield_strength
            and np.max(-part.pull) * safety <= math.pi**2 * chosen.modulus * width * thick**3 / 12 / part.length**2
            for part in sections
        )
        if bears:
            return width
    bending = max(float(np.abs(section.bending).max()) for section in sections)
    raise InputError(
        f"{layers.side.design.name}: no plate of {chosen.name} in stock bears the {bending:.0f} N m on the {plate.body}"
    )

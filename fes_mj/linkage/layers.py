"""In which layers beside each other the links of one side lie, so that nothing meets in the whole turn.

Layer 1 is next to the frame, the leg is outside of all. What is joined lies in different layers; a pin passes through
the layers between those of its two bodies.
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.linkage.clearance import CLEARANCE, WASHER, Gap, Side
from fes_mj.linkage.shapes import PARTS


@dataclass(frozen=True)
class Stack:
    """Layers by link, on one side of a tricycle."""

    side: Side
    layers: Mapping[str, int]

    @property
    def thickness(self) -> float:
        """Of the thickest plate, m."""
        return max(plate.thickness for plate in self.side.plates.values())

    @property
    def inner(self) -> float:
        """From the tricycle's middle to the inside of layer 1, m."""
        return (self.side.design.frame.tube_diameter or 2 * PARTS["frame"].size) / 2 + WASHER

    def level(self, body: str) -> float:
        """From the tricycle's middle to the middle of a link, or of the leg ("shank"), m."""
        if body in self.layers:
            return self.inner + (self.layers[body] - 1) * (self.thickness + WASHER) + self.thickness / 2
        return max(
            self.level(gap.parts[1]) + self.thickness / 2 + WASHER + self.side.shapes[gap.parts[0]][0].radius
            for gap in self.beside_leg
        )

    @property
    def beside_leg(self) -> list[Gap]:
        """Links that pass beside a part of the leg; the link with the pedal is always one of them."""
        carrier = self.side.design.linkage.architecture.pedal_body
        near = [gap for gap in self.side.gaps if gap.parts[0] in self.side.limbs and gap.distance < CLEARANCE]
        return [gap for gap in near if gap.parts[1] in self.layers] + [self.side.gap("boot", carrier)]

    @property
    def feet(self) -> float:
        """Between the middles of the two feet, m."""
        return 2 * self.level("shank")

    @property
    def pin_lengths(self) -> dict[str, float]:
        """From the middle of one of its bodies to that of the other, by joint, m."""
        joints = self.side.design.linkage.architecture.joints
        level = {"frame": 0.0} | {body: self.level(body) for body in (*self.layers, "shank")}
        return {joint: abs(level[joints[joint][0]] - level[joints[joint][1]]) for joint in self.side.pins}


def stack(side: Side) -> Stack:
    """The fewest layers with the shortest pins.

    Raises InputError, naming the pair, where links or pins meet in whatever layers the links lie.
    """
    layers, nearest = _arrangement(side)
    if nearest is None or nearest.distance >= CLEARANCE:
        return Stack(side, layers)
    raise InputError(
        f"{side.design.name}: the links cannot be laid out: in whatever layers they lie, something meets; in the best "
        f"of them {nearest.pair} come as near as {1e3 * nearest.distance:.1f} mm at crank angle "
        f"{np.degrees(nearest.crank_angle):.0f} deg ({1e3 * CLEARANCE:g} mm are needed); move them apart"
    )


def least_clearance(side: Side) -> float:
    """What is left between moving parts in the best layers, and to what they cannot pass beside, m."""
    _, nearest = _arrangement(side)
    return min(gap.distance for gap in (*side.walls, *([nearest] if nearest else [])))


def _arrangement(side: Side) -> tuple[dict[str, int], Gap | None]:
    """Layers by link, and what comes nearest in them: the fewest that are clear, or else the clearest."""
    links, joints = tuple(side.plates), side.design.linkage.architecture.joints
    apart = {*links, *side.pins}
    gaps = {pair: side.gap(*pair) for pair in side.pairs if {*pair} <= apart}
    candidates: list[tuple[tuple[float, int, int], dict[str, int], Gap | None]] = []
    for numbers in itertools.product(range(1, len(links) + 1), repeat=len(links)):
        if {*numbers} != {*range(1, max(numbers) + 1)}:
            continue
        layers = dict(zip(links, numbers, strict=True))
        level = {"frame": 0, **layers, "shank": len(links) + 1}
        if any(level[one] == level[other] for one, other in joints.values() if {one, other} <= {*links}):
            continue
        spans = {joint: sorted(level[body] for body in joints[joint]) for joint in side.pins}
        nearest = min(_meeting(layers, spans, gaps), key=lambda gap: gap.distance, default=None)
        lacking = max(0.0, CLEARANCE - nearest.distance) if nearest else 0.0
        length = sum(high - low for low, high in spans.values())
        candidates.append(((lacking, max(numbers), length), layers, nearest))
    _, layers, nearest = min(candidates, key=lambda candidate: candidate[0])
    return layers, nearest


def _meeting(
    layers: Mapping[str, int], spans: Mapping[str, list[int]], gaps: Mapping[tuple[str, str], Gap]
) -> Iterator[Gap]:
    """Gaps of what lies in one layer: links, and pins that pass through it."""
    for (one, other), gap in gaps.items():
        low, high = spans.get(other, [layers.get(other, 0)] * 2)
        if (
            one in layers
            and (other in layers or other in spans)
            and (low < layers[one] < high or low == layers[one] == high)
        ):
            yield gap

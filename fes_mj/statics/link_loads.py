"""What pins and links bear over a turn: riding, and a load on the pedal with the crank blocked at any angle."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.inertia import BodyLoad
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.plates import Hole, Plate
from fes_mj.statics.equilibrium import equilibrium
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.turn import QuasiStatic

PEDAL_LOAD = 1500.0  # N; ISO 4210-8 and EN 14766 load pedals and drives with it


class LinkSection(NamedTuple):
    """Of a link beside the hole of a joint `start`, on the way to `end`: what the part beyond puts on it over the turn.

    case: riding or pushed. pull: N along the arm. bending: N m in the plane, across: out of it. length: m, to the arm's
    end.
    """

    case: str
    start: str
    end: str
    pull: FloatArray
    bending: FloatArray
    across: FloatArray
    length: float


@dataclass(frozen=True, eq=False)
class LinkLoads:
    """The two cases. motion: of a design over a turn. riding, pushed: forces on joints as QuasiStatic.reactions, N.

    torque: largest on the crank's axle in either case, N m.
    """

    motion: Motion
    riding: dict[str, ComplexArray]
    pushed: dict[str, ComplexArray]
    torque: float

    @classmethod
    def of(cls, turn: QuasiStatic) -> "LinkLoads":
        """Of a turn with the masses of its design, and of PEDAL_LOAD."""
        moment, pushed = pedal_forces(turn.motion, PEDAL_LOAD)
        torque = max(float(np.abs(case).max()) for case in (turn.crank_moment, moment))
        return cls(turn.motion, JointForces(turn).with_masses, pushed, torque)

    def largest(self, joint: str) -> float:
        """On a joint, N."""
        return max(float(np.abs(case[joint]).max()) for case in (self.riding, self.pushed))

    def sections(self, plate: Plate, levers: Mapping[str, float]) -> Iterator[LinkSection]:
        """All sections of a link in both cases. Its arms go from its origin to its other holes.

        levers: how far outside the plate's middle each joint is pushed, m. The arms of a triangle count as bars of the
        plate's width: less than they are.
        """
        joints, direction = self.motion.design.linkage.architecture.joints, self.motion.direction(plate.body)
        for name, case in (("riding", self.riding), ("pushed", self.pushed)):
            forces = {
                joint: (1 if joints[joint][1] == plate.body else -1) * case[joint] * np.conj(direction)
                for joint, _, _ in plate.holes
            }
            for along, arm in _arms(plate):
                for number, start in enumerate([plate.holes[0], *arm[:-1]]):
                    beyond = [
                        (forces[hole.joint], hole.place - start.place, levers[hole.joint]) for hole in arm[number:]
                    ]
                    pull = np.sum([(force * np.conj(along)).real for force, _, _ in beyond], axis=0)
                    bending = np.sum([(np.conj(reach) * force).imag for force, reach, _ in beyond], axis=0)
                    across = np.sum([lever * np.abs(force) for force, _, lever in beyond], axis=0)
                    length = float(abs(arm[-1].place - start.place))
                    yield LinkSection(name, start.joint, arm[-1].joint, pull, bending, across, length)


def pedal_forces(motion: Motion, load: float) -> tuple[FloatArray, dict[str, ComplexArray]]:
    """Crank moment and joint reactions, as `equilibrium`, of so many N away from the hip on the pedal alone."""
    pedal, still = motion.points["pedal"], np.zeros_like(motion.crank_angle)
    force = load * pedal.value / np.abs(pedal.value)
    carrier = motion.design.linkage.architecture.pedal_body
    loads = {body: BodyLoad(force * (body == carrier), pedal, still) for body in motion.rotation}
    moment, reactions = equilibrium(motion, PerJoint(still, still), loads)
    return moment, reactions | {"pedal": force}


def _arms(plate: Plate) -> list[tuple[complex, list[Hole]]]:
    """Directions from a plate's origin, and the holes in each, the nearest first."""
    arms: list[tuple[complex, list[Hole]]] = []
    for hole in sorted(plate.holes[1:], key=lambda hole: abs(hole.place)):
        along = hole.place / abs(hole.place)
        same = next((arm for direction, arm in arms if abs(direction - along) < 1e-9), None)
        if same:
            same.append(hole)
        else:
            arms.append((along, [hole]))
    return arms

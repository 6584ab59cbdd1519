"""One turn of the crank as it was recorded."""

from dataclasses import dataclass, field

from fes_mj.common.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Turn:
    """Moments of one turn, and the joint angles that were recorded with them.

    crank_angle: rad from top dead centre; knee, hip: moment, N m, extension positive; shape (n,) each.
    joint_angle: by joint, rad, growing in extension, at the crank angles `pose` (rad from top dead centre), shape (m,).
    duration: s, None where no time is recorded. crank_speed: smallest and largest per mean, by the knee's angle.
    source: rider and trial that it belongs to.
    """

    crank_angle: FloatArray
    knee: FloatArray
    hip: FloatArray
    pose: FloatArray | None = None
    joint_angle: dict[str, FloatArray] = field(default_factory=dict)
    duration: float | None = None
    crank_speed: tuple[float, float] | None = None
    source: tuple[str, str] = ("", "")

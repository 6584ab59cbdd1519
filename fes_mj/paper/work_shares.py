"""Szecsi's shares of work, counted on recovered curves: the sign of a moment, which says who works, is not linear."""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import read_toml
from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.fourier import fourier
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import Rows, table
from fes_mj.paper.evidence import own_leg_motion
from fes_mj.paper.known import BASES, Known
from fes_mj.paper.statements import TEXT_FILE

ACTIONS = {
    "knee extensors": ("knee", 1),
    "knee flexors": ("knee", -1),
    "hip extensors": ("hip", 1),
    "hip flexors": ("hip", -1),
}


class Work(NamedTuple):
    """Work of some muscles in a turn per 2 pi and cadence, shape (curves,): while they shorten, while they lengthen."""

    concentric: FloatArray
    eccentric: FloatArray

    @property
    def net(self) -> FloatArray:
        return self.concentric + self.eccentric


def work(curves: FloatArray, leg: float) -> dict[str, Work]:
    """What extensors and flexors of each joint do in the TRT, legs of `leg` m; curves: shape (curves, 98), N m.

    Extensors do what is done while the moment extends, whichever way the joint moves.
    """
    motion = own_leg_motion(leg)
    features = fourier(motion.crank_angle - PAPER_TRICYCLE.top_dead_centre)
    moments = PerJoint(*(part @ features.T for part in np.split(curves, 2, axis=1)))
    done = {}
    for name, (joint, sign) in ACTIONS.items():
        power = np.where(sign * moments[joint] > 0, moments[joint] * motion.joint_rate[joint], 0.0)
        done[name] = Work(np.maximum(power, 0).mean(axis=1), np.minimum(power, 0).mean(axis=1))
    return done


def shares(curves: FloatArray, leg: float, muscles: str) -> tuple[FloatArray, FloatArray]:
    """Share of `muscles`, or of all "eccentric" work, in %, if 100 % is the net work of the leg: net work per net work;
    and if it is all concentric work: concentric per concentric. Shapes (curves,).
    """
    done = work(curves, leg)
    concentric, eccentric = (
        np.sum([getattr(done_by, kind) for done_by in done.values()], axis=0) for kind in Work._fields
    )
    net, part = (eccentric, eccentric) if muscles == "eccentric" else (done[muscles].net, done[muscles].concentric)
    return 100 * net / (concentric + eccentric), 100 * part / concentric


@table("share", reading=[f"{reading}, {basis}" for reading in ("net", "concentric") for basis in BASES])
def work_share_table(known: Known) -> Rows:
    """What the abstract says beside both readings, by curves of the numbers alone and with the text."""
    for row in read_toml(TEXT_FILE, "statements").content["share"]:
        group, muscles = row["group"], row["muscles"]
        counted = [shares(recovered.curves[group], row["leg_m"], muscles) for recovered in known.by_basis.values()]
        values = (basis for reading in zip(*counted, strict=True) for basis in reading)
        # a ratio can be anything where its denominator nears 0, so no sd, but half of what two thirds of them span
        spans = (np.quantile(share, (1 / 6, 1 / 2, 5 / 6)) for share in values)
        cells = (with_sd(middle, (high - low) / 2, 0) for low, middle, high in spans)
        yield group, muscles, float(row["value"]), *cells

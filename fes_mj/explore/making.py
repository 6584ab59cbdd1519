"""Whether a design can be made, as `fes_mj draw` finds it: layers, and what comes nearest to what."""

from typing import Any

import numpy as np

from fes_mj.common.errors import InputError, MissingPartError
from fes_mj.linkage.clearance import Gap
from fes_mj.linkage.design import Design
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.sizes import FORCE_POINTS, build
from fes_mj.statics.turn import quasi_static


def making(design: Design, moments: JointMoments) -> dict[str, Any]:
    """A sentence and, of a design that can be laid out, its links by layer and the pairs that come nearest."""
    try:
        built = build(quasi_static(design, moments, points=FORCE_POINTS))
    except (InputError, MissingPartError) as error:
        return {"ok": False, "verdict": str(error).removeprefix(f"{design.name}: ")}
    side, layers = built.stack.side, built.stack.layers
    meeting = ", ".join(f"{gap.pair} ({_mm(gap)} mm)" for gap in side.hindrances)
    return {
        "ok": not meeting,
        "verdict": f"cannot be built so: {meeting}" if meeting else f"feet {1e3 * built.stack.feet:.0f} mm apart",
        "layers": [[link for link in layers if layers[link] == layer] for layer in sorted({*layers.values()})],
        "gaps": [
            {"pair": gap.pair, "mm": _mm(gap), "deg": round(float(np.degrees(gap.crank_angle)))} for gap in side.near
        ],
        "unknown": [*dict.fromkeys(part for _, part in side.unknown)],
    }


def _mm(gap: Gap) -> str:
    return f"{1e3 * gap.distance:.1f}".replace("-", "\N{MINUS SIGN}")

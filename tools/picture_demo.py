"""Make README's picture, docs/images/d1.png, a frame of the demo's video: python -m tools.picture_demo"""

from pathlib import Path

import numpy as np

from fes_mj.budget.answer import answer
from fes_mj.common.arrays import Picture
from fes_mj.common.writing import replacing
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.muscles.riders import load_riders
from fes_mj.viewing import render

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "d1.png"
ANGLE = 130.0  # deg of crank angle, at which leg and linkage do not hide each other


def frame() -> Picture:
    """The frame nearest to the angle. Raises MissingPartError without OpenGL or a package of the extra "video"."""
    render.require_video()
    case = Case(load_design("d1"), load_moments())
    both = answer(case.design, riders=load_riders("p1p2"))
    speed = render.slow_motion(case.cadence)
    steps = render.steps_shown(case.simulation, speed)
    nearest = np.argmin(np.abs(np.degrees(case.simulation.crank_angle[steps]) % 360 - ANGLE))
    return next(render.turn_frames(case, steps[[nearest]], speed, both))


def main() -> None:
    """Draw it and keep it."""
    from PIL import Image

    with replacing(PICTURE) as beside:
        Image.fromarray(frame()).save(beside, optimize=True)


if __name__ == "__main__":
    main()

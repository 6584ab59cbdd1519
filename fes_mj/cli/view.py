"""`fes_mj view`: the model in MuJoCo's interactive viewer."""

import os
import sys

from fes_mj.cli.options import LoadOptions
from fes_mj.errors import MissingPartError

_DEFAULTS = LoadOptions()


def view(design: str, /, *, options: LoadOptions = _DEFAULTS) -> int:
    """Watch a design run in MuJoCo's viewer, under the torque map and the crank servo.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    """
    loaded = options.load(design)
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise MissingPartError(
            "the viewer needs a screen and there is none; make a video instead: fes_mj simulate ... --render out.mp4"
        )
    from fes_mj.viewing import viewer

    viewer.show(*loaded)
    return 0

"""`fes_mj view`: the model in MuJoCo's interactive viewer."""

from fes_mj.cli.options import LoadOptions

_DEFAULTS = LoadOptions()


def view(design: str, /, *, options: LoadOptions = _DEFAULTS) -> int:
    """Watch a design run in MuJoCo's viewer, under the torque map and the crank servo.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    """
    loaded = options.load(design)
    from fes_mj.viewing import viewer

    viewer.show(*loaded)
    return 0

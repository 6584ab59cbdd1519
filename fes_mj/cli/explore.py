"""`fes_mj explore`: the designer's page in the browser."""

from fes_mj.cli.options import MomentsOptions
from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import load_design

_DEFAULTS = MomentsOptions()
PORT, THIS_MACHINE = 8026, "127.0.0.1"


def explore(
    design: str = "d1",
    /,
    *,
    options: MomentsOptions = _DEFAULTS,
    port: int = PORT,
    host: str = THIS_MACHINE,
    browser: bool = True,
) -> int:
    """Drag the dimensions of a design in the browser and see at once what they do, until Ctrl-C.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    port
        Of the page on this machine; 0 takes any that is free.
    host
        Address to listen on. Any but the default can be reached by others, who need no password.
    browser
        Open the page in the browser.
    """
    if not 0 <= port <= 65535:
        raise InputError(f"--port is {port}; it must be from 0 to 65535")
    loaded, moments = load_design(design), options.load_moments()
    from fes_mj.explore.answers import Answers
    from fes_mj.explore.server import serve

    serve(Answers(loaded, moments), host, port, browser)
    return 0

"""`fes_mj explore`: the designer's page in the browser."""

from typing import Annotated, Literal

from cyclopts import Parameter
from cyclopts.validators import Number

from fes_mj.cli.options import DRIVEN_BY, DesignName, Flag, MomentsOptions
from fes_mj.common.errors import require_extra
from fes_mj.linkage.design_file import load_design

PORT, THIS_MACHINE = 8026, "127.0.0.1"


def _named(_: object, host: str) -> None:
    if not host:  # which would be all addresses
        raise ValueError("It must be a name or an address of this machine.")


def explore(
    design: DesignName = "d1",
    /,
    *,
    options: MomentsOptions = MomentsOptions(),
    port: Annotated[int, Parameter(validator=Number(gte=0, lte=65535))] = PORT,
    host: Annotated[str, Parameter(validator=_named)] = THIS_MACHINE,
    browser: bool = True,
    drive: Annotated[Literal["moments", "muscles"], Parameter(group=("Parameters", DRIVEN_BY))] = "moments",
    debug: Flag = False,
) -> None:
    """Drag the dimensions of a design in the browser and see at once what they do, until Ctrl-C.

    Args:
        port: Of the page on this machine; 0 takes any that is free.
        host: Address to listen on. At any but the default others can use the page too, if they know its whole address.
        browser: Open the page in the browser.
        drive: What drives at first: joint moments, or stimulated muscles with the best timing.
        debug: Print where an answer failed, if that was not expected.
    """
    loaded, moments = load_design(design), options.load_moments()
    require_extra("explore", "starlette", "uvicorn")
    from fes_mj.explore.answers import Answers
    from fes_mj.explore.server import serve

    serve(Answers(loaded, moments, drive), host, port, browser, debug)

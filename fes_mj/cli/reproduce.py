"""`fes_mj reproduce`: the paper's tables and figures beside the project's."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from fes_mj.cli.options import Flag, Out
from fes_mj.common.console import say
from fes_mj.common.errors import require_extra


def reproduce(
    *,
    out: Out = Path("results"),
    svg: Flag = False,
    quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False,
) -> None:
    """Compute the paper's tables and figures and write them beside the project's own.

    Args:
        out: Folder for the pages (Markdown), figures (PNG) and numbers (JSON); it is made if its parent exists.
        svg: Figures as SVG too, for print.
        quiet: Print nothing but errors.
    """
    require_extra("paper", "matplotlib", "SALib")
    from fes_mj.paper import reproduce as paper

    for path in paper.reproduce(out, svg, quiet):
        if not quiet:
            say(str(path))

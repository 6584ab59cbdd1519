"""`fes_mj reproduce`: the paper's tables and figures beside the project's."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from fes_mj.cli.output import errors, output
from fes_mj.errors import InputError, MissingPartError
from fes_mj.files import require_folder


def reproduce(
    *, out: Path = Path("results"), quiet: Annotated[bool, Parameter(alias="-q", negative="")] = False
) -> int:
    """Compute the paper's tables and figures and write them beside the project's own.

    Parameters
    ----------
    out
        Folder for the pages (Markdown), figures (PNG, SVG) and numbers (JSON); it is made if its parent exists.
    quiet
        Print nothing but errors.
    """
    if find_spec("matplotlib") is None:
        raise MissingPartError("figures need matplotlib, which is not installed: pip install 'fes-mj[video]'")
    _make_folder(out)
    from rich.progress import Progress

    from fes_mj.paper import reproduce as paper

    with Progress(console=errors, transient=True, disable=quiet) as progress:
        task = progress.add_task("reproducing the paper", total=paper.steps())
        written = paper.reproduce(out, lambda: progress.advance(task))
    if not quiet:
        for path in written:
            output.print(str(path), markup=False, soft_wrap=True)
    return 0


def _make_folder(out: Path) -> None:
    if not out.exists():
        require_folder(out.parent, "the results")
        try:
            out.mkdir()
        except OSError as error:
            raise InputError(f"{out}: cannot be made: {error.strerror}") from None
    require_folder(out, "the results")

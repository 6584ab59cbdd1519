"""A design of the command line as a case that is checked: the same one whichever command asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fes_mj.linkage.design_file import DESIGNS, design_path
from fes_mj.statics.drive import driven_speed

if TYPE_CHECKING:
    from fes_mj.cli.drive import DriveOptions
    from fes_mj.cli.options import RunOptions
    from fes_mj.verification.case import VerificationCase


def checked_case(design: str, options: RunOptions, drive: DriveOptions, **more: Any) -> VerificationCase:
    """The case of one leg, valid for all legs that are asked for. Raises InputError for what cannot be used.

    more: of VerificationCase.
    """
    from fes_mj.paper.printed import table1
    from fes_mj.verification.case import VerificationCase

    loaded = drive.load(options, design)
    driven_speed(*loaded, options.legs)
    printed = table1()[design] if design in DESIGNS and options.dims == "identified" else None
    return VerificationCase(*loaded, expected=printed, file=design_path(design, options.dims), **more)

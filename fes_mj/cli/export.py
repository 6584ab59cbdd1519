"""`fes_mj export`: the MJCF model of a design, for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from fes_mj.cli.options import crank_speed
from fes_mj.cli.output import output
from fes_mj.design_file import load_design
from fes_mj.files import require_writable, write_text


def export(
    design: str,
    /,
    *,
    out: Annotated[Path, Parameter(name=["--out", "-o"])],
    variant: Literal["sites", "bodies"] = "sites",
    cadence: float | None = None,
    dims: Literal["identified", "printed"] = "identified",
) -> int:
    """Write the MJCF model of a design.

    Parameters
    ----------
    design
        trt, r1, r2, d1, d2, or a path to a design file.
    out
        The file to write (.xml).
    variant
        How loops are anchored: at sites, or on bodies (for readers that drop site anchors).
    cadence
        Crank speed of the keyframe and the servo, rpm; by default the one at 5.71 km/h.
    dims
        Dimensions of a catalogued design: as identified, or as the paper prints them.
    """
    loaded = load_design(design, dims)
    speed = crank_speed(cadence, loaded)
    require_writable(out, "the model", ".xml")
    from fes_mj.mjcf import mjcf_text

    write_text(out, mjcf_text(loaded, cadence=speed, variant=variant))
    output.print(f"model: {out}", markup=False, soft_wrap=True)
    return 0

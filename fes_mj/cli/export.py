"""`fes_mj export`: the MJCF model of a design and its turn as a table, for other tools."""

from dataclasses import replace
from typing import Annotated, Literal

from cyclopts import Parameter

import fes_mj
from fes_mj.cli.options import DesignName, Flag, LoadOptions, Out
from fes_mj.common.console import say

# the keys of simulation.variants.VARIANTS
_Variant = Literal["sites", "bodies", "passive", "free", "brake", "ride", "fixed-gear", "two-legs", "compatible"]


def export(
    design: DesignName,
    /,
    *,
    out: Out,
    variant: Annotated[list[_Variant] | None, Parameter(negative="")] = None,
    scene: Flag = False,
    options: LoadOptions = LoadOptions(),
) -> None:
    """Write the MJCF model of a design and, beside it as CSV, its joint and crank moments over a turn.

    Args:
        out: The model to write (.xml); the table gets the same name with .csv.
        variant: sites: loops anchored at sites (default); bodies: on bodies, for Drake; passive: nothing drives,
            neither joint motors nor servo; free: motors, but nothing on the crank; brake: a flywheel and a brake on it
            in place of the servo; ride: both legs on a tricycle that rides on a flat road with a freewheel; fixed-gear:
            that one without the freewheel; two-legs: as --legs 2; compatible: for readers without the integrator
            `discrete`, a flywheel holds the cadence. Give --variant again to combine them.
        scene: Also write scene.xml beside the model: floor, light and camera.
    """
    from fes_mj.simulation.variants import variant_options

    variants = [*(variant or ()), *(["two-legs"] if options.legs == 2 else [])]
    loaded = replace(options, legs=variant_options(variants).get("legs", 1)).load(design)
    files = fes_mj.export(
        loaded.design,
        loaded.moments,
        out,
        cadence=loaded.cadence,
        variants=variants,
        scene=scene,
        inputs=options.inputs(design),
    )
    for content, path in files.items():
        say(f"{content}: {path}")

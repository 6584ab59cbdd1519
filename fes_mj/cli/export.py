"""`fes_mj export`: the MJCF model of a design and its turn as a table, for other tools."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import fes_mj
from fes_mj.cli.drive import DriveOptions
from fes_mj.cli.options import DesignName, Flag, LoadOptions, Out, PrintOptions
from fes_mj.common.console import print_table, say
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.muscles.drive import Muscles

if TYPE_CHECKING:
    from fes_mj.simulation.native_muscles import NativeMuscles

# the keys of simulation.variants.VARIANTS
_Variant = Literal[
    "sites", "bodies", "passive", "free", "brake", "ride", "fixed-gear", "two-legs", "muscles", "compatible"
]


def export(
    design: DesignName,
    /,
    *,
    out: Out,
    variant: Annotated[list[_Variant] | None, Parameter(negative="")] = None,
    scene: Flag = False,
    options: LoadOptions = LoadOptions(),
    printed: PrintOptions = PrintOptions(),
) -> None:
    """Write the MJCF model of a design and, beside it as CSV, its joint and crank moments over a turn.

    Args:
        out: The model to write (.xml); the table gets the same name with .csv.
        variant: sites: loops anchored at sites (default); bodies: on bodies, for Drake; passive: nothing drives,
            neither joint motors nor servo; free: motors, but nothing on the crank; brake: a flywheel and a brake on it
            in place of the servo; ride: both legs on a tricycle that rides on a flat road with a freewheel; fixed-gear:
            that one without the freewheel; two-legs: as --legs 2; muscles: MuJoCo's own muscles, fitted to those of
            the group's most probable rider, in place of motors, with their activations in the table; compatible: for
            readers without the integrator `discrete`, a flywheel holds the cadence. Give --variant again to combine
            them.
        scene: Also write scene.xml beside the model: floor, light and camera.
    """
    from fes_mj.simulation.native_muscles import native_muscles
    from fes_mj.simulation.variants import variant_options

    variants = [*(variant or ()), *(["two-legs"] if options.legs == 2 else [])]
    options = replace(options, legs=variant_options(variants).get("legs", 1))
    if "muscles" in variants and options.moments:
        raise InputError("--moments say nothing of muscles; give --group, or leave out --variant muscles")
    loaded = DriveOptions("muscles" if "muscles" in variants else "moments").load(options, design)
    files = fes_mj.export(
        loaded.design,
        loaded.drive,
        out,
        cadence=loaded.cadence,
        variants=variants,
        scene=scene,
        inputs=options.inputs(design),
    )
    native = native_muscles(loaded.design, loaded.drive, loaded.cadence) if isinstance(loaded.drive, Muscles) else None
    content = {
        "design": loaded.design.name,
        "cadence_rpm": loaded.cadence / RPM,
        "variants": variants,
        "files": {kind: str(path) for kind, path in files.items()},
    }
    printed.show(lambda: content | (native.summary() if native else {}), lambda: _print(native), **files)


def _print(native: "NativeMuscles | None") -> None:
    """What native muscles leave of the power, and how well they fit; of other models their files say all."""
    if native:
        rows = [
            (row["name"], *(f"{row[key]:.2f}" for key in row if key.endswith(("_mm", "_percent"))))
            for row in native.summary()["native_muscles"]
        ]
        say(native.sentence)
        print_table("Fit over the turn", ("muscle", "length, mm", "moment arm, %", "force, %"), rows)

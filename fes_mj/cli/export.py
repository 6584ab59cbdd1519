"""`fes_mj export`: the MJCF model of a design and its turn as a table, for other tools."""

from dataclasses import replace
from typing import Annotated, Literal

from cyclopts import Parameter

from fes_mj.cli.options import DesignName, Flag, LoadOptions, Out
from fes_mj.common.console import say
from fes_mj.common.errors import InputError
from fes_mj.common.text import printable
from fes_mj.common.writing import require_replaceable, require_writable, write_files

_DEFAULTS = LoadOptions()
_SCENE = "scene.xml"
# the keys of simulation.variants.VARIANTS
_Variant = Literal["sites", "bodies", "passive", "free", "brake", "ride", "fixed-gear", "two-legs", "compatible"]


def export(
    design: DesignName,
    /,
    *,
    out: Out,
    variant: Annotated[list[_Variant] | None, Parameter(negative="")] = None,
    scene: Flag = False,
    options: LoadOptions = _DEFAULTS,
) -> int:
    """Write the MJCF model of a design and, beside it as CSV, its joint and crank moments over a turn.

    Parameters
    ----------
    out
        The model to write (.xml); the table gets the same name with .csv.
    variant
        sites: loops anchored at sites (default); bodies: on bodies, for Drake; passive: nothing drives, neither joint
        motors nor servo; free: motors, but nothing on the crank; brake: a flywheel and a brake on it in place of the
        servo; ride: both legs on a tricycle that rides on a flat road with a freewheel; fixed-gear: that one without
        the freewheel; two-legs: as --legs 2; compatible: for readers without the integrator `discrete`, a flywheel
        holds the cadence. Give --variant again to combine them.
    scene
        Also write scene.xml beside the model: floor, light and camera.
    """
    from fes_mj.simulation.export import mjcf_text, scene_text, sidecar_text
    from fes_mj.simulation.variants import variant_model, variant_options

    changes = variant_options([*(variant or ()), *(["two-legs"] if options.legs == 2 else [])])
    legs = changes.get("legs", 1)
    loaded, inputs = replace(options, legs=legs).load(design), options.inputs(design)
    require_writable(out, "the model", ".xml", inputs)
    table, around = out.with_suffix(".csv"), out.with_name(_SCENE)
    require_replaceable([table], "the table", inputs)
    if scene:
        if out.name.lower() == _SCENE or printable(out.name) != out.name:
            raise InputError(f"{out}: --scene writes {_SCENE}, which names the model; give the model another name")
        require_replaceable([around], "the scene", inputs)
    texts = {
        out: mjcf_text(variant_model(*loaded, changes)),
        table: sidecar_text(loaded.design, loaded.moments, loaded.cadence, legs),
        **({around: scene_text(loaded.design, out.name)} if scene else {}),
    }
    write_files(texts, unnamed=texts.keys() - {out})
    for path, what in zip(texts, ("model", "table", "scene"), strict=False):
        say(f"{what}: {path}")
    return 0

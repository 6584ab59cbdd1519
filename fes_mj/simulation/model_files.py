"""A design's model as files for other tools: MJCF, its turn as a table, and a scene around it."""

from collections.abc import Collection, Iterable
from pathlib import Path

from fes_mj.common.errors import InputError
from fes_mj.common.text import printable
from fes_mj.common.writing import require_replaceable, require_writable, write_files
from fes_mj.linkage.design import Design
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.simulation.export import mjcf_text, scene_text, sidecar_text
from fes_mj.simulation.variants import variant_model, variant_options

_SCENE = "scene.xml"


def export(
    design: Design,
    moments: JointMoments,
    path: str | Path,
    *,
    cadence: float | None = None,
    variants: Iterable[str] = (),
    scene: bool = False,
    inputs: Collection[Path] = (),
) -> dict[str, Path]:
    """Write the MJCF model of a design to `path` (.xml) and, beside it as CSV, its moments over a turn.

    cadence: rad/s, by default Eq. 16. variants: names of variants.VARIANTS, combined. scene: also write scene.xml,
    beside the model: floor, light and camera. inputs: files that must not be replaced. Returns the paths by what they
    hold. Raises InputError for variants that exclude each other and for files that cannot be written, before any is.

    >>> files = fes_mj.export(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), folder / "d1.xml")
    >>> [file.name for file in files.values()]
    ['d1.xml', 'd1.csv']
    """
    options, out, cadence = variant_options(variants), Path(path), design.crank_speed(cadence)
    require_writable(out, "the model", ".xml", inputs)
    files = {"model": out, "table": out.with_suffix(".csv")}
    require_replaceable([files["table"]], "the table", inputs)
    if scene:
        if out.name.lower() == _SCENE or printable(out.name) != out.name:
            raise InputError(f"{out}: --scene writes {_SCENE}, which names the model; give the model another name")
        files["scene"] = out.with_name(_SCENE)
        require_replaceable([files["scene"]], "the scene", inputs)
    texts = {
        "model": mjcf_text(variant_model(design, moments, cadence, options)),
        "table": sidecar_text(design, moments, cadence, options.get("legs", 1)),
        "scene": scene_text(design, out.name),
    }
    write_files({file: texts[what] for what, file in files.items()}, unnamed={*files.values()} - {out})
    return files

"""Write mjcf/: each catalogued design as models, scene, table, README and picture (--no-pictures: all but that).

With --pictures only the pictures, of the models that are there.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from string import Template

from fes_mj.common.units import RPM
from fes_mj.common.writing import replacing, write_text
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.simulation.export import mjcf_text, scene_text, sidecar_text
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.variants import variant_model, variant_options
from fes_mj.statics.turn import quasi_static

TOOLS = Path(__file__).parent
FOLDER = TOOLS.parent / "mjcf"
WIDTH, HEIGHT = 960, 720  # pixels
# What is shipped beside the default model: file name after the design's -> variants.
SHIPPED = {
    "compatible": ("compatible",),
    "two-legs-free": ("two-legs", "free", "compatible"),
    "ride": ("ride", "compatible"),
    "ride-fixed-gear": ("ride", "fixed-gear", "compatible"),
}
POSE = 200.0  # deg of crank angle: leg and linkage are spread out in every design


def main() -> None:
    for name in DESIGNS:
        folder = FOLDER / name
        folder.mkdir(parents=True, exist_ok=True)
        if "--pictures" not in sys.argv:
            for file, text in model_files(load_design(name)).items():
                write_text(folder / file, text)
        if "--no-pictures" not in sys.argv:
            write_picture(folder / "scene.xml", folder / f"{name}.png")
        print(f"mjcf/{name}")


def model_files(design: Design) -> dict[str, str]:
    """The text files of a design's folder by name."""
    name, moments, cadence = design.name, load_moments(), design.linkage.cadence
    models = {f"{name}.xml": ()} | {f"{name}-{suffix}.xml": variants for suffix, variants in SHIPPED.items()}
    return {
        file: mjcf_text(variant_model(design, moments, cadence, variant_options(variants)))
        for file, variants in models.items()
    } | {
        "scene.xml": scene_text(design, f"{name}.xml"),
        f"{name}.csv": sidecar_text(design, moments),
        "README.md": _readme(design, moments),
    }


def _readme(design: Design, moments: JointMoments) -> str:
    model = build_mjcf(design).compile()
    return Template((TOOLS / "model_readme.md").read_text(encoding="utf-8")).substitute(
        name=design.name,
        NAME=design.name.upper(),
        title=design.linkage.title,
        rpm=f"{design.linkage.cadence / RPM:.2f}",
        joints=model.njnt + model.neq,
        loops="one of them a `connect` constraint" if model.neq == 1 else "two of them `connect` constraints",
        mass=f"{design.rider.mass:g}",
        thigh=f"{design.rider.thigh:g}",
        shank=f"{design.rider.shank:g}",
        group=moments.name.upper(),
        power=f"{quasi_static(design, moments).power_mean:.1f}",
    )


def write_picture(scene: Path, picture: Path) -> None:
    """Render the scene's oblique view. Raises MissingPartError without OpenGL or pillow."""
    from fes_mj.viewing.headless import use_offscreen_gl

    use_offscreen_gl()
    import mujoco
    from PIL import Image

    model = mujoco.MjModel.from_xml_path(str(scene))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    while math.degrees(data.joint("crank").qpos[0]) < POSE:
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer, replacing(picture) as beside:
        renderer.update_scene(data, camera="oblique")
        Image.fromarray(renderer.render()).save(beside, optimize=True)


if __name__ == "__main__":
    main()

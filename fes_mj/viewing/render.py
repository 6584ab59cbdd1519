"""The video of a cross-check: the moving legs and linkage beside the crank power over the turn."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from fes_mj import kinematics
from fes_mj.arrays import FloatArray, IntArray, Picture
from fes_mj.console import progress_bar
from fes_mj.crosscheck import Case
from fes_mj.design import BODIES, Design
from fes_mj.errors import InputError, MissingPartError, require_extra
from fes_mj.files import replacing
from fes_mj.geometry import bounding_box
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import Simulation
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.style import FAINT, INK
from fes_mj.viewing.headless import use_offscreen_gl

HEIGHT, SCENE_WIDTH, PLOT_WIDTH = 720, 720, 560  # pixels
FRAMES_PER_SECOND = 30
FRAMES = 120  # a turn: slow motion of four seconds
REPEATS = 2  # turns shown
# Seen from the rider's right, a little from above: the rider faces right, the crank turns clockwise.
AZIMUTH, ELEVATION, FIELD_OF_VIEW = -97.0, -7.0, 24.0  # deg
MARGIN = 0.5  # m around the joints, for flesh, seat and names
LABEL_CLEARANCE, LABEL_SPACING = 0.22, 0.26  # m: of the rows of names from the linkage, of the names in a row


def render_video(case: Case, path: Path, quiet: bool = False) -> None:
    """Write an H.264 video of one measured turn, shown REPEATS times, to `path`; raises as write_video."""
    require_video()
    from fes_mj.viewing.power_panel import PowerPanel

    run = case.simulation
    shown = np.linspace(0, len(run.crank_angle) // run.turns, FRAMES, endpoint=False).astype(int)
    panel = PowerPanel(case, PLOT_WIDTH, HEIGHT)
    pictures = (
        np.hstack([scene, panel.frame(int(step))]) for step, scene in zip(shown, scenes(run, shown), strict=True)
    )
    write_video(path, pictures, FRAMES, quiet, REPEATS)


def require_video() -> None:
    """Raise MissingPartError if OpenGL, ffmpeg or a package of the extra "video" is missing."""
    mediapy = require_extra("video", "mediapy", "imageio_ffmpeg", "matplotlib", "PIL")
    use_offscreen_gl()
    try:
        mediapy.set_ffmpeg(require_extra("video", "imageio_ffmpeg").get_ffmpeg_exe())
    except RuntimeError:
        raise MissingPartError("there is no ffmpeg; it comes with: pip install 'fes-mj[video]'") from None


def write_video(path: Path, pictures: Iterable[Picture], count: int, quiet: bool = False, repeats: int = 1) -> None:
    """Write `count` pictures, shape (HEIGHT, SCENE_WIDTH + PLOT_WIDTH, 3), as video. Raises InputError if it cannot."""
    mediapy = require_extra("video", "mediapy")
    with progress_bar("rendering, frames", count, quiet) as advance, replacing(path) as beside:
        frames = []
        for picture in pictures:
            frames.append(picture)
            advance(1)
        try:
            shape = (HEIGHT, SCENE_WIDTH + PLOT_WIDTH)
            with mediapy.VideoWriter(beside, shape, fps=FRAMES_PER_SECOND, crf=20) as writer:
                for frame in frames * repeats:
                    writer.add_image(frame)
        except (RuntimeError, BrokenPipeError) as error:  # the encoder ended, with words or without
            reason = str(error).rpartition("] ")[2].strip()
            raise InputError(f"{path}: cannot be written: the encoder stopped: {reason}") from None


def set_stage(spec: Spec) -> None:
    """Light, sky and picture size of a video."""
    spec.visual.global_.offwidth, spec.visual.global_.offheight = SCENE_WIDTH, HEIGHT
    spec.visual.global_.fovy = FIELD_OF_VIEW
    spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.55] * 3, [0.5] * 3
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=64)
    sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, [1, 1, 1], [0.86, 0.89, 0.93]


def scenes(run: Simulation, steps: IntArray) -> Iterator[Picture]:
    """Labelled pictures of the simulated model at the given steps, shape (HEIGHT, SCENE_WIDTH, 3)."""
    spec = build_mjcf(run.design, cadence=run.cadence, timestep=run.timestep, legs=len(run.legs))
    set_stage(spec)
    model = spec.compile()
    data, camera, labels = mujoco.MjData(model), turn_camera(run.design), _Labels(run)
    addresses = {name: model.joint(name).qposadr[0] for name in run.joint_angle}
    with mujoco.Renderer(model, HEIGHT, SCENE_WIDTH) as renderer:
        for step in steps:
            for name, address in addresses.items():
                data.qpos[address] = run.joint_angle[name][step]
            place(model, data)
            renderer.update_scene(data, camera)
            yield labels.draw(renderer.render(), data, renderer.scene.camera)


def place(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Put everything that is drawn where the joint positions have it."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_camlight(model, data)


def turn_camera(design: Design) -> mujoco.MjvCamera:
    """A fixed camera that sees every joint over the whole turn, with room for the names."""
    low, high = bounding_box(kinematics.positions(design, kinematics.FULL_TURN))
    centre, size = (low + high) / 2, max((high - low).real, (high - low).imag) + MARGIN
    camera = mujoco.MjvCamera()
    camera.lookat = (centre.real, 0.0, centre.imag)
    camera.distance = size / 2 / np.tan(np.radians(FIELD_OF_VIEW / 2))
    camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
    return camera


class _Labels:
    """Names in fixed places above and below the linkage, each with a line to its moving part."""

    def __init__(self, run: Simulation) -> None:
        from matplotlib import font_manager
        from PIL import ImageFont

        self._font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), 20)
        self._prefix = run.legs[0].prefix
        points = kinematics.positions(run.design, kinematics.FULL_TURN)

        def home(part: str) -> complex:
            """Mean position of a part over the turn, m."""
            return complex(np.mean([np.mean(points[end]) for end in BODIES.get(part, (part, part))]))

        low, high = bounding_box(points)
        rows = {
            high.imag + LABEL_CLEARANCE: ("thigh", "shank"),
            low.imag - LABEL_CLEARANCE: (*run.design.linkage.architecture.bodies[2:], "pedal"),
        }
        self._spots = {}  # m, as points of the scene: in the order of the parts, so that few lines cross
        for height, parts in rows.items():
            middle = np.mean([home(part).real for part in parts])
            for place, part in enumerate(sorted(parts, key=lambda part: home(part).real)):
                across = middle + (place - (len(parts) - 1) / 2) * LABEL_SPACING
                self._spots[part] = np.array([across, 0.0, height])

    def _targets(self, data: mujoco.MjData) -> dict[str, FloatArray]:
        """Where each name points, m: a body's centre of mass, or the pedal."""
        bodies = {body: body if body == "crank" else self._prefix + body for body in self._spots if body != "pedal"}
        return {
            "pedal": data.site(f"{self._prefix}shank_pedal").xpos,
            **{body: data.body(name).xipos for body, name in bodies.items()},
        }

    def draw(self, picture: Picture, data: mujoco.MjData, eyes: Any) -> Picture:
        """The picture with the names written on it; eyes: the scene's two cameras, between which it was taken."""
        from PIL import Image, ImageDraw

        image = Image.fromarray(picture)
        draw = ImageDraw.Draw(image)
        for name, target in self._targets(data).items():
            spot, (x, y) = _project(self._spots[name], eyes), _project(target, eyes)
            draw.line([spot, (x, y)], fill=FAINT, width=2)
            draw.ellipse([x - 4, y - 4, x + 4, y + 4], fill="white", outline=FAINT, width=2)
            draw.text(spot, name, font=self._font, fill=INK, anchor="mm", stroke_width=6, stroke_fill="white")
        return np.asarray(image)


def _project(point: FloatArray, eyes: Any) -> tuple[float, float]:
    """Pixel of a point in a picture taken from between two MjvGLCameras."""
    forward, up = np.array(eyes[0].forward), np.array(eyes[0].up)
    offset = point - np.mean([eye.pos for eye in eyes], axis=0)
    scale = HEIGHT / 2 / np.tan(np.radians(FIELD_OF_VIEW / 2)) / (offset @ forward)
    return SCENE_WIDTH / 2 + scale * (offset @ np.cross(forward, up)), HEIGHT / 2 - scale * (offset @ up)

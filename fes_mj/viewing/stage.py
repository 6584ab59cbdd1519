"""Pictures of a design's model for videos: a white stage, a camera, and what is written over every picture."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import mujoco
import numpy as np

from fes_mj.common.arrays import ComplexArray, Picture
from fes_mj.common.style import FAINT, INK, hex_colour
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import bounding_box
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import foot_points
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import LEGS, Leg
from fes_mj.linkage.shapes import PARTS, bars
from fes_mj.simulation.appearance import Spec

SIDE = 720  # pixels; pictures are square
PLOT_WIDTH = 560  # pixels, of the curves beside them
# Drawn so many times as large and reduced, without MuJoCo's own smoothing of edges, which takes longer.
_FINER = 2
# Seen from the rider's right, a little from above: the rider faces right, the crank turns clockwise.
AZIMUTH, ELEVATION, FIELD_OF_VIEW = -97.0, -7.0, 24.0  # deg
_MARGIN = 0.1  # m around all that moves or sits
_DEPTH = 0.3  # m that some of it is nearer to the camera than the middle
_ROOM = 1.25  # above and below, for what is written there
_WALL = 3.0  # m behind the middle; a white wall is drawn faster than a sky
_REACH, _CLEAR, _HEAD = 0.45, 0.06, 0.035  # the arrow: rad to either side, m outside all that moves, m of its head
_FONT, _SMALL = 22, 17  # pixels
_KEY, _SWATCH, _GAP = 688, 25, 18  # pixels: the key's height, a colour with its space, the space behind a name


class Camera:
    """Fixed, sees all that moves or sits over the whole turn.

    near: the leg nearest to it. distance: how many times as far it is as it needs to be. rows: pixels in the middle of
    the picture's height within which all of that is seen.
    """

    def __init__(self, design: Design, near: Leg, distance: float = 1.0) -> None:
        low, high = bounding_box(_extent(design))
        centre, size = (low + high) / 2, high - low + 2 * _MARGIN * (1 + 1j)
        self._middle, self._near = np.array([centre.real, 0.0, centre.imag]), near
        half = np.tan(np.radians(FIELD_OF_VIEW / 2))
        self._distance = distance * max(size.real, _ROOM * size.imag) / 2 / half
        share = (size.imag / 2 + _MARGIN) / half / (self._distance - _DEPTH)
        self.rows = min(SIDE, 2 * int(np.ceil(share * SIDE / 2)))

    def forwards(self, distance: float) -> mujoco.MjvCamera:
        """MuJoCo's camera, so many m further forwards."""
        camera = mujoco.MjvCamera()
        camera.lookat, camera.distance = self._middle - (distance, 0.0, 0.0), self._distance
        camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
        return camera

    def pixels(self, points: ComplexArray) -> list[tuple[float, float]]:
        """Of points in the plane of the near leg's joints, m, before it moves forwards."""
        azimuth, elevation = np.radians((AZIMUTH, ELEVATION))
        forward = np.array([*(np.cos(elevation) * part(azimuth) for part in (np.cos, np.sin)), np.sin(elevation)])
        right = np.cross(forward, (0.0, 0.0, 1.0)) / np.cos(elevation)
        offset = np.stack([points.real, np.full(points.shape, self._near.lateral), points.imag], axis=-1) - self._middle
        depth = self._distance + offset @ forward
        scale = SIDE / 2 / np.tan(np.radians(FIELD_OF_VIEW / 2)) / depth
        across, up = SIDE / 2 + scale * (offset @ right), SIDE / 2 - scale * (offset @ np.cross(right, forward))
        return list(zip(across.tolist(), up.tolist(), strict=True))


def _moving(design: Design) -> dict[str, ComplexArray]:
    """Every joint, heel and toe over the turn, m."""
    motion = kinematics.solve(design, kinematics.FULL_TURN)
    _, *foot = (motion.body_point("shank", point).value for point in foot_points(design))
    return {name: jet.value for name, jet in motion.points.items()} | dict(zip(("heel", "toe"), foot, strict=True))


def _extent(design: Design) -> dict[str, ComplexArray]:
    """All that is seen: what moves, the seat, the arrow."""
    seat = np.array([bar.end for bar in bars(design) if bar.part == "seat"])
    return _moving(design) | {"seat": seat, "arrow": turning_arrow(design)}


def turning_arrow(design: Design) -> ComplexArray:
    """An arc around the crank centre the way it turns, m: ahead of the linkage, outside all that moves there."""
    centre = complex(design.linkage.crank_centre)
    cloud = np.concatenate([np.ravel(points) for points in _moving(design).values()]) - centre
    ahead = np.abs(np.angle(cloud * np.conj(centre))) < 1.5 * _REACH
    radius = max(PARTS["chainring"].size, *np.abs(cloud[ahead])) + _CLEAR
    return np.asarray(centre + radius * np.exp(1j * (np.angle(centre) + np.linspace(-_REACH, _REACH, 20))))


class Stage:
    """Draws a model in any pose; made by `stage`."""

    def __init__(self, model: mujoco.MjModel, renderer: mujoco.Renderer, camera: Camera, overlay: Any) -> None:
        from PIL import Image

        self._model, self._data, self._renderer, self._camera = model, mujoco.MjData(model), renderer, camera
        self._top = (SIDE - renderer.height // _FINER) // 2
        self._empty = Image.new("RGB", overlay.size, "white")
        self._empty.paste(overlay, mask=overlay)
        self._overlay = overlay.crop((0, self._top, SIDE, SIDE - self._top))

    def picture(self, joint_angle: Mapping[str, float], forwards: float = 0.0) -> Picture:
        """With joints at these angles or displacements, by name; the camera so many m further forwards.

        Shape (SIDE, SIDE, 3).
        """
        from PIL import Image

        model, data, picture = self._model, self._data, self._empty.copy()
        for name, angle in joint_angle.items():
            data.joint(name).qpos[0] = angle
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_camlight(model, data)
        self._renderer.update_scene(data, self._camera.forwards(forwards))
        drawn = Image.fromarray(self._renderer.render()).reduce(_FINER)
        drawn.paste(self._overlay, mask=self._overlay)
        picture.paste(drawn, (0, self._top))
        return np.asarray(picture)


@contextmanager
def stage(spec: Spec, design: Design, speed: float, legs: int, road: float = 0.0) -> Iterator[Stage]:
    """Of a model, on which light and a wall are put.

    speed: of the video, 1 is the true one; it is written into it. road: how many times as far away the camera is, so
    that a road is seen too; with none only the middle is drawn, where something is.
    """
    camera = Camera(design, LEGS[legs][0], road or 1.0)
    rows = SIDE if road else camera.rows
    _set(spec, rows)
    model = spec.compile()
    with mujoco.Renderer(model, _FINER * rows, _FINER * SIDE) as renderer:
        yield Stage(model, renderer, camera, _overlay(design, camera, speed))


def _set(spec: Spec, rows: int) -> None:
    """Light, wall and picture size."""
    visual = spec.visual
    visual.global_.offwidth, visual.global_.offheight, visual.quality.offsamples = _FINER * SIDE, _FINER * rows, 0
    visual.global_.fovy = 2 * np.degrees(np.arctan(rows / SIDE * np.tan(np.radians(FIELD_OF_VIEW / 2))))
    visual.headlight.ambient, visual.headlight.diffuse = [0.55] * 3, [0.5] * 3
    wall = spec.worldbody.add_geom(name="wall", type=mujoco.mjtGeom.mjGEOM_PLANE, rgba=(1, 1, 1, 1))
    wall.pos, wall.quat, wall.size = (0, -_WALL, 0), (1, -1, 0, 0), (0, 0, 1)
    wall.contype = wall.conaffinity = 0


def speed_text(speed: float) -> str:
    """Speed of a video in words; 1 is the true one."""
    if speed == 1:
        return "true speed"
    return f"{'slow' if speed < 1 else 'fast'} motion, x{speed:.2g}"


def _overlay(design: Design, camera: Camera, speed: float) -> Any:
    """What stands over every picture, transparent elsewhere: speed, the crank's turning direction, a key of colours."""
    from matplotlib import font_manager
    from PIL import Image, ImageDraw, ImageFont

    face = font_manager.findfont("DejaVu Sans")
    font, small = (ImageFont.truetype(face, size) for size in (_FONT, _SMALL))
    image = Image.new("RGBA", (SIDE, SIDE), (255, 255, 255, 0))
    draw = ImageDraw.Draw(image)
    draw.text((24, 20), speed_text(speed), font=font, fill=INK)
    arc = turning_arrow(design)
    along = (arc[-1] - arc[-2]) / abs(arc[-1] - arc[-2])
    draw.line(camera.pixels(arc), fill=INK, width=4)
    draw.polygon(camera.pixels(arc[-1] + _HEAD * along * np.array([1, 0.5j, -0.5j])), fill=INK)
    draw.rectangle((0, _KEY - _SWATCH, SIDE, SIDE), fill="white")
    names = ("hip", "knee", *design.linkage.architecture.bodies)
    widths = [_SWATCH + draw.textlength(name, small) + _GAP for name in names]
    starts = (SIDE - sum(widths) + _GAP) / 2 + np.cumsum([0, *widths[:-1]])
    for name, start in zip(names, starts.tolist(), strict=True):
        joint = name in JOINTS
        width, height = (14, 14) if joint else (18, 8)
        box = (start, _KEY - height / 2, start + width, _KEY + height / 2)
        (draw.ellipse if joint else draw.rectangle)(box, fill=hex_colour(PARTS[name].colour))
        draw.text((start + _SWATCH, _KEY), name, font=small, fill=FAINT, anchor="lm")
    return image

"""OpenGL without a screen: EGL, else the system's OSMesa, else the OSMesa that comes as a Python wheel."""

import ctypes
import os
import subprocess
import sys
from contextlib import suppress
from importlib import import_module
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

from fes_mj.common.errors import MissingPartError

# In the order of speed; each is a module of mujoco.
_BACKENDS = {"linux": ("egl", "osmesa"), "darwin": ("cgl",)}.get(sys.platform, ("glfw",))
_WHEEL = "lavavu-osmesa"
# A whole picture: without a screen GLFW makes no context, but fails only when something is drawn.
_PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco/>")
with mujoco.Renderer(model, 16, 16) as renderer:
    renderer.update_scene(mujoco.MjData(model))
    renderer.render()
"""
_MESSAGE = (
    "no OpenGL for rendering: neither EGL nor OSMesa works here; install one of them: "
    f"`pip install --no-deps {_WHEEL}`, `apt-get install libosmesa6`, or `apt-get install libegl1 libopengl0 "
    "libgl1-mesa-dri`"
)


def use_offscreen_gl() -> None:
    """Make mujoco.Renderer draw without a screen, whether or not mujoco is imported already.

    A MUJOCO_GL set by the user is tried first. Raises MissingPartError if there is no OpenGL at all.
    """
    os.environ.pop("PYOPENGL_PLATFORM", None)  # the backend chosen here sets it
    asked_for = os.environ.get("FES_MJ_GL") or os.environ.get("MUJOCO_GL", "")  # the first where cli took it away
    candidates = (asked_for, *_BACKENDS) if asked_for in ("egl", "osmesa", "glfw") else _BACKENDS
    backend = next((name for name in candidates if _works(name)), None)
    if backend is None:
        _load_wheel()
        backend = "osmesa"
    os.environ["MUJOCO_GL"] = backend
    # mujoco chose a backend when it was imported; its Renderer looks the context class up in this module at each use
    renderer = import_module("mujoco.rendering.classic.gl_context")
    setattr(renderer, "GLContext", import_module(f"mujoco.{backend}").GLContext)  # noqa: B010


def _works(backend: str) -> bool:
    """Whether a picture can be drawn; tried in a process of its own, since a failed try cannot be undone."""
    environment = os.environ | {"MUJOCO_GL": backend}
    return subprocess.run([sys.executable, "-c", _PROBE], env=environment, capture_output=True).returncode == 0


def _load_wheel() -> None:
    """Load the wheel's OSMesa with its libraries, and let PyOpenGL find it under the usual name."""
    try:
        library = next(Path(str(file.locate())) for file in files(_WHEEL) or [] if "libOSMesa" in file.name)
    except (PackageNotFoundError, StopIteration):
        raise MissingPartError(_MESSAGE) from None
    libraries = [*library.parent.glob("*.so*")]
    for path in libraries * len(libraries):  # they need each other without saying where to look: in whatever order
        with suppress(OSError):
            ctypes.CDLL(str(path), ctypes.RTLD_GLOBAL)
    loader, usual = ctypes.cdll, ctypes.CDLL
    loader._dlltype = lambda name, mode=ctypes.DEFAULT_MODE: usual(  # type: ignore[attr-defined]
        str(library) if str(name).startswith("libOSMesa") else name, mode
    )
    try:
        import_module("mujoco.osmesa")
    except (ImportError, OSError):
        raise MissingPartError(_MESSAGE) from None
    finally:
        loader._dlltype = usual  # type: ignore[attr-defined]

"""Where a result comes from: versions, machine, time."""

from __future__ import annotations

import platform
import sys
from datetime import UTC, datetime
from importlib.metadata import version

PACKAGES = ("fes-mj", "mujoco", "numpy", "scipy")


def provenance() -> dict[str, str]:
    """Versions of the packages that make the numbers, the platform, the command line and the time (UTC)."""
    return {
        **{name: version(name) for name in PACKAGES},
        "python": platform.python_version(),
        "platform": platform.platform(),
        "command": " ".join(["fes_mj", *sys.argv[1:]]),
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
    }

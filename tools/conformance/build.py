"""Install the readers of exported models that need an environment of their own, .readers/READER; two at a time.

    python -m tools.conformance.build [READER ...]

A reader that cannot be had is left out, with what pip says.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

from tools.conformance.asking import ENVIRONMENTS, HERE, ROOT, interpreter
from tools.conformance.readers import READERS


def build(name: str) -> None:
    """Make a reader's environment and install the reader in it; on any failure there is no environment."""
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text())["dependency-groups"]
    reader = READERS[name]
    requirements = [*reader.requirements] or [*groups[name], "-c", str(ROOT / "constraints.txt")]
    try:
        # in a process of its own: a program that one thread still writes cannot be started while another thread forks
        subprocess.run([sys.executable, "-m", "venv", "--clear", ENVIRONMENTS / name], check=True)
        subprocess.run([ENVIRONMENTS / name / "bin" / "pip", "install", "--quiet", *requirements], check=True)
    except BaseException:
        shutil.rmtree(ENVIRONMENTS / name, ignore_errors=True)
        raise


def missing(name: str) -> None:
    """Build it if it is not there."""
    if interpreter(name) is None:
        with suppress(subprocess.CalledProcessError):  # pip has said why
            build(name)


if __name__ == "__main__":
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(missing, sys.argv[1:] or READERS.keys() - HERE.keys()))

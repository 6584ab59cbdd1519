"""Speed, in ratios within one run; each module writes results/benchmarks/NAME.json (`make benchmark`)."""

import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, write_text

ROOT = Path(__file__).parents[1]


def record(name: str, content: dict[str, Any], packages: Iterable[str] = ()) -> None:
    """Write what `benchmarks.NAME` measured, with versions (also of `packages`), the command and the commit."""
    commit = _git("rev-parse", "--short=12", "HEAD")
    if _git("status", "--porcelain", "--", "fes_mj", "benchmarks"):
        commit += "-dirty"
    origin = provenance(packages=packages) | {"command": f"python -m benchmarks.{name}", "commit": commit}
    write_text(ROOT / "results" / "benchmarks" / f"{name}.json", json_text({"provenance": origin, **content}))


def _git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()

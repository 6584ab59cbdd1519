"""Physics-simulation check of pedalling linkages for FES cycling. The public names are those of __init__.pyi."""

from functools import cache
from importlib import import_module
from typing import Any


@cache
def _modules() -> dict[str, str]:
    """Public name -> module. It is imported when first used: help needs no numpy, statics no MuJoCo."""
    import ast
    from pathlib import Path

    stub = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    return {
        name.name: str(line.module) for line in stub.body if isinstance(line, ast.ImportFrom) for name in line.names
    }


def __dir__() -> list[str]:
    return sorted({*globals(), *_modules()})


def __getattr__(name: str) -> Any:
    if name == "__all__":
        return [*_modules()]
    if name not in _modules():
        raise AttributeError(f"module 'fes_mj' has no attribute {name!r}")
    return getattr(import_module(_modules()[name]), name)

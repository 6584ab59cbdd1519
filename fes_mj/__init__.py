"""Physics-simulation check of pedalling linkages for FES cycling. The public names, one a line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fes_mj.design import Design as Design
from fes_mj.design import Linkage as Linkage
from fes_mj.design import Rider as Rider
from fes_mj.design_file import load_design as load_design
from fes_mj.errors import AssemblyError as AssemblyError
from fes_mj.errors import InputError as InputError
from fes_mj.statics import quasi_static as quasi_static
from fes_mj.torque import JointMoments as JointMoments
from fes_mj.torque import load_moments as load_moments

if TYPE_CHECKING:
    from fes_mj.crosscheck import cross_check as cross_check
    from fes_mj.mjcf import build_mjcf as build_mjcf
    from fes_mj.simulation import simulate as simulate

# These need MuJoCo, which is imported when they are first used: statics stay instant.
_ON_USE = {"cross_check": "crosscheck", "build_mjcf": "mjcf", "simulate": "simulation"}


def __getattr__(name: str) -> Any:
    if name not in _ON_USE:
        raise AttributeError(f"module 'fes_mj' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"fes_mj.{_ON_USE[name]}"), name)

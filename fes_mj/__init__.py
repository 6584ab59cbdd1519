"""Physics-simulation check of pedalling linkages for FES cycling. The public names, one a line."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fes_mj.budget.budget import error_budget as error_budget
    from fes_mj.common.errors import AssemblyError as AssemblyError, InputError as InputError
    from fes_mj.crosscheck.turn_case import Case as Case
    from fes_mj.linkage.design import Design as Design, Linkage as Linkage, Rider as Rider
    from fes_mj.linkage.design_file import load_design as load_design
    from fes_mj.moments.files import load_moments as load_moments
    from fes_mj.moments.joint_moments import JointMoments as JointMoments
    from fes_mj.simulation.bench import simulate as simulate
    from fes_mj.simulation.mjcf import build_mjcf as build_mjcf
    from fes_mj.statics.turn import quasi_static as quasi_static

# Imported when first used: help needs no numpy, statics no MuJoCo.
_PUBLIC = {
    "budget.budget": ("error_budget",),
    "crosscheck.turn_case": ("Case",),
    "linkage.design": ("Design", "Linkage", "Rider"),
    "linkage.design_file": ("load_design",),
    "common.errors": ("AssemblyError", "InputError"),
    "moments.joint_moments": ("JointMoments",),
    "moments.files": ("load_moments",),
    "simulation.bench": ("simulate",),
    "simulation.mjcf": ("build_mjcf",),
    "statics.turn": ("quasi_static",),
}
_MODULE = {name: module for module, names in _PUBLIC.items() for name in names}
__all__ = [*_MODULE]


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module 'fes_mj' has no attribute {name!r}")
    return getattr(import_module(f"fes_mj.{_MODULE[name]}"), name)

"""Physics-simulation check of pedalling linkages for FES cycling. The public names, by task."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fes_mj.budget.budget import error_budget as error_budget
    from fes_mj.common.errors import (
        AssemblyError as AssemblyError,
        InputError as InputError,
        MissingPartError as MissingPartError,
        UnstableError as UnstableError,
    )
    from fes_mj.crosscheck.ride_case import RideCase as RideCase
    from fes_mj.crosscheck.turn_case import Case as Case
    from fes_mj.fit.population import fit_population as fit_population
    from fes_mj.fit.seat import fit_seat as fit_seat
    from fes_mj.linkage.design import Design as Design, Linkage as Linkage, Rider as Rider
    from fes_mj.linkage.design_file import load_design as load_design
    from fes_mj.moments.files import load_moments as load_moments
    from fes_mj.moments.joint_moments import JointMoments as JointMoments
    from fes_mj.optimization.optimize import optimize as optimize
    from fes_mj.riding.ride import Ride as Ride, Road as Road
    from fes_mj.riding.starts import starts as starts
    from fes_mj.riding.stimulation import stimulation as stimulation
    from fes_mj.riding.trace import ride as ride
    from fes_mj.simulation.bench import simulate as simulate
    from fes_mj.simulation.export import export as export
    from fes_mj.simulation.mjcf import build_mjcf as build_mjcf
    from fes_mj.statics.turn import quasi_static as quasi_static
    from fes_mj.sweep.sweep import run_sweep as run_sweep

# Imported when first used: help needs no numpy, statics no MuJoCo.
_PUBLIC = {
    # Designs
    "linkage.design_file": ("load_design",),
    "linkage.design": (
        "Design",
        "Linkage",
        "Rider",
    ),
    # Joint moments
    "moments.files": ("load_moments",),
    "moments.joint_moments": ("JointMoments",),
    # Power by statics, and how sure it is
    "statics.turn": ("quasi_static",),
    "budget.budget": ("error_budget",),
    # In MuJoCo, and whether both agree
    "simulation.mjcf": ("build_mjcf",),
    "simulation.bench": ("simulate",),
    "crosscheck.turn_case": ("Case",),
    "simulation.export": ("export",),
    # On the road
    "riding.ride": (
        "Ride",
        "Road",
    ),
    "riding.trace": ("ride",),
    "riding.starts": ("starts",),
    "crosscheck.ride_case": ("RideCase",),
    # For a stimulator, and for riders
    "riding.stimulation": ("stimulation",),
    "fit.seat": ("fit_seat",),
    "fit.population": ("fit_population",),
    # Many designs
    "optimization.optimize": ("optimize",),
    "sweep.sweep": ("run_sweep",),
    # What is refused
    "common.errors": (
        "InputError",
        "AssemblyError",
        "UnstableError",
        "MissingPartError",
    ),
}
_MODULE = {name: module for module, names in _PUBLIC.items() for name in names}
__all__ = [*_MODULE]


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module 'fes_mj' has no attribute {name!r}")
    return getattr(import_module(f"fes_mj.{_MODULE[name]}"), name)

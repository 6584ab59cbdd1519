"""The public names; docs/python.md shows them by task."""

from fes_mj.budget.answer import answer as answer
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
from fes_mj.muscles.drive import Muscles as Muscles, load_muscles as load_muscles
from fes_mj.optimization.optimize import optimize as optimize
from fes_mj.riding.ride import Ride as Ride, Road as Road
from fes_mj.riding.starts import starts as starts
from fes_mj.riding.stimulated import stimulated_rider as stimulated_rider
from fes_mj.riding.stimulation import stimulation as stimulation
from fes_mj.riding.trace import ride as ride
from fes_mj.simulation.bench import simulate as simulate
from fes_mj.simulation.export import export as export
from fes_mj.simulation.mjcf import build_mjcf as build_mjcf
from fes_mj.statics.turn import quasi_static as quasi_static
from fes_mj.sweep.sweep import run_sweep as run_sweep

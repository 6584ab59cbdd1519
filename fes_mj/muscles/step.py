"""What `instant` says of one state, in machine code where that is installed: for loops that run in it."""

from fes_mj.common.machine_code import inlined_machine_code, machine_code
from fes_mj.muscles import instant
from fes_mj.muscles.instant import LegMuscles as LegMuscles, Stimulus as Stimulus

stimulation = machine_code(instant.stimulation)
weights = machine_code(instant.weights)
activated = machine_code(instant.activated)
joint_moments = inlined_machine_code(instant.joint_moments)

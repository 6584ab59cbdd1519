"""Torque map or muscles, and the MuJoCo model, before anything moves: do they say what they were told?"""

import math
from collections.abc import Iterator
from operator import attrgetter

import mujoco
import numpy as np

from fes_mj.common.checks import Check
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage import kinematics
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.torque_map import GRID, TABLE_SIZE, TorqueMap
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.pull import pull
from fes_mj.muscles.torque import MuscleTorque
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.mjcf import CUTS

# What a reader of the model file must get back.
FIELDS = (
    *("body_pos", "body_quat", "body_mass", "body_inertia", "body_ipos", "jnt_axis", "jnt_pos", "qpos0"),
    *("eq_data", "eq_solref", "eq_solimp", "site_pos", "actuator_gear", "actuator_gainprm", "actuator_biasprm"),
    *("key_qpos", "key_qvel", "key_ctrl", "opt.timestep", "opt.gravity"),
)


def map_checks(case: Case) -> Iterator[Check]:
    """The torque map on the tricycle it was made from, and its two implementations against each other."""
    torque = case.steps.torque
    if not isinstance(torque, TorqueMap):
        return
    motion, spread = case.steps.motion(kinematics.uniform_turn(360)), 0.0
    for joint in JOINTS:
        angle, rate = motion.joint_angle[joint], case.cadence * motion.joint_rate[joint]
        scalar, array = torque.feedback(joint), torque.moment(joint, angle, rate)
        values = [scalar(*pair) for pair in zip(angle.tolist(), rate.tolist(), strict=True)]
        spread = max(spread, float(np.abs(values - array).max()))
    yield case.check("torque_map", map_error(torque))
    yield case.check("map_feedback", spread)


def muscle_checks(case: Case) -> Iterator[Check]:
    """Muscles of one state against those of a whole turn, each group fully active alone."""
    torque = case.steps.torque
    if not isinstance(torque, MuscleTorque):
        return
    motion, cadence = case.steps.motion(kinematics.uniform_turn(90)), case.cadence
    expected = pull(torque.riders, motion, cadence).moment
    rates = motion.joint_rate.map(lambda rate: cadence * rate)
    states, spread = np.column_stack([*motion.joint_angle, *rates]).tolist(), 0.0
    for group, active in enumerate(np.eye(len(MUSCLE_GROUPS)).tolist()):
        knee, hip = np.transpose([torque.moments_of(torque.leg, active, *state) for state in states])
        apart = (knee - expected.knee[group, 0, 0], hip - expected.hip[group, 0, 0])
        spread = max(spread, float(np.abs(apart).max()))
    yield case.check("muscle_moments", spread)


def map_error(torque: TorqueMap) -> float:
    """On its own tricycle the map must give the moments back, at every 0.1 deg of crank angle, N m."""
    after, reference = GRID[:TABLE_SIZE], torque.moments.measured_on  # from top dead centre
    motion = kinematics.solve(reference.design, reference.top_dead_centre + after)
    measured, mapped = torque.moments.at(after), torque.along(motion, reference.cadence)
    return max(float(np.abs(mapped[joint] - measured[joint]).max()) for joint in JOINTS)


def model_checks(case: Case) -> Iterator[Check]:
    """The compiled model at its keyframe, and the file written of it."""
    model = case.steps.spec().compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    loops = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    cuts = [cut for cut in CUTS if cut in case.design.linkage.architecture.joints]
    closed = np.sum(loops) == 3 * len(cuts)  # three equations a pin, or there is nothing to measure
    speeds = data.efc_J.reshape(-1, model.nv)[loops] @ data.qvel
    yield case.check("keyframe", np.abs(data.efc_pos[loops]).max() if closed else math.inf)
    yield case.check("keyframe_speed", np.abs(speeds).max() if closed else math.inf)
    yield case.check("planarity", tilt(data))
    yield case.check("model_file", file_difference(case))


def tilt(data: mujoco.MjData) -> float:
    """Largest angle between a hinge and the normal of the linkage's plane, deg."""
    along = np.hypot(data.xaxis[:, 0], data.xaxis[:, 2])
    return math.degrees(np.arctan2(along, np.abs(data.xaxis[:, 1])).max())


def file_difference(case: Case) -> float:
    """Largest difference of any number between the model and the one read back from its own file."""
    model, again = case.steps.spec().compile(), mujoco.MjModel.from_xml_string(mjcf_text(case.steps.spec()))
    pairs = [(field(model), field(again)) for field in map(attrgetter, FIELDS)]
    if any(np.shape(one) != np.shape(other) for one, other in pairs):
        return math.inf
    return max(float(np.abs(one - other).max(initial=0.0)) for one, other in pairs)

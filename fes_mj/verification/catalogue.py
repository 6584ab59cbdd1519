"""The catalogue of injected faults. Each is a mistake that was made in print, in a tool, or nearly in this project."""

from __future__ import annotations

import math

import mujoco

from fes_mj import inverse_dynamics, kinematics, simulation, statics, stepping
from fes_mj.kinematics import Motion
from fes_mj.torque import REFERENCE, TorqueMap
from fes_mj.verification.faults import Fault, Patch
from fes_mj.verification.mistakes import (
    BOOT,
    SHANK_RATE,
    by_crank_angle,
    damped,
    delayed,
    from_horizontal,
    half_more,
    heavy_thigh,
    in_cadence,
    in_keyframe,
    in_linkage,
    in_map,
    in_model,
    late_torque,
    long_rocker,
    open_table,
    other_branch,
    pins_apart,
    set_gear,
    set_loops,
    set_options,
    six_digits,
    tilted_hinge,
    weak_servo,
    without_centripetal,
    without_couples,
    without_lever,
)

FAULTS = (
    Fault(
        "knee_sign",
        "knee moment on the shank with the sign of the paper's Eq. 4",
        "virtual_work",
        (Patch(statics, "joint_couples", lambda _: lambda knee, hip: {"thigh": hip + knee, "shank": knee}),),
    ),
    Fault(
        "thigh_lever",
        "R4 missing beside cos(theta_4), as in the paper's Eq. 4",
        "virtual_work",
        (Patch(statics, "moment_arm", without_lever),),
    ),
    Fault(
        "wrong_branch",
        "both dyads assembled the other way round",
        "assembly_mode",
        (Patch(kinematics, "_close_dyad", other_branch),),
    ),
    Fault(
        "coupler_angle",
        "gamma 5 deg off in the design file",
        "joint_range",
        edit=in_linkage(coupler_angle=lambda angle: angle + math.radians(5)),
    ),
    Fault(
        "length_in_file",
        "R10 1 % too long in the design file",
        "joint_range",
        edit=in_linkage(rocker=lambda r: 1.01 * r),
    ),
    Fault(
        "seat_angle",
        "seat angle of the TRT used for a six-bar",
        "joint_range",
        edit=in_linkage(seat_angle=lambda _: REFERENCE.linkage.seat_angle),
    ),
    Fault("length_in_model", "rocker 1 % too long in the MuJoCo model only", "keyframe", in_model(long_rocker)),
    Fault(
        "directions_exchanged",
        "extension and flexion exchanged in the torque map",
        "torque_map",
        in_map(lambda source, angle, direction: source(angle, -direction), "knee", "hip"),
    ),
    Fault(
        "crank_zero",
        "crank angle of the moments counted from horizontal instead of top dead centre",
        "torque_map",
        (Patch(TorqueMap, "__init__", from_horizontal),),
    ),
    Fault(
        "boot_forgotten",
        "angle of the boot left out where the map is looked up",
        "torque_map",
        in_map(lambda source, angle, direction: source(angle - BOOT, direction), "knee"),
    ),
    Fault(
        "open_table",
        "moments interpolated as if the turn were not periodic",
        "torque_map",
        (Patch(TorqueMap, "__init__", open_table),),
    ),
    Fault(
        "map_by_crank_angle",
        "moments of statics looked up by the six-bar's crank angle",
        "massless_statics",
        (Patch(statics, "joint_moments", by_crank_angle),),
    ),
    Fault(
        "default_solref", "loops with MuJoCo's default solref", "mean_power", in_model(set_loops(solref=(0.02, 1.0)))
    ),
    Fault("soft_loops", "loops with a time constant of 2 ms", "gap_order", in_model(set_loops(solref=(0.002, 1.0)))),
    Fault("loop_inactive", "loop constraints switched off", "keyframe", in_model(set_loops(active=False))),
    Fault("pins_apart", "the two sides of the pedal pin 1 mm apart sideways", "keyframe", in_model(pins_apart)),
    Fault("weak_servo", "servo gain of 20 N m s/rad", "cadence_ripple", in_model(weak_servo)),
    Fault(
        "wrong_integrator",
        "implicitfast instead of discrete",
        "stability",
        in_model(set_options(integrator=mujoco.mjtIntegrator.mjINT_IMPLICITFAST)),
    ),
    Fault("gravity_axis", "gravity along x", "mujoco_inverse", in_model(set_options(gravity=(-9.81, 0.0, 0.0)))),
    Fault("tilted_hinge", "knee hinge tilted by 0.1 deg", "planarity", in_model(tilted_hinge)),
    Fault("heavy_thigh", "mass of the thigh doubled in the MuJoCo model only", "mujoco_inverse", in_model(heavy_thigh)),
    Fault("damping", "0.01 N m s/rad of damping left on every joint", "passive_work", in_model(damped)),
    Fault("degrees", "knee motor geared for degrees", "mean_power", in_model(set_gear("knee", math.degrees(1)))),
    Fault("reversed_motor", "hip motor turning the other way", "mean_power", in_model(set_gear("hip", -1))),
    Fault(
        "stale_keyframe",
        "keyframe of a crank angle 5 deg further on for the crank alone",
        "keyframe",
        in_keyframe(lambda state: {"crank": (math.radians(5), state["crank"][1])}),
    ),
    Fault(
        "reversed_start",
        "hip speed of the keyframe with the wrong sign",
        "keyframe_speed",
        in_keyframe(lambda state: {"hip": (state["hip"][0], -state["hip"][1])}),
    ),
    Fault("six_digits", "model written with MuJoCo's default of six digits", "model_file", in_model(six_digits)),
    Fault(
        "late_torque",
        "crank moment read one step late",
        "inverse_dynamics",
        (Patch(simulation, "simulate", late_torque),),
    ),
    Fault("late_feedback", "joint moments one step late", "map_feedback", (Patch(TorqueMap, "feedback", delayed),)),
    Fault(
        "turn_and_a_half",
        "power averaged over a turn and a half",
        "whole_turns",
        (Patch(simulation, "steps_per_turn", half_more, here_only=True),),
    ),
    Fault(
        "no_pre_roll",
        "measured from the second step on",
        "inverse_dynamics",
        (Patch(stepping, "PRE_ROLL", lambda _: 1),),
    ),
    Fault(
        "gear_squared",
        "gear ratio squared in the cadence",
        "tricycle_speed",
        in_cadence(lambda linkage, rate: rate * linkage.gear_ratio),
    ),
    Fault(
        "wheel_radius",
        "wheel radius for diameter in the cadence",
        "tricycle_speed",
        in_cadence(lambda _, rate: 2 * rate),
    ),
    Fault(
        "wrong_rate",
        "knee speed taken from the shank alone",
        "rates",
        (Patch(Motion, "knee_rate", lambda _: SHANK_RATE),),
    ),
    Fault(
        "no_centripetal",
        "centripetal term left out of the accelerations",
        "second_rates",
        (Patch(kinematics, "_carried", without_centripetal),),
    ),
    Fault(
        "no_rotary_inertia",
        "rotary inertia left out of the inverse dynamics",
        "mujoco_inverse",
        (Patch(inverse_dynamics, "body_loads", without_couples),),
    ),
)

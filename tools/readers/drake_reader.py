"""Drake: a discrete MultibodyPlant; loops become ball constraints."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
from protocol import Answer, Job, serve
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder


def measure(job: Job) -> Answer:
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, job.get("timestep", 1e-3))
    Parser(builder).AddModels(job["model"])
    plant.SetUseSampledOutputPorts(False)  # the acceleration of the state, not of the last step
    plant.Finalize()
    inspector = scene_graph.model_inspector()
    answer: Answer = {
        "joints": plant.num_velocities(),
        "loops": plant.num_constraints(),
        "free": plant.num_velocities() - 2 * plant.num_constraints(),
        "keeps": {"geoms": inspector.num_geometries(), "motors": plant.num_actuators()},
    }
    if "samples" not in job:
        return answer
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    for name, (angle, rate) in job["joints"].items():
        joint = plant.GetJointByName(name)
        joint.set_angle(context, angle)
        joint.set_angular_rate(context, rate)
    moments = np.zeros(plant.num_actuators())
    for motor, moment in job["controls"].items():
        moments[plant.GetJointActuatorByName(motor).input_start()] = moment
    plant.get_actuation_input_port().FixValue(context, moments)
    acceleration = plant.get_generalized_acceleration_output_port().Eval(context)
    answer["acceleration"] = {
        name: float(acceleration[plant.GetJointByName(name).velocity_start()]) for name in job["joints"]
    }
    joints, answer["states"] = [plant.GetJointByName(name) for name in job["joints"]], []
    for count in job["samples"]:
        simulator.AdvanceTo(count * job["timestep"])
        angles, speeds = (
            [float(values(context)[at(joint)]) for joint in joints]
            for values, at in (
                (plant.GetPositions, lambda joint: joint.position_start()),
                (plant.GetVelocities, lambda joint: joint.velocity_start()),
            )
        )
        answer["states"].append([angles, speeds])
        if "pedal" in job and len(answer["states"]) == 1:
            frame = plant.GetBodyByName("shank").body_frame()
            pedal = plant.CalcPointsPositions(context, frame, np.array(job["pedal"]), plant.world_frame())
            answer["pedal"] = pedal[[0, 2], 0].tolist()
    return answer


if __name__ == "__main__":
    serve(version("drake"), measure)

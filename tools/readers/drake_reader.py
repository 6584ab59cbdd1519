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
    if "steps" not in job:
        return answer
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    for name, (angle, rate) in job["joints"].items():
        joint = plant.GetJointByName(name)
        joint.set_angle(context, angle)
        joint.set_angular_rate(context, rate)
    acceleration = plant.get_generalized_acceleration_output_port().Eval(context)
    answer["acceleration"] = {
        name: float(acceleration[plant.GetJointByName(name).velocity_start()]) for name in job["joints"]
    }
    simulator.AdvanceTo(job["steps"] * job["timestep"])
    shank = plant.GetBodyByName("shank")
    pedal = plant.CalcPointsPositions(context, shank.body_frame(), np.array(job["pedal"]), plant.world_frame())
    answer["pedal"] = pedal[[0, 2], 0].tolist()
    return answer


if __name__ == "__main__":
    serve(version("drake"), measure)

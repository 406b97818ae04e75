"""Spawning and deletion of models, and states of entities, for Gazebo Classic's services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.plugins.world.service_entities import (
    RequestRefused,
    add_namespace,
    find_entity,
    frame_of,
    handle_of,
    pose_fields,
    pose_of,
    require_finite,
    spawn_entities,
    twist_fields,
    vector_of,
    velocity_of,
)
from simkit.pose import IDENTITY, Pose, Vector

if TYPE_CHECKING:
    from simkit.runtime import Simulation

MODEL_STATES: Final = "gazebo_msgs/msg/ModelStates"
LINK_STATES: Final = "gazebo_msgs/msg/LinkStates"
STATES_RATE: Final = 100.0
"""Default rate of the topics of states [Hz], as in gazebo_ros_state."""

_KINDS: Final = ("model", "link", "light", "visual")


# ---------------------------------------------------------------------- spawning


def spawn_model(sim: Simulation, xml: str, name: str, namespace: str, pose_message: msgs.Pose, frame: str) -> str:
    """Spawn a model as Classic does: pose in the world = frame · initial pose · pose in the file.

    Returns:
        Name of the model.

    Raises:
        RequestRefused: the model cannot be spawned.
    """
    if not xml.strip():
        raise RequestRefused("the XML of the entity is empty")
    if name and name in sim.models:
        raise RequestRefused(f"Entity [{name}] already exists.")
    source = sim.control.client_source(add_namespace(xml, namespace) if namespace else xml)
    initial = frame_of(sim, frame) @ pose_of(pose_message, "initial_pose")
    pose = None if initial == IDENTITY else initial @ sim.contents.pose_in_file(source)
    if not name:
        name = base = sim.contents.name_in_file(source)
        number = 0
        while name in sim.models:
            name, number = f"{base}_{number}", number + 1
    return str(spawn_entities(sim.spawn, source, name, pose).name)


def delete_model(sim: Simulation, name: str) -> None:
    """Remove a top-level model; raises `RequestRefused`."""
    if name not in sim.models:
        kind, scoped = find_entity(sim, name, ("model", "light", "link"), "entity")
        if kind == "light":
            raise RequestRefused(f"the light {scoped!r} cannot be removed; set_light_properties can darken it")
        raise RequestRefused(f"{scoped!r} is part of the model {scoped.split('::')[0]!r}; delete the model instead")
    sim.remove(name)


# ---------------------------------------------------------------------- states


def state_of(sim: Simulation, name: str, frame: str, kinds: tuple[str, ...] = _KINDS) -> tuple[Pose, Vector, Vector]:
    """Return pose and velocities of an entity, relative to the entity named `frame`; raises `RequestRefused`."""
    kind, scoped = find_entity(sim, name, kinds, "entity" if kinds == _KINDS else "")
    pose = handle_of(sim, kind, scoped).pose
    linear, angular = velocity_of(sim, kind, scoped)
    back = frame_of(sim, frame).inverse()
    if back != IDENTITY:
        frame_velocity, turn = velocity_of(sim, *find_entity(sim, frame, _KINDS, "reference frame"))
        pose, linear, angular = back @ pose, back.rotate(linear - frame_velocity), back.rotate(angular - turn)
    return pose, linear, angular


def set_state(
    sim: Simulation,
    name: str,
    pose_message: msgs.Pose,
    twist: msgs.Twist,
    frame: str,
    kinds: tuple[str, ...] = ("model", "link", "light"),
) -> None:
    """Set pose and velocity of an entity, relative to the entity named `frame`; raises `RequestRefused`."""
    kind, scoped = find_entity(sim, name, kinds, "entity" if len(kinds) > 1 else "")
    frame_pose = frame_of(sim, frame)
    pose = frame_pose @ pose_of(pose_message)
    linear = frame_pose.rotate(vector_of(twist.linear, "twist.linear"))
    angular = frame_pose.rotate(vector_of(twist.angular, "twist.angular"))
    handle = handle_of(sim, kind, scoped)
    handle.set_pose(pose)
    if kind == "link" or (kind == "model" and not handle.static):
        handle.set_velocity(linear, angular)


def set_joints(sim: Simulation, model: str, names: list[str], positions: npt.NDArray[np.float64]) -> None:
    """Set positions of a model's joints [rad or m]; raises `RequestRefused`."""
    handle = sim.model(find_entity(sim, model, ("model",))[1])
    if len(names) != len(positions):
        raise RequestRefused("joint name and position list have different lengths")
    targets = {
        name: require_finite(value, f"the position of {name!r}") for name, value in zip(names, positions, strict=True)
    }
    for name in targets:
        joint = handle.joint(name)
        if joint.dof != 1:
            raise RequestRefused(f"joint {name!r} has {joint.dof} degrees of freedom; expected one")
    handle.set_joint_positions(targets)


def states_message(sim: Simulation, type_name: str) -> object:
    """Return a message of `MODEL_STATES` with all top-level models, or of `LINK_STATES` with all links."""
    kind = "model" if type_name == MODEL_STATES else "link"
    names = list(sim.models if kind == "model" else sim.contents.handles.tables["link"])
    return msgs.make(
        type_name,
        name=names,
        pose=[pose_fields(handle_of(sim, kind, name).pose) for name in names],
        twist=[twist_fields(*velocity_of(sim, kind, name)) for name in names],
    )

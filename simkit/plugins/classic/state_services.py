"""Spawning and deletion of models, and states of entities, for Gazebo Classic's services."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.plugins.world.service_entities import (
    RequestRefused,
    find_entity,
    frame_of,
    handle_of,
    pose_fields,
    pose_of,
    require_finite,
    spawn_entities,
    vector_fields,
    vector_of,
)
from simkit.pose import IDENTITY, Pose, Vector

if TYPE_CHECKING:
    from simkit.runtime import Link, Simulation

MODEL_STATES: Final = "gazebo_msgs/msg/ModelStates"
LINK_STATES: Final = "gazebo_msgs/msg/LinkStates"
STATES_RATE: Final = 100.0
"""Default rate of the topics of states [Hz], as in gazebo_ros_state."""

_PLUGIN: Final = re.compile(r"(<plugin\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*?)(/>|>(.*?)</plugin\s*>)", re.DOTALL)
_NAMESPACE: Final = re.compile(r"<namespace\s*>.*?</namespace\s*>|<namespace\s*/>", re.DOTALL)
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
    source = add_namespace(xml, namespace) if namespace else xml
    initial = frame_of(sim, frame) @ pose_of(pose_message, "initial_pose")
    pose = None if initial == IDENTITY else initial @ sim.contents.pose_in_file(source)
    if not name:
        name = base = sim.contents.name_in_file(source)
        number = 0
        while name in sim.models:
            name, number = f"{base}_{number}", number + 1
    return str(spawn_entities(sim.spawn, source, name, pose).name)


def add_namespace(xml: str, namespace: str) -> str:
    """Add a namespace to each plugin of a description, as Classic does for `robot_namespace`; also for ROS 1."""
    namespace = escape(namespace, quote=False)
    element = f"<namespace>{namespace}</namespace>"

    def named(match: re.Match[str]) -> str:
        content = match[3] or ""
        if re.search(r"<ros\s*>", content):
            if _NAMESPACE.search(content):
                content = _NAMESPACE.sub(lambda _: element, content, count=1)
            else:
                content = re.sub(r"<ros\s*>", lambda m: m[0] + element, content, count=1)
        elif "<robotNamespace" in content:
            own = f"<robotNamespace>{namespace}</robotNamespace>"
            content = re.sub(
                r"<robotNamespace\s*(/>|>.*?</robotNamespace\s*>)", lambda _: own, content, flags=re.DOTALL
            )
        else:
            content = f"<ros>{element}</ros>{content}"
        return f"{match[1]}>{content}</plugin>"

    return _PLUGIN.sub(named, xml)


def delete_model(sim: Simulation, name: str) -> None:
    """Remove a top-level model; raises `RequestRefused`."""
    if name not in sim.models:
        kind, scoped = find_entity(sim, name, ("model", "light", "link"), "entity")
        if kind == "light":
            raise RequestRefused(f"the light {scoped!r} cannot be removed; set_light_properties can darken it")
        raise RequestRefused(f"{scoped!r} is part of the model {scoped.split('::')[0]!r}; delete the model instead")
    sim.remove(name)


# ---------------------------------------------------------------------- states


def carrying_link(sim: Simulation, kind: str, scoped: str) -> Link | None:
    """Return the link to which an entity is fixed; for a model this is its canonical link."""
    if kind == "link":
        return sim.link(scoped)
    if kind == "visual":
        return sim.visual(scoped).link
    links = sim.contents.handles.tables["link"]
    if kind == "model":
        return links.get(sim.model(scoped).scene.canonical_link)
    return links.get(sim.light(scoped).scene.link)


def velocity_of(sim: Simulation, kind: str, scoped: str) -> tuple[Vector, Vector]:
    """Return linear velocity of an entity's origin [m/s] and angular velocity [rad/s], world frame, shape (3,)."""
    link = carrying_link(sim, kind, scoped)
    if link is None:
        return np.zeros(3), np.zeros(3)
    angular = link.angular_velocity
    arm = handle_of(sim, kind, scoped).pose.position - link.pose.position
    return link.linear_velocity + np.cross(angular, arm), angular


def twist_fields(linear: Vector, angular: Vector) -> dict[str, object]:
    """Return the fields of a `Twist` message."""
    return {"linear": vector_fields(linear.tolist()), "angular": vector_fields(angular.tolist())}


def state_of(sim: Simulation, name: str, frame: str, kinds: tuple[str, ...] = _KINDS) -> tuple[Pose, Vector, Vector]:
    """Return pose and velocities of an entity, relative to the entity named `frame`; raises `RequestRefused`."""
    kind, scoped = find_entity(sim, name, kinds, "entity" if kinds == _KINDS else "")
    pose = handle_of(sim, kind, scoped).pose
    linear, angular = velocity_of(sim, kind, scoped)
    back = frame_of(sim, frame).inverse()
    if back != IDENTITY:
        own, turn = velocity_of(sim, *find_entity(sim, frame, _KINDS, "reference frame"))
        pose, linear, angular = back @ pose, back.rotate(linear - own), back.rotate(angular - turn)
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

"""Robots without a simulator: that of `ros2_control_node`, and that of `robot_state_publisher`, which is only shown.

Mock hardware follows each command exactly and knows neither gravity nor contacts. The model has neither, and its root
link is fixed to the world.
"""

from __future__ import annotations

from typing import Final

from simkit import Params
from simkit.writers.xml_text import document, element
from simkit_launch.robot_description import DescriptionError, description_root

_WORLD: Final = "world"
_PLUGIN: Final = "libgz_ros2_control-system.so"


def mock_robot(description: str, manager: str, ros: str) -> str:
    """Return the URDF of a fixed robot with a controller manager.

    Args:
        description: URDF.
        manager: name of the controller manager.
        ros: element `<ros>` of the plugin with its namespace, parameters and remappings.

    Raises:
        DescriptionError: the description is no URDF, or has no `<ros2_control>`.
    """
    robot = _still_robot(description)
    if not robot.has("ros2_control"):
        raise DescriptionError("the robot description has no <ros2_control>, so there is no hardware to control")
    _fix_to_world(robot)
    content = [description_root(ros), element("controller_manager_name", manager)]
    plugin = element("plugin", content, filename=_PLUGIN, name=f"{manager}_of_ros2_control_node")
    robot.children.append(element("gazebo", [plugin]))
    return document(robot)


def shown_robot(description: str) -> str:
    """Return the URDF of a robot without gravity, contacts, sensors and plugins, which only shows its joints.

    The robot is not fixed to a link `world`, whose transform would be a second parent of the root link.

    Args:
        description: URDF.

    Raises:
        DescriptionError: the description is no URDF.
    """
    robot = _still_robot(description)
    _remove(robot, "ros2_control", "transmission")
    for joint in robot.all("joint"):  # limits and mimic joints would push the links of a robot at rest
        _remove(joint, "mimic", "limit")
        if joint.attribute("type") == "revolute":
            joint.attributes["type"] = "continuous"
        elif joint.attribute("type") == "prismatic":
            joint.children.append(element("limit", lower="-100", upper="100", effort="1", velocity="1"))
    return document(robot)


def _still_robot(description: str) -> Params:
    """Return a robot without gravity, contacts and extensions for Gazebo."""
    robot = description_root(description)
    if robot.name != "robot":
        raise DescriptionError(f"the robot description has the root element <{robot.name}>; expected <robot>")
    _remove(robot, "gazebo")
    for link in robot.all("link"):
        _remove(link, "collision")
        if not link.has("inertial") and link.attribute("name") != _WORLD:
            link.children.append(_small_inertial())
        robot.children.append(element("gazebo", [element("gravity", "false")], reference=link.attribute("name")))
    return robot


def hardware_names(description: str) -> list[str]:
    """Return the names of the hardware components of a URDF."""
    return [block.attribute("name") for block in description_root(description).all("ros2_control")]


def _remove(parent: Params, *names: str) -> None:
    """Remove the children with some names."""
    parent.children = [child for child in parent.children if child.name not in names]


def _small_inertial() -> Params:
    """Return the inertia of a link that has none; without it, Gazebo leaves out the link and its joint."""
    inertia = element("inertia", ixx="1e-3", iyy="1e-3", izz="1e-3", ixy="0", ixz="0", iyz="0")
    return element("inertial", [element("mass", value="0.1"), inertia])


def _fix_to_world(robot: Params) -> None:
    """Fix the root link of a robot to the world."""
    children = {child.attribute("link") for joint in robot.all("joint") for child in joint.all("child")}
    roots = [name for link in robot.all("link") if (name := link.attribute("name")) not in children]
    if not roots:
        raise DescriptionError("the robot description has no root link: each link is the child of a joint")
    if roots[0] == _WORLD:
        return
    ends = [element("parent", link=_WORLD), element("child", link=roots[0])]
    joint = element("joint", ends, name=f"{_WORLD}_to_{roots[0]}", type="fixed")
    robot.children += [element("link", name=_WORLD), joint]

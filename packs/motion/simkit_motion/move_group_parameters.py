"""Parameters of MoveIt's node `move_group` as options of simkit's plugin of this name."""

from __future__ import annotations

import html
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit_nodes.robot_groups import RobotGroups

if TYPE_CHECKING:
    from simkit import Model, Simulation

Values = Mapping[str, object]
"""Values of parameters by name; the names of blocks are joined with dots."""

_LIMITS: Final = "robot_description_planning.joint_limits."
_USED: Final = ("robot_description", "robot_description_semantic", "use_sim_time", "publish_robot_description")
_OF_CLIENTS: Final = (
    *("robot_description_planning.default_velocity_scaling_factor", "robot_description_planning.default_acceleration"),
    *(
        "publish_",
        "allow_trajectory_execution",
        "monitor_dynamics",
        "qos_overrides",
        "warehouse_",
        "move_group.",
        "plan_execution",
    ),
    *("planning_scene_monitor", "octomap_", "trajectory_execution.", "default_planning_pipeline", "capabilities"),
    *(
        "disable_capabilities",
        "moveit_manage_controllers",
        "debug",
        "max_range",
        "max_safe_path_cost",
        "jiggle_fraction",
    ),
    *("controller_list", "moveit_controller_manager", "moveit_ros_control"),
)
"""Beginnings of the names of parameters that change nothing of the answers here, and need no warning."""
_TRAJECTORY: Final = "FollowJointTrajectory"


@dataclass(frozen=True)
class Controllers:
    """Controllers that `moveit_controllers.yaml` names.

    Attributes:
        actions: names of the actions that follow trajectories.
        others: names of controllers with other actions, such as those of grippers.
    """

    actions: tuple[str, ...] = ()
    others: tuple[str, ...] = ()


def find_robot(sim: Simulation, groups: RobotGroups, namespace: str) -> Model | None:
    """Return the model with the joints of all groups; None if the world has none yet.

    Of several, the one with the name of the robot or of the namespace counts, and then the first by name.

    Args:
        sim: simulation.
        groups: groups of the robot.
        namespace: namespace of the node.
    """
    needed = {joint for group in groups.groups.values() for joint in group.active}
    fit = [name for name, model in sim.models.items() if needed and needed <= set(model.joints)]
    names = namespace.strip("/").split("/")[-1], groups.tree.name
    fit.sort(key=lambda name: (name not in names, name))
    return sim.model(fit[0]) if fit else None


def plugin_elements(groups: RobotGroups, values: Values, robot: Model) -> str:
    """Return the elements of the plugin for a robot.

    Args:
        groups: groups of the robot.
        values: parameters of the node.
        robot: model of the robot.
    """
    texts = [_element("robot", robot.scoped), _element("planning_frame", groups.planning_frame)]
    for group in groups.groups.values():
        joints = [name for name in group.active if name in robot.joints and robot.joints[name].dof == 1]
        if joints:
            tip = _element("tip_link", group.tip) if group.tip in robot.links else ""
            own = _element("name", group.name) + _element("joints", " ".join(joints)) + tip
            texts.append(f"<group>{own}</group>")
    for name, limits in sorted(_joint_limits(values).items()):
        if name in robot.joints:
            texts.append(_block("joint_limits", {"joint": name, **limits}))
    pairs = (pair for pair in groups.disabled_collisions if set(pair) <= set(robot.links))
    texts += [_block("disable_collisions", {"link1": first, "link2": second}) for first, second in pairs]
    return "".join(texts)


def _joint_limits(values: Values) -> dict[str, dict[str, object]]:
    """Return the limits of `joint_limits.yaml` by joint."""
    found: dict[str, dict[str, object]] = {}
    for name, value in values.items():
        joint, _, key = name.removeprefix(_LIMITS).rpartition(".")
        if name.startswith(_LIMITS) and key in ("max_velocity", "max_acceleration") and _is_positive(value):
            has = values.get(f"{_LIMITS}{joint}.has_{key.removeprefix('max_')}_limits", True)
            if has:
                found.setdefault(joint, {})[key] = value
    return found


def _is_positive(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0


def controllers_of(values: Values) -> Controllers:
    """Return the controllers that the parameters name; ROS 1 has a list of them, ROS 2 a block for each."""
    listed: Iterable[Mapping[str, object]]
    in_ros1 = values.get("controller_list")
    prefix = "moveit_simple_controller_manager."
    if isinstance(in_ros1, list):
        listed = [item for item in in_ros1 if isinstance(item, Mapping)]
    else:
        names = values.get(f"{prefix}controller_names")
        keys = ("type", "action_ns")
        listed = [
            {"name": name, **{key: values.get(f"{prefix}{name}.{key}", "") for key in keys}}
            for name in (names if isinstance(names, (list, tuple)) else ())
        ]
    actions, others = [], []
    for item in listed:
        name, action = str(item.get("name", "")), str(item.get("action_ns") or "")
        if item.get("type") == _TRAJECTORY:
            actions.append("/".join(part for part in (name, action) if part))
        else:
            others.append(name)
    return Controllers(tuple(actions), tuple(others))


def sentences_of_differences(groups: RobotGroups, values: Values) -> list[str]:
    """Return what differs from MoveIt's node, one sentence for each cause."""
    told = list(groups.problems)
    pipelines = _names(values, "planning_pipelines", "planning_pipelines.pipeline_names", "planning_plugin")
    if pipelines:
        told.append(f"RRT-Connect of simkit replaces the planners of {', '.join(pipelines)}")
    solvers = sorted(
        {str(value) for name, value in values.items() if name.endswith(".kinematics_solver") and isinstance(value, str)}
    )
    if solvers:
        told.append(f"damped least squares replaces {', '.join(solvers)}")
    grippers = controllers_of(values).others
    if grippers:
        told.append(f"plans are not executed by {', '.join(grippers)}, whose type is not {_TRAJECTORY}")
    return told


def unused_names(groups: RobotGroups, values: Values) -> list[str]:
    """Return the names of parameters that have no effect and are not of a replaced planner, solver or controller."""
    replaced = {
        name.split(".")[0] for name in _names(values, "planning_pipelines", "planning_pipelines.pipeline_names")
    }
    known = (
        *groups.groups,
        "planner_configs",
        "request_adapters",
        "robot_description_kinematics",
        "start_state_max_bounds_error",
        "planning_pipelines",
        "planning_plugin",
        "moveit_simple_controller_manager",
    )
    found = []
    for name in values:
        first = name.split(".")[0]
        if name in _USED or first in replaced or first in known or name.startswith((_LIMITS, *_OF_CLIENTS)):
            continue
        found.append(first)
    return list(dict.fromkeys(found))


def _names(values: Values, *parameters: str) -> list[str]:
    """Return the names in the first of some parameters that is given."""
    for parameter in parameters:
        value = values.get(parameter)
        if isinstance(value, (list, tuple)):
            return [str(item) for item in value]
        if isinstance(value, str) and value:
            return [value]
    return []


def plugin_model(name: str, elements: str, namespace: str, remappings: Collection[tuple[str, str]]) -> str:
    """Return a static model without a shape whose plugin does the work of the node.

    Args:
        name: name of the model, and of the plugin.
        elements: elements of the plugin.
        namespace: namespace of the node.
        remappings: old and new names.
    """
    ros = _element("namespace", namespace) if namespace else ""
    ros += "".join(_element("remapping", f"{old}:={new}") for old, new in remappings)
    plugin = f'<plugin filename="libsimkit_move_group.so" name="{name}"><ros>{ros}</ros>{elements}</plugin>'
    return f'<sdf version="1.9"><model name="{name}"><static>true</static><link name="link"/>{plugin}</model></sdf>'


def _block(name: str, fields: Mapping[str, object]) -> str:
    return f"<{name}>{''.join(_fields(fields))}</{name}>"


def _fields(fields: Mapping[str, object]) -> Iterator[str]:
    return (_element(key, str(value)) for key, value in fields.items())


def _element(name: str, text: str) -> str:
    return f"<{name}>{html.escape(text)}</{name}>"

"""Robot with its groups, joints and links."""

from __future__ import annotations

import math
from typing import Any

from simkit_nodes.ros1_modules.moveit_commander.conversions import list_to_pose_stamped, pose_to_list
from simkit_nodes.ros1_modules.moveit_commander.exception import MoveItCommanderException
from simkit_nodes.ros1_modules.moveit_commander.move_group import MoveGroupCommander
from simkit_nodes.ros1_modules.moveit_commander.move_group_client import MoveGroupClient

__all__ = ["RobotCommander"]


class RobotJoint:
    """Joint of a robot.

    Args:
        robot: robot.
        name: name of the joint.
    """

    def __init__(self, robot: RobotCommander, name: str) -> None:
        self._robot, self._name = robot, name

    def name(self) -> str:
        """Return the name."""
        return self._name

    def variable_count(self) -> int:
        """Return the number of positions: 1, or 0 of a fixed joint."""
        return len(self._limits())

    def _limits(self) -> list[list[float]]:
        joint = self._robot._client.groups.tree.joints[self._name]
        if not joint.moves:
            return []
        return [[joint.lower, joint.upper]] if math.isfinite(joint.lower) else [[-math.pi, math.pi]]

    def bounds(self) -> Any:
        """Return the lower and the upper limit [rad or m]; π for a joint without limits."""
        limits = self._limits()
        return limits[0] if limits else limits

    def min_bound(self) -> Any:
        """Return the lower limit."""
        limits = self._limits()
        return limits[0][0] if limits else []

    def max_bound(self) -> Any:
        """Return the upper limit."""
        limits = self._limits()
        return limits[0][1] if limits else []

    def value(self) -> Any:
        """Return the position [rad or m]."""
        return self._robot._client.positions()[self._name] if self._limits() else []

    def move(self, position: float, wait: bool = True) -> bool:
        """Move the joint; the others of its group stay.

        Raises:
            MoveItCommanderException: no group has the joint.
        """
        group = self._robot.get_default_owner_group(self._name)
        if group is None:
            raise MoveItCommanderException(f"There is no known group containing joint {self._name}. Cannot move.")
        commander = self._robot.get_group(group)
        commander.set_joint_value_target(commander.get_current_joint_values())
        commander.set_joint_value_target(self._name, position)
        return commander.go(wait)


class RobotLink:
    """Link of a robot.

    Args:
        robot: robot.
        name: name of the link.
    """

    def __init__(self, robot: RobotCommander, name: str) -> None:
        self._robot, self._name = robot, name

    def name(self) -> str:
        """Return the name."""
        return self._name

    def pose(self) -> Any:
        """Return the pose in the planning frame, a `PoseStamped`."""
        pose = self._robot._client.pose(self._name).pose
        return list_to_pose_stamped(pose_to_list(pose), self._robot.get_planning_frame())


class RobotCommander:
    """Robot with its groups, joints and links, which are also attributes of their names.

    Args:
        robot_description: name of the parameter with the description of the robot.
        ns: namespace of `move_group`; empty for that of the program.

    Raises:
        RuntimeError: there are no descriptions of the robot, or they are not valid.
    """

    def __init__(self, robot_description: str = "robot_description", ns: str = "") -> None:
        self._description, self._namespace = robot_description, ns
        self._client = MoveGroupClient(robot_description, ns)
        self._groups: dict[str, MoveGroupCommander] = {}

    def get_planning_frame(self) -> str:
        """Return the frame of plans."""
        return self._client.groups.planning_frame

    def get_robot_markers(self, *args: object) -> Any:
        """Report that there are no markers.

        Raises:
            MoveItCommanderException: always.
        """
        raise MoveItCommanderException("simkit makes no markers of robots; the page of --web shows the robot")

    def get_root_link(self) -> str:
        """Return the name of the root link."""
        return self._client.groups.tree.root

    def get_active_joint_names(self, group: str | None = None) -> list[str]:
        """Return the names of the joints that move by themselves, of the robot or of a group."""
        if group is not None:
            return list(self._group(group).active)
        return [joint.name for joint in self._client.groups.tree.joints.values() if joint.is_active]

    def get_joint_names(self, group: str | None = None) -> list[str]:
        """Return the names of all joints, of the robot or of a group."""
        return list(self._client.groups.tree.joints if group is None else self._group(group).joints)

    def get_link_names(self, group: str | None = None) -> list[str]:
        """Return the names of all links, of the robot or of a group."""
        return list(self._client.groups.tree.links if group is None else self._group(group).links)

    def _group(self, name: str) -> Any:
        if not self.has_group(name):
            raise MoveItCommanderException(f"There is no group named {name}")
        return self._client.groups.groups[name]

    def get_group_names(self) -> list[str]:
        """Return the names of the groups."""
        return list(self._client.groups.groups)

    def get_current_state(self) -> Any:
        """Return the state of the robot, a `RobotState`."""
        return self._client.state()

    def get_current_variable_values(self) -> dict[str, float]:
        """Return the positions of the joints [rad or m]."""
        return self._client.positions()

    def get_joint(self, name: str) -> RobotJoint:
        """Return a joint.

        Raises:
            MoveItCommanderException: the robot has no such joint.
        """
        if name not in self._client.groups.tree.joints:
            raise MoveItCommanderException(f"There is no joint named {name}")
        return RobotJoint(self, name)

    def get_link(self, name: str) -> RobotLink:
        """Return a link.

        Raises:
            MoveItCommanderException: the robot has no such link.
        """
        if name not in self._client.groups.tree.links:
            raise MoveItCommanderException(f"There is no link named {name}")
        return RobotLink(self, name)

    def get_group(self, name: str) -> MoveGroupCommander:
        """Return the commands for a group.

        Raises:
            MoveItCommanderException: there is no such group.
        """
        self._group(name)
        if name not in self._groups:
            self._groups[name] = MoveGroupCommander(name, self._description, self._namespace)
        return self._groups[name]

    def has_group(self, name: str) -> bool:
        """Check whether there is a group."""
        return name in self._client.groups.groups

    def get_default_owner_group(self, joint_name: str) -> str | None:
        """Return the smallest group with a joint; None without one."""
        groups = [group for group in self._client.groups.groups.values() if joint_name in group.joints]
        return min(groups, key=lambda group: len(group.links)).name if groups else None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        groups = self._client.groups
        if name in groups.groups:
            return self.get_group(name)
        if name in groups.tree.joints:
            return RobotJoint(self, name)
        if name in groups.tree.links:
            return RobotLink(self, name)
        raise AttributeError(f"the robot has no group, joint or link {name!r}")


for _name, _class in {"Joint": RobotJoint, "Link": RobotLink}.items():
    setattr(RobotCommander, _name, _class)

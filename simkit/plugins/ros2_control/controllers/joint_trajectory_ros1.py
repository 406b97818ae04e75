"""ROS 1's kinds of joint trajectory controllers, whose interfaces follow from their type."""

from __future__ import annotations

from typing import ClassVar

from simkit.plugins.ros2_control.controllers.joint_trajectory import JointTrajectoryController


class PositionJointTrajectoryController(JointTrajectoryController):
    """ROS 1's controller for joints that are commanded by position."""

    types = ("position_controllers/JointTrajectoryController",)
    default_commands: ClassVar[tuple[str, ...]] = ("position",)
    default_states = ("position", "velocity")
    topics = ("~/command", "~/joint_trajectory")
    may_end_moving = True


class VelocityJointTrajectoryController(PositionJointTrajectoryController):
    """ROS 1's controller for joints that are commanded by velocity, through PIDs."""

    types = ("velocity_controllers/JointTrajectoryController",)
    default_commands = ("velocity",)


class EffortJointTrajectoryController(PositionJointTrajectoryController):
    """ROS 1's controller for joints that are commanded by effort, through PIDs."""

    types = ("effort_controllers/JointTrajectoryController",)
    default_commands = ("effort",)


class PositionVelocityJointTrajectoryController(PositionJointTrajectoryController):
    """ROS 1's controller for joints that are commanded by position and velocity."""

    types = ("pos_vel_controllers/JointTrajectoryController",)
    default_commands = ("position", "velocity")

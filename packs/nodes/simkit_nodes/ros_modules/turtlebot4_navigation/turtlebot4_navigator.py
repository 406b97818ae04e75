"""Navigator of the TurtleBot 4: Nav2, and the dock of the base."""

from __future__ import annotations

import enum
import math
from collections.abc import Sequence
from typing import Any

from simkit_nodes.host import current_host, current_program
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules import rclpy
from simkit_nodes.ros_modules.nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult
from simkit_nodes.ros_modules.rclpy.action import ActionClient
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.qos import qos_profile_sensor_data, qos_profile_system_default

__all__ = ["TurtleBot4Directions", "TurtleBot4Navigator"]

_geometry: Any = interface_module("geometry_msgs.msg", ROS2)
_actions: Any = interface_module("irobot_create_msgs.action", ROS2)
_dock_status = ROS2.message_class("irobot_create_msgs/msg/DockStatus")

_SUCCEEDED = 4
_LONGEST_NAVIGATION = Duration(seconds=600.0)
_RESULTS = {
    TaskResult.SUCCEEDED: "Goal succeeded!",
    TaskResult.CANCELED: "Goal was canceled!",
    TaskResult.FAILED: "Goal failed!",
}


class TurtleBot4Directions(enum.IntEnum):
    """Directions on the map [degrees]."""

    NORTH = 0
    NORTH_WEST = 45
    WEST = 90
    SOUTH_WEST = 135
    SOUTH = 180
    SOUTH_EAST = 225
    EAST = 270
    NORTH_EAST = 315


class TurtleBot4Navigator(BasicNavigator):
    """Node with the functions of `BasicNavigator`, and with those for the dock."""

    def __init__(self) -> None:
        super().__init__()
        self.is_docked: bool | None = None
        self.creating_path = False
        self.new_pose: Any = None
        self.create_subscription(_dock_status, "dock_status", self._dockCallback, qos_profile_sensor_data)
        self.create_subscription(
            _geometry.PoseWithCovarianceStamped, "initialpose", self._poseEstimateCallback, qos_profile_system_default
        )
        self.undock_action_client = ActionClient(self, _actions.Undock, "undock")
        self.dock_action_client = ActionClient(self, _actions.Dock, "dock")
        self.undock_result_future: Any = None
        self.dock_result_future: Any = None

    # ------------------------------------------------------------------ poses

    def getPoseStamped(self, position: Sequence[float], rotation: float) -> Any:
        """Return a pose on the map from x and y [m] and an angle about z [degrees]."""
        pose = _geometry.Pose()
        pose.position.x, pose.position.y = position[0], position[1]
        pose.orientation.z = math.sin(math.radians(rotation) / 2)
        pose.orientation.w = math.cos(math.radians(rotation) / 2)
        return self.stampPose(pose)

    def stampPose(self, pose: ProgramMessage) -> Any:
        """Return a pose with the time and the frame of the map."""
        stamped = _geometry.PoseStamped(pose=pose)
        stamped.header.frame_id, stamped.header.stamp = "map", self.get_clock().now().to_msg()
        return stamped

    def createPath(self) -> list[Any]:
        """Return the poses that are published on `/initialpose` until a line of input ends the path."""
        self.info("Creating a path. Press Enter to finish.")
        self.info('Use the "2D Pose Estimate" tool in Rviz to add a pose to the path.')
        poses: list[Any] = []
        self.new_pose, self.creating_path = None, True
        reader = current_host().start_thread(current_program().stdin.readline, "input")
        while not reader.is_done or self.new_pose is not None:
            if self.new_pose is None:
                rclpy.spin_once(self, timeout_sec=0.1)
                continue
            self.info("Pose added.")
            poses.append(self.stampPose(self.new_pose))
            self.new_pose = None
            self.clearAllCostmaps()
        self.creating_path = False
        return poses

    def _poseEstimateCallback(self, msg: ProgramMessage) -> None:
        if self.creating_path:
            self.new_pose = msg.pose.pose

    # ------------------------------------------------------------------ dock

    def _dockCallback(self, msg: ProgramMessage) -> None:
        self.is_docked = msg.is_docked

    def getDockedStatus(self) -> bool:
        """Wait for the status of the dock, and return True if the robot is docked."""
        rclpy.spin_once(self, timeout_sec=0.1)
        while self.is_docked is None:
            rclpy.spin_once(self, timeout_sec=0.1)
        return self.is_docked

    def undock(self) -> None:
        """Leave the dock."""
        self.info("Undocking...")
        self.undock_send_goal()
        while not self.isUndockComplete():
            pass

    def dock(self) -> None:
        """Drive to the dock."""
        self.info("Docking...")
        self.dock_send_goal()
        while not self.isDockComplete():
            pass

    def undock_send_goal(self) -> None:
        """Begin to leave the dock."""
        self.undock_result_future = self._send_goal(self.undock_action_client, _actions.Undock.Goal(), "Undock")

    def dock_send_goal(self) -> None:
        """Begin to drive to the dock."""
        self.dock_result_future = self._send_goal(self.dock_action_client, _actions.Dock.Goal(), "Dock")

    def _send_goal(self, client: Any, goal: ProgramMessage, name: str) -> Any:
        client.wait_for_server()
        future = client.send_goal_async(goal)
        rclpy.spin_until_future_complete(self, future)
        if future.result().accepted:
            return future.result().get_result_async()
        self.error(f"{name} goal rejected")
        return None

    def isUndockComplete(self) -> bool:
        """Check whether the robot has left the dock, or has failed to."""
        return self._is_complete(self.undock_result_future, "Undock")

    def isDockComplete(self) -> bool:
        """Check whether the robot has reached the dock, or has failed to."""
        return self._is_complete(self.dock_result_future, "Dock")

    def _is_complete(self, future: Any, name: str) -> bool:
        if future is None:
            return True
        rclpy.spin_until_future_complete(self, future, timeout_sec=0.1)
        if future.result() is None:
            return False
        status = future.result().status
        self.info(f"{name} succeeded" if status == _SUCCEEDED else f"Goal failed with status code: {status}")
        return True

    # ------------------------------------------------------------------ navigation

    def startToPose(self, pose: ProgramMessage) -> None:
        """Drive to a pose, and print the estimated time of arrival."""
        self.goToPose(pose)
        self._follow(self._print_arrival)

    def startThroughPoses(self, poses: Any) -> None:
        """Drive through poses, and print the estimated time of arrival."""
        self.goThroughPoses(poses)
        self._follow(self._print_arrival)

    def startFollowWaypoints(self, poses: Any) -> None:
        """Drive to poses one after another, and print the number of the present one."""
        self.followWaypoints(poses)
        self._follow(lambda feedback: self._print(f"Executing current waypoint: {feedback.current_waypoint + 1}"))

    def _follow(self, report: Any) -> None:
        """Wait for the end of a task, call a function with every fifth feedback, and log the result."""
        number = 0
        while not self.isTaskComplete():
            number += 1
            feedback = self.getFeedback()
            if feedback and number % 5 == 0:
                report(feedback)
        self.info(_RESULTS.get(self.getResult(), "Goal has an invalid return status!"))

    def _print_arrival(self, feedback: ProgramMessage) -> None:
        remaining = Duration.from_msg(feedback.estimated_time_remaining).nanoseconds / 1e9
        self._print(f"Estimated time of arrival: {remaining:.0f} seconds.")
        if Duration.from_msg(feedback.navigation_time) > _LONGEST_NAVIGATION:
            self.cancelTask()

    @staticmethod
    def _print(text: str) -> None:
        current_program().stdout.write(text + "\r")

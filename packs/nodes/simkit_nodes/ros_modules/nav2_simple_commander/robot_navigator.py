"""Node with functions for the actions and services of Nav2."""

from __future__ import annotations

from enum import Enum
from typing import Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules import rclpy
from simkit_nodes.ros_modules.rclpy.action import ActionClient
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.node import Node
from simkit_nodes.ros_modules.rclpy.qos import (
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSProfile,
    QoSReliabilityPolicy,
)

__all__ = ["BasicNavigator", "TaskResult"]

_geometry: Any = interface_module("geometry_msgs.msg", ROS2)
_actions: Any = interface_module("nav2_msgs.action", ROS2)
_services: Any = interface_module("nav2_msgs.srv", ROS2)
_lifecycle: Any = interface_module("lifecycle_msgs.srv", ROS2)
_status = ROS2.message_class("action_msgs/msg/GoalStatus")
_duration = ROS2.message_class("builtin_interfaces/msg/Duration")

_ACTION_CLIENTS: Final = {
    "nav_through_poses_client": ("NavigateThroughPoses", "navigate_through_poses"),
    "nav_to_pose_client": ("NavigateToPose", "navigate_to_pose"),
    "follow_waypoints_client": ("FollowWaypoints", "follow_waypoints"),
    "follow_gps_waypoints_client": ("FollowGPSWaypoints", "follow_gps_waypoints"),
    "follow_path_client": ("FollowPath", "follow_path"),
    "compute_path_to_pose_client": ("ComputePathToPose", "compute_path_to_pose"),
    "compute_path_through_poses_client": ("ComputePathThroughPoses", "compute_path_through_poses"),
    "smoother_client": ("SmoothPath", "smooth_path"),
    "spin_client": ("Spin", "spin"),
    "backup_client": ("BackUp", "backup"),
    "drive_on_heading_client": ("DriveOnHeading", "drive_on_heading"),
    "assisted_teleop_client": ("AssistedTeleop", "assisted_teleop"),
    "docking_client": ("DockRobot", "dock_robot"),
    "undocking_client": ("UndockRobot", "undock_robot"),
}
"""Type and name of the action of each client."""

_SERVICE_CLIENTS: Final = {
    "change_maps_srv": ("LoadMap", "map_server/load_map"),
    "clear_costmap_global_srv": ("ClearEntireCostmap", "global_costmap/clear_entirely_global_costmap"),
    "clear_costmap_local_srv": ("ClearEntireCostmap", "local_costmap/clear_entirely_local_costmap"),
    "clear_costmap_except_region_srv": ("ClearCostmapExceptRegion", "local_costmap/clear_costmap_except_region"),
    "clear_costmap_around_robot_srv": ("ClearCostmapAroundRobot", "local_costmap/clear_costmap_around_robot"),
    "clear_costmap_around_pose_srv": ("ClearCostmapAroundPose", "local_costmap/clear_costmap_around_pose"),
    "get_costmap_global_srv": ("GetCostmap", "global_costmap/get_costmap"),
    "get_costmap_local_srv": ("GetCostmap", "local_costmap/get_costmap"),
}
"""Type and name of the service of each client."""

_MANAGER: Final = "nav2_msgs/srv/ManageLifecycleNodes"
_ACTIVATION_PERIOD_NS: Final = 2_000_000_000


class TaskResult(Enum):
    """Result of a task."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


_RESULTS: Final = {
    _status.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    _status.STATUS_ABORTED: TaskResult.FAILED,
    _status.STATUS_CANCELED: TaskResult.CANCELED,
}


class BasicNavigator(Node):
    """Node that sends one task after another to Nav2.

    Args:
        node_name: name of the node.
        namespace: namespace of the node.

    Attributes:
        goal_handle: goal of the present task.
        result_future: future with the result of the present task.
        feedback: newest feedback of the present task.
        status: status of the last task that has ended; None before.
    """

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name=node_name, namespace=namespace)
        self.initial_pose: Any = _geometry.PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.goal_handle: Any = None
        self.result_future: Any = None
        self.feedback: Any = None
        self.status: int | None = None
        self.initial_pose_received = False
        for attribute, (kind, name) in _ACTION_CLIENTS.items():
            setattr(self, attribute, ActionClient(self, getattr(_actions, kind), name))
        latched = QoSProfile(
            durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
            reliability=QoSReliabilityPolicy.RELIABLE,
            history=QoSHistoryPolicy.KEEP_LAST,
            depth=1,
        )
        pose_type = _geometry.PoseWithCovarianceStamped
        self.localization_pose_sub = self.create_subscription(pose_type, "amcl_pose", self._amclPoseCallback, latched)
        self.initial_pose_pub = self.create_publisher(pose_type, "initialpose", 10)
        for attribute, (kind, name) in _SERVICE_CLIENTS.items():
            setattr(self, attribute, self.create_client(getattr(_services, kind), name))

    def destroyNode(self) -> None:
        """Close the node."""
        self.destroy_node()

    def destroy_node(self) -> None:
        """Close the node and its clients."""
        for attribute in _ACTION_CLIENTS:
            getattr(self, attribute).destroy()
        super().destroy_node()

    # ------------------------------------------------------------------ tasks

    def goThroughPoses(self, poses: Any, behavior_tree: str = "") -> bool:
        """Begin to drive through poses; return False if the goal is rejected."""
        return self._begin(
            "nav_through_poses_client",
            f"Navigating with {len(poses)} goals....",
            f"Goal with {len(poses)} poses was rejected!",
            poses=poses,
            behavior_tree=behavior_tree,
        )

    def goToPose(self, pose: ProgramMessage, behavior_tree: str = "") -> bool:
        """Begin to drive to a `PoseStamped`; return False if the goal is rejected."""
        place = f"{pose.pose.position.x} {pose.pose.position.y}"
        return self._begin(
            "nav_to_pose_client",
            f"Navigating to goal: {place}...",
            f"Goal to {place} was rejected!",
            pose=pose,
            behavior_tree=behavior_tree,
        )

    def followWaypoints(self, poses: Any) -> bool:
        """Begin to drive to one pose after another; return False if the goal is rejected."""
        rejected = f"Following {len(poses)} waypoints request was rejected!"
        return self._begin("follow_waypoints_client", f"Following {len(poses)} goals....", rejected, poses=poses)

    def followGpsWaypoints(self, gps_poses: Any) -> bool:
        """Begin to drive to one `GeoPose` after another; return False if the goal is rejected."""
        count = len(gps_poses)
        rejected = f"Following {count} gps waypoints request was rejected!"
        return self._begin(
            "follow_gps_waypoints_client", f"Following {count} gps goals....", rejected, gps_poses=gps_poses
        )

    def spin(self, spin_dist: float = 1.57, time_allowance: int = 10) -> bool:
        """Begin to turn by an angle [rad] within a time [s]; return False if the goal is rejected."""
        return self._begin(
            "spin_client",
            f"Spinning to angle {spin_dist}....",
            "Spin request was rejected!",
            target_yaw=spin_dist,
            time_allowance=_duration(sec=time_allowance),
        )

    def backup(self, backup_dist: float = 0.15, backup_speed: float = 0.025, time_allowance: int = 10) -> bool:
        """Begin to drive backwards: distance [m], speed [m/s], time [s]; return False if the goal is rejected."""
        return self._begin(
            "backup_client",
            f"Backing up {float(backup_dist)} m at {backup_speed} m/s....",
            "Backup request was rejected!",
            target=_geometry.Point(x=float(backup_dist)),
            speed=backup_speed,
            time_allowance=_duration(sec=time_allowance),
        )

    def driveOnHeading(self, dist: float = 0.15, speed: float = 0.025, time_allowance: int = 10) -> bool:
        """Begin to drive straight on: distance [m], speed [m/s], time [s]; return False if the goal is rejected."""
        return self._begin(
            "drive_on_heading_client",
            f"Drive {float(dist)} m on heading at {speed} m/s....",
            "Drive On Heading request was rejected!",
            target=_geometry.Point(x=float(dist)),
            speed=speed,
            time_allowance=_duration(sec=time_allowance),
        )

    def assistedTeleop(self, time_allowance: int = 30) -> bool:
        """Begin to filter commands of a person for a time [s]; return False if the goal is rejected."""
        return self._begin(
            "assisted_teleop_client",
            "Running 'assisted_teleop'....",
            "Assisted Teleop request was rejected!",
            time_allowance=_duration(sec=time_allowance),
        )

    def followPath(self, path: Any, controller_id: str = "", goal_checker_id: str = "") -> bool:
        """Begin to follow a `nav_msgs.msg.Path`; return False if the goal is rejected."""
        return self._begin(
            "follow_path_client",
            "Executing path...",
            "Follow path was rejected!",
            path=path,
            controller_id=controller_id,
            goal_checker_id=goal_checker_id,
        )

    def dockRobotByPose(self, dock_pose: Any, dock_type: str, nav_to_dock: bool = True) -> bool:
        """Begin to dock at a `PoseStamped`; return False if the goal is rejected."""
        return self._begin(
            "docking_client",
            f"Docking at pose: {dock_pose}...",
            "Docking request was rejected!",
            use_dock_id=False,
            dock_pose=dock_pose,
            dock_type=dock_type,
            navigate_to_staging_pose=nav_to_dock,
        )

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> bool:
        """Begin to dock at a known dock; return False if the goal is rejected."""
        return self._begin(
            "docking_client",
            f"Docking at dock ID: {dock_id}...",
            "Docking request was rejected!",
            use_dock_id=True,
            dock_id=dock_id,
            navigate_to_staging_pose=nav_to_dock,
        )

    def undockRobot(self, dock_type: str = "") -> bool:
        """Begin to leave a dock; return False if the goal is rejected."""
        return self._begin(
            "undocking_client",
            f"Undocking from dock of type: {dock_type}...",
            "Undocking request was rejected!",
            dock_type=dock_type,
        )

    def _begin(self, attribute: str, begun: str, rejected: str, **fields: Any) -> bool:
        """Send a goal as the present task; return False if it is rejected."""
        if not self._send(attribute, begun, rejected, self._feedbackCallback, fields):
            return False
        self.result_future = self.goal_handle.get_result_async()
        return True

    def _send(self, attribute: str, begun: str, rejected: str, callback: Any, fields: dict[str, Any]) -> bool:
        kind, _ = _ACTION_CLIENTS[attribute]
        client = getattr(self, attribute)
        self.debug(f"Waiting for {kind!r} action server")
        while not client.wait_for_server(timeout_sec=1.0):
            self.info(f"{kind!r} action server not available, waiting...")
        goal = getattr(_actions, kind).Goal()
        for name, value in fields.items():
            setattr(goal, name, value)
        self.info(begun)
        future = client.send_goal_async(goal, callback)
        rclpy.spin_until_future_complete(self, future)
        self.goal_handle = future.result()
        if not self.goal_handle.accepted:
            self.error(rejected)
            return False
        return True

    def cancelTask(self) -> None:
        """Cancel the present task."""
        self.info("Canceling current task.")
        if self.result_future:
            rclpy.spin_until_future_complete(self, self.goal_handle.cancel_goal_async())

    def isTaskComplete(self) -> bool:
        """Wait up to 0.1 s for the result of the present task; return whether it has ended."""
        if not self.result_future:
            return True
        rclpy.spin_until_future_complete(self, self.result_future, timeout_sec=0.10)
        response = self.result_future.result()
        if not response:
            return False
        self.status = response.status
        succeeded = self.status == _status.STATUS_SUCCEEDED
        self.debug("Task succeeded!" if succeeded else f"Task with failed with status code: {self.status}")
        return True

    def getFeedback(self) -> Any:
        """Return the newest feedback of the present task; None without any."""
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return the result of the last task that has ended."""
        return _RESULTS.get(self.status, TaskResult.UNKNOWN)

    # ------------------------------------------------------------------ paths

    def getPath(self, start: Any, goal: ProgramMessage, planner_id: str = "", use_start: bool = False) -> Any:
        """Return a path between two `PoseStamped`; None if there is none."""
        return self._path(self._getPathImpl(start, goal, planner_id, use_start))

    def _getPathImpl(self, start: Any, goal: ProgramMessage, planner_id: str = "", use_start: bool = False) -> Any:
        fields = {"start": start, "goal": goal, "planner_id": planner_id, "use_start": use_start}
        return self._result("compute_path_to_pose_client", "Getting path...", "Get path was rejected!", fields)

    def getPathThroughPoses(self, start: Any, goals: Any, planner_id: str = "", use_start: bool = False) -> Any:
        """Return a path through several `PoseStamped`; None if there is none."""
        return self._path(self._getPathThroughPosesImpl(start, goals, planner_id, use_start))

    def _getPathThroughPosesImpl(self, start: Any, goals: Any, planner_id: str = "", use_start: bool = False) -> Any:
        fields = {"start": start, "goals": goals, "planner_id": planner_id, "use_start": use_start}
        return self._result("compute_path_through_poses_client", "Getting path...", "Get path was rejected!", fields)

    def smoothPath(
        self, path: Any, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Any:
        """Return a smoothed path; None if there is none."""
        return self._path(self._smoothPathImpl(path, smoother_id, max_duration, check_for_collision))

    def _smoothPathImpl(
        self, path: Any, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Any:
        fields = {
            "path": path,
            "max_smoothing_duration": Duration(seconds=max_duration).to_msg(),
            "smoother_id": smoother_id,
            "check_for_collisions": check_for_collision,
        }
        return self._result("smoother_client", "Smoothing path...", "Smooth path was rejected!", fields)

    def _result(self, attribute: str, begun: str, rejected: str, fields: dict[str, Any]) -> Any:
        """Send a goal and return its result; None if it is rejected."""
        if not self._send(attribute, begun, rejected, None, fields):
            return None
        self.result_future = self.goal_handle.get_result_async()
        rclpy.spin_until_future_complete(self, self.result_future)
        response = self.result_future.result()
        self.status = response.status
        return response.result

    def _path(self, result: Any) -> Any:
        if self.status != _status.STATUS_SUCCEEDED:
            self.warn(f"Getting path failed with status code: {self.status}")
            return None
        return result.path if result else None

    # ------------------------------------------------------------------ maps

    def changeMap(self, map_filepath: str) -> None:
        """Load another map."""
        response = self._call("change_maps_srv", "change map service", map_url=map_filepath)
        if response.result == response.RESULT_SUCCESS:
            self.info("Change map request was successful!")
        else:
            self.error("Change map request failed!")

    def clearAllCostmaps(self) -> None:
        """Clear both costmaps."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        """Clear the local costmap."""
        self._call("clear_costmap_local_srv", "Clear local costmaps service")

    def clearGlobalCostmap(self) -> None:
        """Clear the global costmap."""
        self._call("clear_costmap_global_srv", "Clear global costmaps service")

    def clearCostmapExceptRegion(self, reset_distance: float) -> None:
        """Clear the local costmap beyond a distance [m]."""
        what = "ClearCostmapExceptRegion service"
        self._call("clear_costmap_except_region_srv", what, reset_distance=reset_distance)

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear the local costmap up to a distance [m] of the robot."""
        what = "ClearCostmapAroundRobot service"
        self._call("clear_costmap_around_robot_srv", what, reset_distance=reset_distance)

    def clearCostmapAroundPose(self, pose: ProgramMessage, reset_distance: float) -> None:
        """Clear the local costmap up to a distance [m] of a `PoseStamped`."""
        what = "ClearCostmapAroundPose service"
        self._call("clear_costmap_around_pose_srv", what, pose=pose, reset_distance=reset_distance)

    def getGlobalCostmap(self) -> Any:
        """Return the global costmap (`nav2_msgs.msg.Costmap`)."""
        return self._call("get_costmap_global_srv", "Get global costmaps service").map

    def getLocalCostmap(self) -> Any:
        """Return the local costmap (`nav2_msgs.msg.Costmap`)."""
        return self._call("get_costmap_local_srv", "Get local costmaps service").map

    def _call(self, attribute: str, what: str, **fields: Any) -> Any:
        """Call a service as soon as there is one, and return its response."""
        client = getattr(self, attribute)
        while not client.wait_for_service(timeout_sec=1.0):
            self.info(f"{what} not available, waiting...")
        request = getattr(_services, _SERVICE_CLIENTS[attribute][0]).Request()
        for name, value in fields.items():
            setattr(request, name, value)
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    # ------------------------------------------------------------------ lifecycle

    def setInitialPose(self, initial_pose: Any) -> None:
        """Publish the pose at the begin (`PoseStamped`) for the localisation."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        self._setInitialPose()

    def waitUntilNav2Active(self, navigator: str = "bt_navigator", localizer: str = "amcl") -> None:
        """Wait until the navigator and the localisation are active."""
        if localizer != "robot_localization":  # this node has no states
            self._waitForNodeToActivate(localizer)
        if localizer == "amcl":
            self._waitForInitialPose()
        self._waitForNodeToActivate(navigator)
        self.info("Nav2 is ready for use!")

    def lifecycleStartup(self) -> None:
        """Start all nodes of the lifecycle managers."""
        self.info("Starting up lifecycle nodes based on lifecycle_manager.")
        self._manage("Starting up", "STARTUP")
        self.info("Nav2 is ready for use!")

    def lifecycleShutdown(self) -> None:
        """End all nodes of the lifecycle managers."""
        self.info("Shutting down lifecycle nodes based on lifecycle_manager.")
        self._manage("Shutting down", "SHUTDOWN")

    def _manage(self, what: str, command: str) -> None:
        for name, types in self.get_service_names_and_types():
            if types[0] != _MANAGER:
                continue
            self.info(f"{what} {name}")
            client = self.create_client(_services.ManageLifecycleNodes, name)
            while not client.wait_for_service(timeout_sec=1.0):
                self.info(f"{name} service not available, waiting...")
            request = _services.ManageLifecycleNodes.Request()
            request.command = getattr(request, command)
            rclpy.spin_until_future_complete(self, client.call_async(request))

    def _waitForNodeToActivate(self, node_name: str) -> None:
        self.debug(f"Waiting for {node_name} to become active..")
        service = f"{node_name}/get_state"
        client = self.create_client(_lifecycle.GetState, service)
        while not client.wait_for_service(timeout_sec=1.0):
            self.info(f"{service} service not available, waiting...")
        state = "unknown"
        while state != "active":
            self.debug(f"Getting {node_name} state...")
            future = client.call_async(_lifecycle.GetState.Request())
            rclpy.spin_until_future_complete(self, future)
            if future.result() is not None:
                state = future.result().current_state.label
                self.debug(f"Result of get_state: {state}")
            host = current_host()
            host.wait(host.now_ns() + _ACTIVATION_PERIOD_NS)

    def _waitForInitialPose(self) -> None:
        while not self.initial_pose_received:
            self.info("Setting initial pose")
            self._setInitialPose()
            self.info("Waiting for amcl_pose to be received")
            rclpy.spin_once(self, timeout_sec=1.0)

    def _amclPoseCallback(self, msg: ProgramMessage) -> None:
        del msg
        self.debug("Received amcl pose")
        self.initial_pose_received = True

    def _feedbackCallback(self, msg: ProgramMessage) -> None:
        self.debug("Received action feedback message")
        self.feedback = msg.feedback

    def _setInitialPose(self) -> None:
        message = _geometry.PoseWithCovarianceStamped()
        message.pose.pose = self.initial_pose.pose
        message.header.frame_id = self.initial_pose.header.frame_id
        message.header.stamp = self.initial_pose.header.stamp
        self.info("Publishing Initial Pose")
        self.initial_pose_pub.publish(message)

    # ------------------------------------------------------------------ log

    def info(self, msg: str) -> None:
        """Log a message."""
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log a warning."""
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log an error."""
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log a message for debugging."""
        self.get_logger().debug(msg)

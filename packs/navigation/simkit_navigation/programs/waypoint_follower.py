"""Waypoint follower of Nav2: action `follow_waypoints`, which navigates to poses in turn."""

import sys

import rclpy
from action_msgs.msg import GoalStatus
from nav2_msgs.action import FollowWaypoints, NavigateToPose
from nav2_msgs.msg import MissedWaypoint
from node_support import ServerNode, run
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import TransitionCallbackReturn

PAUSE = 0.02  # [s] between two looks at a goal


class WaypointFollower(ServerNode):
    """Node that is active from `activate` on, and then has the action."""

    def __init__(self):
        super().__init__("waypoint_follower")
        self.declare_parameter("stop_on_failure", True)
        self.declare_parameter("loop_rate", 20)
        self.declare_parameter("waypoint_task_executor_plugin", "wait_at_waypoint")
        plugin = self.get_parameter("waypoint_task_executor_plugin").value
        self.declare_parameter(f"{plugin}.plugin", "nav2_waypoint_follower::WaitAtWaypoint")
        self._pause = self.declare_parameter(f"{plugin}.waypoint_pause_duration", 0)  # [ms]
        self._group = ReentrantCallbackGroup()
        self._server = None

    def on_configure(self, state):
        """Open the client of the navigator."""
        super().on_configure(state)
        self._client = ActionClient(self, NavigateToPose, "navigate_to_pose", callback_group=self._group)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        """Open the action."""
        super().on_activate(state)
        self._server = ActionServer(
            self,
            FollowWaypoints,
            "follow_waypoints",
            self._follow,
            callback_group=self._group,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        return TransitionCallbackReturn.SUCCESS

    def on_deactivate(self, state):
        """Close the action."""
        super().on_deactivate(state)
        self._server.destroy()
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the client."""
        super().on_cleanup(state)
        self._client.destroy()
        return TransitionCallbackReturn.SUCCESS

    def _follow(self, handle):
        """Navigate to the poses of a goal."""
        result, request = FollowWaypoints.Result(), handle.request
        poses = list(request.poses)
        self.get_logger().info(f"Received follow waypoint request with {len(poses)} waypoints.")
        first = request.goal_index
        stops = self.get_parameter("stop_on_failure").value
        for index in range(first, len(poses)):
            handle.publish_feedback(FollowWaypoints.Feedback(current_waypoint=index))
            status = self._navigate(handle, poses[index])
            if status is None:
                handle.canceled()
                return result
            if status == GoalStatus.STATUS_SUCCEEDED:
                self.get_logger().info(f"Succeeded processing waypoint {index}")
                self._wait(self._pause.value * 1e-3)
                continue
            result.missed_waypoints.append(MissedWaypoint(index=index, goal=poses[index]))
            if stops:
                end = "in waypoint list and stop on failure is enabled. Terminating action."
                self.get_logger().warning(f"Failed to process waypoint {index} {end}")
                handle.abort()
                return result
            self.get_logger().info(f"Failed to process waypoint {index}, moving to next.")
        handle.succeed()
        self.get_logger().info(f"Completed all {len(poses)} waypoints requested.")
        return result

    def _navigate(self, handle, pose):
        """Navigate to a pose; return the status of the goal, or None if the client has cancelled."""
        if not self._client.wait_for_server(timeout_sec=2.0):
            return GoalStatus.STATUS_ABORTED
        sent = self._client.send_goal_async(NavigateToPose.Goal(pose=pose))
        if not self._wait_for(sent, handle):
            return None
        goal = sent.result()
        if not goal.accepted:
            return GoalStatus.STATUS_ABORTED
        future = goal.get_result_async()
        if not self._wait_for(future, handle):
            self._wait_for(goal.cancel_goal_async(), None)
            return None
        return future.result().status

    def _wait_for(self, future, handle):
        """Wait for a future; return False if the client has cancelled."""
        while not future.done():
            if handle is not None and handle.is_cancel_requested:
                return False
            self._wait(PAUSE)
        return True

    def _wait(self, seconds):
        if seconds > 0:
            self.get_clock().sleep_for(Duration(seconds=seconds))


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(WaypointFollower(), MultiThreadedExecutor(4))


if __name__ == "__main__":
    main()

"""Nodes that change paths and lists of goals (`nav2_behavior_tree/plugins/action`)."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Final

from simkit import msgs
from simkit.pose import wrap_angle
from simkit_navigation.behavior_trees.path_geometry import distance, index_after, is_same, nearest_index
from simkit_navigation.behavior_trees.tree_node import FAILURE, SUCCESS, Ports, TreeNode
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, pose_of_message, stamped_pose


class RemovePassedGoals(TreeNode):
    """Removes the first goals while the robot is within `radius` of them; the last goal stays."""

    ports: ClassVar[Ports] = (
        *("input_goals", "output_goals", "radius", "robot_base_frame", "global_frame", "nb_goals_to_consider"),
        *("input_waypoint_statuses", "output_waypoint_statuses"),
    )

    def tick(self) -> str:
        goals = list(self.input("input_goals") or ())
        if goals:
            pose = self.tree.pose_of(self, goals[0].header.frame_id)
            if pose is None:
                return FAILURE
            radius = self.number("radius", 0.5)
            while len(goals) > 1 and _distance(goals[0], pose) <= radius:
                goals.pop(0)
        self.output("output_goals", goals)
        return SUCCESS


def _distance(goal: msgs.PoseStamped, pose: PlanarPose) -> float:
    return math.hypot(goal.pose.position.x - pose.x, goal.pose.position.y - pose.y)


class TruncatePath(TreeNode):
    """Removes the end of a path, up to `distance` from its last pose."""

    ports: ClassVar[Ports] = ("distance", "input_path", "output_path")

    def tick(self) -> str:
        path = self.input("input_path")
        if path is None or not path.poses:
            self.output("output_path", path)
            return SUCCESS
        poses, end, length = list(path.poses), path.poses[-1], self.number("distance", 1.0)
        while len(poses) > 2 and distance(poses[-1], end) < length:
            poses.pop()
        last = poses[-1].pose.position
        yaw = math.atan2(end.pose.position.y - last.y, end.pose.position.x - last.x)
        poses[-1] = stamped_pose(PlanarPose(last.x, last.y, yaw), poses[-1].header)
        self.output("output_path", msgs.Path(path.header, poses))
        return SUCCESS


class TruncatePathLocal(TreeNode):
    """Keeps the part of a path around the robot."""

    ports: ClassVar[Ports] = (
        *("input_path", "output_path", "distance_forward", "distance_backward", "robot_base_frame", "robot_frame"),
        *("transform_tolerance", "pose", "angular_distance_weight", "max_robot_pose_search_dist"),
    )

    def prepare(self) -> None:
        self.path: Any = None
        self.begin = 0

    def tick(self) -> str:
        path, search = self.input("input_path"), self.number("max_robot_pose_search_dist", math.inf)
        if path is None or not path.poses:
            self.output("output_path", path)
            return SUCCESS
        given = self.input("pose")
        pose = self.tree.pose_of(self, path.header.frame_id) if given is None else pose_of_message(given.pose)
        if pose is None:
            return FAILURE
        if not math.isfinite(search) or not is_same(path, self.path):
            self.path, self.begin = path, 0
        end = index_after(path.poses, self.begin, search) if math.isfinite(search) else None
        index = self._nearest(path.poses, pose, end)
        if math.isfinite(search):
            self.begin = index
        forward, backward = self.number("distance_forward", 8.0), self.number("distance_backward", 4.0)
        last = len(path.poses) if forward < 0 else index_after(path.poses, index, forward)
        first = index_after(path.poses, index, backward, -1) + 1
        self.output("output_path", msgs.Path(path.header, list(path.poses[first:last])))
        return SUCCESS

    def _nearest(self, poses: list[msgs.PoseStamped], pose: PlanarPose, end: int | None) -> int:
        weight = self.number("angular_distance_weight", 0.0)
        if weight == 0:
            return nearest_index(poses, pose.x, pose.y, self.begin, end)
        yaws = [found.yaw if (found := pose_of_message(stamped.pose)) else 0.0 for stamped in poses]
        indices = range(self.begin, len(poses) if end is None else max(end, self.begin + 1))
        turns = {index: weight * wrap_angle(yaws[index] - pose.yaw) for index in indices}
        return min(indices, key=lambda index: math.hypot(_distance(poses[index], pose), turns[index]))


class GetPoseFromPath(TreeNode):
    """Writes the pose of an index of a path; -1 is the last one."""

    ports: ClassVar[Ports] = ("path", "pose", "index")

    def tick(self) -> str:
        path, index = self.input("path"), self.integer("index", 0)
        count = 0 if path is None else len(path.poses)
        if not -count <= index < count:
            return FAILURE
        pose = path.poses[index]
        if not pose.header.frame_id:
            pose = msgs.PoseStamped(path.header, pose.pose)
        self.output("pose", pose)
        return SUCCESS


class ConcatenatePaths(TreeNode):
    """Joins two paths."""

    ports: ClassVar[Ports] = ("input_path1", "input_path2", "output_path")

    def tick(self) -> str:
        paths = [path for path in (self.input("input_path1"), self.input("input_path2")) if path is not None]
        poses = [pose for path in paths for pose in path.poses]
        if not poses:
            return FAILURE
        header = next(path.header for path in paths if path.poses)
        self.output("output_path", msgs.Path(header, poses))
        return SUCCESS


class GetCurrentPose(TreeNode):
    """Writes the pose of the robot."""

    ports: ClassVar[Ports] = ("global_frame", "robot_base_frame", "current_pose")

    def tick(self) -> str:
        pose = self.tree.pose_of(self)
        if pose is None:
            return FAILURE
        frame = self.text("global_frame") or str(self.tree.option("global_frame", "map"))
        self.output("current_pose", stamped_pose(pose, msgs.header(self.tree.time_ns, frame)))
        return SUCCESS


class GetNextFewGoals(TreeNode):
    """Writes the first goals of a list."""

    ports: ClassVar[Ports] = ("input_goals", "num_goals", "output_goals")

    def tick(self) -> str:
        goals = list(self.input("input_goals") or ())
        if not goals:
            return FAILURE
        self.output("output_goals", goals[: max(self.integer("num_goals", 1), 0)])
        return SUCCESS


class AppendGoalPoseToGoals(TreeNode):
    """Appends a goal to a list."""

    ports: ClassVar[Ports] = ("goal_pose", "input_goals", "output_goals")

    def tick(self) -> str:
        goal = self.input("goal_pose")
        self.output("output_goals", [*(self.input("input_goals") or ()), *([] if goal is None else [goal])])
        return SUCCESS


PATH_NODES: Final = {
    node.__name__: node
    for node in (
        *(RemovePassedGoals, TruncatePath, TruncatePathLocal, GetPoseFromPath, ConcatenatePaths, GetCurrentPose),
        *(GetNextFewGoals, AppendGoalPoseToGoals),
    )
}
"""Classes by their name in a file."""

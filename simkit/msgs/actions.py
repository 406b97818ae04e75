"""Definitions of actions, in the `.action` form of ROS 2: the goal, `---`, the result, `---`, the feedback.

They are published interfaces: field names, types and order are theirs. An action of type `<package>/action/<Name>` has
the messages `<package>/action/<Name>_Goal`, `…_Result` and `…_Feedback`.
"""

from __future__ import annotations

MESSAGES: dict[str, str] = {
    "control_msgs/msg/JointTolerance": """
string name
float64 position
float64 velocity
float64 acceleration
""",
}
"""What the actions are made of and the store lacks."""

ACTIONS: dict[str, str] = {
    "control_msgs/action/FollowJointTrajectory": """
trajectory_msgs/JointTrajectory trajectory
control_msgs/JointTolerance[] path_tolerance
control_msgs/JointTolerance[] goal_tolerance
builtin_interfaces/Duration goal_time_tolerance
---
int32 SUCCESSFUL=0
int32 INVALID_GOAL=-1
int32 INVALID_JOINTS=-2
int32 OLD_HEADER_TIMESTAMP=-3
int32 PATH_TOLERANCE_VIOLATED=-4
int32 GOAL_TOLERANCE_VIOLATED=-5
int32 error_code
string error_string
---
std_msgs/Header header
string[] joint_names
trajectory_msgs/JointTrajectoryPoint desired
trajectory_msgs/JointTrajectoryPoint actual
trajectory_msgs/JointTrajectoryPoint error
""",
    "control_msgs/action/GripperCommand": """
float64 position
float64 max_effort
---
float64 position
float64 effort
bool stalled
bool reached_goal
---
float64 position
float64 effort
bool stalled
bool reached_goal
""",
    "example_interfaces/action/Fibonacci": """
int32 order
---
int32[] sequence
---
int32[] sequence
""",
}

"""Messages of play_motion: motions that a robot knows by name, as PAL's packages type them.

The interfaces of `play_motion2_msgs` (ROS 2) and `play_motion_msgs` (ROS 1, with ROS 2's duration) are published ones:
field names, types and order are theirs.
"""

from __future__ import annotations

MESSAGES: dict[str, str] = {
    "play_motion2_msgs/msg/Motion": """
string key
string name
string usage
string description
string[] joints
float64[] positions
float64[] times_from_start
""",
    "play_motion_msgs/msg/MotionInfo": """
string name
string[] joints
builtin_interfaces/Duration duration
""",
}
"""What the services and actions are made of."""

SERVICES: dict[str, str] = {
    "play_motion2_msgs/srv/ListMotions": """
---
string[] motion_keys
""",
    "play_motion2_msgs/srv/IsMotionReady": """
string motion_key
---
bool is_ready
""",
    "play_motion2_msgs/srv/IsJointListReady": """
string[] joints
---
bool is_ready
""",
    "play_motion2_msgs/srv/GetMotionInfo": """
string motion_key
---
play_motion2_msgs/Motion motion
""",
    "play_motion2_msgs/srv/AddMotion": """
play_motion2_msgs/Motion motion
bool overwrite
---
bool success
""",
    "play_motion2_msgs/srv/RemoveMotion": """
string motion_key
---
bool success
""",
    "play_motion_msgs/srv/ListMotions": """
---
play_motion_msgs/MotionInfo[] motions
""",
    "play_motion_msgs/srv/IsAlreadyThere": """
string motion_name
float32 tolerance
---
bool already_there
""",
}

ACTIONS: dict[str, str] = {
    "play_motion2_msgs/action/PlayMotion2": """
string motion_name
bool skip_planning
---
bool success
string error
---
builtin_interfaces/Time current_time
""",
    "play_motion2_msgs/action/PlayMotion2Raw": """
play_motion2_msgs/Motion motion
bool skip_planning
---
bool success
string error
---
builtin_interfaces/Time current_time
""",
    "play_motion_msgs/action/PlayMotion": """
string motion_name
bool skip_planning
int32 priority
---
int32 SUCCEEDED=1
int32 MOTION_NOT_FOUND=-1
int32 CONTROLLER_BUSY=-3
int32 MISSING_CONTROLLER=-4
int32 TRAJECTORY_ERROR=-5
int32 GOAL_NOT_REACHED=-6
int32 PLANNER_OFFLINE=-7
int32 NO_PLAN_FOUND=-8
int32 OTHER_ERROR=-42
int32 error_code
string error_string
---
""",
}

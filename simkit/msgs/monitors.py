"""Messages of monitors that have no twin in ROS."""

from __future__ import annotations

from typing import Final

STATUS: Final = "simkit_msgs/msg/PerformerStatus"

MESSAGES: dict[str, str] = {
    STATUS: """
std_msgs/Header header
string name
geometry_msgs/Pose pose
bool state
uint32 count
string[] keys
string[] values
""",
}

"""Conversions between types with the same content, and frames in the manner of ROS."""

from __future__ import annotations

import pytest

from simkit import msgs
from simkit.msgs.type_conversions import conversion, with_ros_frames

G = "geometry_msgs/msg/"


@pytest.mark.parametrize(
    ("source", "target"),
    [
        ("Twist", "TwistStamped"),
        ("Wrench", "WrenchStamped"),
        ("Pose", "PoseStamped"),
        ("Pose", "Transform"),
        ("Pose", "TransformStamped"),
        ("PoseStamped", "TransformStamped"),
        ("Point", "Vector3"),
        ("Vector3Stamped", "Point"),
        ("PoseWithCovariance", "PoseWithCovarianceStamped"),
        ("TwistWithCovariance", "TwistWithCovarianceStamped"),
    ],
)
def test_types_with_the_same_content_are_converted_in_both_directions(source: str, target: str) -> None:
    forth, back = conversion(G + source, G + target), conversion(G + target, G + source)
    assert forth is not None
    message = forth(msgs.make(G + source), 2_000_000_000)
    assert message.__msgtype__ == G + target
    if not source.endswith("Stamped") and target.endswith("Stamped"):
        assert message.header.stamp.sec == 2
    if back is not None:
        assert back(message, 0).__msgtype__ == G + source


def test_numbers_are_kept() -> None:
    stamped = msgs.make(G + "TransformStamped", header=msgs.header(1, "map"), transform={"translation": {"x": 3.0}})
    convert = conversion(G + "TransformStamped", G + "PoseStamped")
    assert convert is not None
    pose = convert(stamped, 0)
    assert (pose.header.frame_id, pose.pose.position.x, pose.pose.orientation.w) == ("map", 3.0, 1.0)


@pytest.mark.parametrize(
    ("source", "target"), [("Twist", "Pose"), ("TwistWithCovariance", "Twist"), ("Twist", "Wrench")]
)
def test_other_types_are_not_converted(source: str, target: str) -> None:
    assert conversion(G + source, G + target) is None


def test_frames_of_gazebo_get_slashes() -> None:
    transform = msgs.make(G + "TransformStamped", header=msgs.header(0, "a::b"), child_frame_id="a::c")
    message = with_ros_frames(msgs.make("tf2_msgs/msg/TFMessage", transforms=[transform]))
    assert (message.transforms[0].header.frame_id, message.transforms[0].child_frame_id) == ("a/b", "a/c")
    assert with_ros_frames(message) is message
    assert transform.header.frame_id == "a::b"

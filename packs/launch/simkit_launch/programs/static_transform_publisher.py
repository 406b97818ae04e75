"""`static_transform_publisher` of tf2_ros and tf: a fixed transform between two frames."""

from __future__ import annotations

import argparse
import sys
from contextlib import suppress

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from tf2_ros import StaticTransformBroadcaster
from tf_transformations import quaternion_from_euler

_USAGE = (
    "usage: static_transform_publisher --x X --y Y --z Z --yaw YAW --pitch PITCH --roll ROLL --frame-id FRAME "
    "--child-frame-id FRAME, or X Y Z YAW PITCH ROLL FRAME CHILD, or X Y Z QX QY QZ QW FRAME CHILD"
)


def _old_values(words: list[str]) -> tuple[list[float], str, str] | None:
    """Return numbers, frame and child frame of arguments without names; None for others.

    A last number is the period of ROS 1's tf [ms], which a fixed transform does not need.
    """
    if len(words) in (9, 10) and _is_number(words[-1]):
        words = words[:-1]
    if len(words) not in (8, 9) or not all(map(_is_number, words[:-2])):
        return None
    return [float(word) for word in words[:-2]], words[-2], words[-1]


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _named_values(words: list[str]) -> tuple[list[float], str, str]:
    parser = argparse.ArgumentParser(prog="static_transform_publisher", usage=_USAGE, allow_abbrev=False)
    names = ("x", "y", "z", "qx", "qy", "qz", "qw", "roll", "pitch", "yaw")
    for name in names:
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--frame-id", required=True)
    parser.add_argument("--child-frame-id", required=True)
    given = parser.parse_args(words)
    values = {name: getattr(given, name) for name in names}
    place = [values[name] or 0.0 for name in ("x", "y", "z")]
    if any(values[name] is not None for name in ("qx", "qy", "qz", "qw")):
        turn = [values[name] or 0.0 for name in ("qx", "qy", "qz")]
        turn.append(1.0 if values["qw"] is None else values["qw"])
        return [*place, *turn], given.frame_id, given.child_frame_id
    return [*place, *(values[name] or 0.0 for name in ("yaw", "pitch", "roll"))], given.frame_id, given.child_frame_id


def _values_of_parameters(node: Node) -> tuple[list[float], str, str] | None:
    """Return numbers, frame and child frame of the parameters of a component; None without these."""
    names = ("translation.x", "translation.y", "translation.z")
    names += ("rotation.x", "rotation.y", "rotation.z", "rotation.w")
    numbers = [float(node.declare_parameter(name, float(name == "rotation.w")).value) for name in names]
    frame, child = (str(node.declare_parameter(name, "").value) for name in ("frame_id", "child_frame_id"))
    return (numbers, frame, child) if frame and child else None


def main() -> int:
    """Publish the transform until the end of the run; return the exit code."""
    rclpy.init(args=sys.argv)
    words = [word for word in remove_ros_args(sys.argv)[1:] if not word.startswith("__")]
    node = rclpy.create_node("static_transform_publisher")
    old = _old_values(words)
    numbers, frame, child = old or (None if words else _values_of_parameters(node)) or _named_values(words)
    log = node.get_logger()
    if old is not None:
        log.warn("Old-style arguments are deprecated; see --help for new-style arguments")
    if frame == child:
        log.error(f"cannot publish static transform from '{frame}' to '{child}', exiting")
        return 1
    quaternion = numbers[3:] if len(numbers) == 7 else quaternion_from_euler(*reversed(numbers[3:]))
    message = TransformStamped()
    message.header.stamp = node.get_clock().now().to_msg()
    message.header.frame_id, message.child_frame_id = frame, child
    place, turn = message.transform.translation, message.transform.rotation
    place.x, place.y, place.z = numbers[:3]
    turn.x, turn.y, turn.z, turn.w = map(float, quaternion)
    StaticTransformBroadcaster(node).sendTransform(message)
    first = ", ".join(f"'{number:f}'" for number in numbers[:3])
    second = ", ".join(f"'{number:f}'" for number in quaternion)
    log.info(
        "Spinning until stopped - publishing transform\n"
        f"translation: ({first})\nrotation: ({second})\nfrom '{frame}' to '{child}'"
    )
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Which ROS type a message of gz.msgs is on simkit's topics, and how the one becomes the other.

As in the bridge between Gazebo and ROS; where it knows several, the first is what a publisher here announces.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from simkit import msgs
from simkit.errors import MessageError
from simkit.gzpython.msgs.message import CLASSES, Message

FRAME: Final = "frame_id"


@dataclass(frozen=True, slots=True)
class Twin:
    """A ROS type that a message of gz is.

    Attributes:
        ros: its name.
        to_ros: fields for `simkit.msgs.make` of a message of gz.
        from_ros: fills a message of gz from one of ROS.
    """

    ros: str
    to_ros: Callable[[Any], dict[str, Any]]
    from_ros: Callable[[Any, Any], None]


def _copy(*names: str) -> tuple[Callable[[Any], dict[str, Any]], Callable[[Any, Any], None]]:
    """Fields of the same name and plain kind on both sides."""

    def to_ros(gz: Any) -> dict[str, Any]:
        return {name: getattr(gz, name) for name in names}

    def from_ros(gz: Any, ros: Any) -> None:
        for name in names:
            setattr(gz, name, getattr(ros, name))

    return to_ros, from_ros


_data_to, _data_from = _copy("data")
_xyz_to, _xyz_from = _copy("x", "y", "z")
_xyzw_to, _xyzw_from = _copy("x", "y", "z", "w")
_rgba_to, _rgba_from = _copy("r", "g", "b", "a")


def _quaternion_to(gz: Any) -> dict[str, Any]:
    """One of zeros, which is what a new message has, means no rotation."""
    values = _xyzw_to(gz)
    return values if any(values.values()) else {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}


def _time_to(gz: Any) -> dict[str, Any]:
    return {"sec": gz.sec, "nanosec": gz.nsec}


def _time_from(gz: Any, ros: Any) -> None:
    gz.sec, gz.nsec = int(ros.sec), int(ros.nanosec)


def _header_to(gz: Any) -> dict[str, Any]:
    frame = next((entry.value[0] for entry in gz.data if entry.key == FRAME and entry.value), "")
    return {"stamp": _time_to(gz.stamp), "frame_id": frame}


def _header_from(gz: Any, ros: Any) -> None:
    _time_from(gz.stamp, ros.stamp)
    if ros.frame_id:
        gz.data.add(key=FRAME, value=[ros.frame_id])


def _pose_to(gz: Any) -> dict[str, Any]:
    return {"position": _xyz_to(gz.position), "orientation": _quaternion_to(gz.orientation)}


def _pose_from(gz: Any, ros: Any) -> None:
    _xyz_from(gz.position, ros.position)
    _xyzw_from(gz.orientation, ros.orientation)


def _twist_to(gz: Any) -> dict[str, Any]:
    return {"linear": _xyz_to(gz.linear), "angular": _xyz_to(gz.angular)}


def _twist_from(gz: Any, ros: Any) -> None:
    _xyz_from(gz.linear, ros.linear)
    _xyz_from(gz.angular, ros.angular)


def _wrench_to(gz: Any) -> dict[str, Any]:
    return {"force": _xyz_to(gz.force), "torque": _xyz_to(gz.torque)}


def _wrench_from(gz: Any, ros: Any) -> None:
    _xyz_from(gz.force, ros.force)
    _xyz_from(gz.torque, ros.torque)


def _stamped(
    part: str, to_ros: Callable[[Any], dict[str, Any]], from_ros: Callable[[Any, Any], None]
) -> tuple[Callable[[Any], dict[str, Any]], Callable[[Any, Any], None]]:
    """The same with ROS's header around it."""

    def to_stamped(gz: Any) -> dict[str, Any]:
        return {"header": _header_to(gz.header), part: to_ros(gz)}

    def from_stamped(gz: Any, ros: Any) -> None:
        _header_from(gz.header, ros.header)
        from_ros(gz, getattr(ros, part))

    return to_stamped, from_stamped


def _clock_to(gz: Any) -> dict[str, Any]:
    return {"clock": _time_to(gz.sim)}


def _clock_from(gz: Any, ros: Any) -> None:
    _time_from(gz.sim, ros.clock)


def _odometry_to(gz: Any) -> dict[str, Any]:
    header = _header_to(gz.header)
    child = next((entry.value[0] for entry in gz.header.data if entry.key == "child_frame_id" and entry.value), "")
    pose, twist = {"pose": _pose_to(gz.pose)}, {"twist": _twist_to(gz.twist)}
    return {"header": header, "child_frame_id": child, "pose": pose, "twist": twist}


def _odometry_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    if ros.child_frame_id:
        gz.header.data.add(key="child_frame_id", value=[ros.child_frame_id])
    _pose_from(gz.pose, ros.pose.pose)
    _twist_from(gz.twist, ros.twist.twist)


def _imu_to(gz: Any) -> dict[str, Any]:
    return {
        "header": _header_to(gz.header),
        "orientation": _quaternion_to(gz.orientation),
        "angular_velocity": _xyz_to(gz.angular_velocity),
        "linear_acceleration": _xyz_to(gz.linear_acceleration),
    }


def _imu_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    gz.entity_name = ros.header.frame_id
    _xyzw_from(gz.orientation, ros.orientation)
    _xyz_from(gz.angular_velocity, ros.angular_velocity)
    _xyz_from(gz.linear_acceleration, ros.linear_acceleration)


def _scan_to(gz: Any) -> dict[str, Any]:
    return {
        "header": _header_to(gz.header),
        "angle_min": gz.angle_min,
        "angle_max": gz.angle_max,
        "angle_increment": gz.angle_step,
        "range_min": gz.range_min,
        "range_max": gz.range_max,
        "ranges": list(gz.ranges),
        "intensities": list(gz.intensities),
    }


def _scan_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    gz.frame = ros.header.frame_id
    gz.angle_min, gz.angle_max, gz.angle_step = ros.angle_min, ros.angle_max, ros.angle_increment
    gz.range_min, gz.range_max = ros.range_min, ros.range_max
    gz.ranges.extend(ros.ranges.tolist())
    gz.intensities.extend(ros.intensities.tolist())
    gz.count, gz.vertical_count = len(gz.ranges), 1


def _navsat_to(gz: Any) -> dict[str, Any]:
    place = {"latitude": gz.latitude_deg, "longitude": gz.longitude_deg, "altitude": gz.altitude}
    return {"header": _header_to(gz.header), **place}


def _navsat_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    gz.frame_id = ros.header.frame_id
    gz.latitude_deg, gz.longitude_deg, gz.altitude = ros.latitude, ros.longitude, ros.altitude


def _magnetometer_to(gz: Any) -> dict[str, Any]:
    return {"header": _header_to(gz.header), "magnetic_field": _xyz_to(gz.field_tesla)}


def _magnetometer_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    _xyz_from(gz.field_tesla, ros.magnetic_field)


def _pressure_to(gz: Any) -> dict[str, Any]:
    return {"header": _header_to(gz.header), "fluid_pressure": gz.pressure, "variance": gz.variance}


def _pressure_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    gz.pressure, gz.variance = ros.fluid_pressure, ros.variance


def _joints_to(gz: Any) -> dict[str, Any]:
    return {
        "header": _header_to(gz.header),
        "name": [joint.name for joint in gz.joint],
        "position": [joint.axis1.position for joint in gz.joint],
        "velocity": [joint.axis1.velocity for joint in gz.joint],
        "effort": [joint.axis1.force for joint in gz.joint],
    }


def _joints_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    for place, name in enumerate(ros.name):
        axis = gz.joint.add(name=name).axis1
        for ours, theirs in (("position", ros.position), ("velocity", ros.velocity), ("force", ros.effort)):
            setattr(axis, ours, float(theirs[place]) if place < len(theirs) else math.nan)


def _actuators_to(gz: Any) -> dict[str, Any]:
    parts = {name: list(getattr(gz, name)) for name in ("position", "velocity", "normalized")}
    return {"header": _header_to(gz.header), **parts}


def _actuators_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    for name in ("position", "velocity", "normalized"):
        getattr(gz, name).extend(getattr(ros, name).tolist())


def _frames_to(gz: Any) -> dict[str, Any]:
    transforms = []
    for pose in gz.pose:
        header = _header_to(pose.header if pose.HasField("header") else gz.header)
        turn = {"translation": _xyz_to(pose.position), "rotation": _quaternion_to(pose.orientation)}
        transforms.append({"header": header, "child_frame_id": pose.name, "transform": turn})
    return {"transforms": transforms}


def _frames_from(gz: Any, ros: Any) -> None:
    for transform in ros.transforms:
        pose = gz.pose.add(name=transform.child_frame_id)
        _header_from(pose.header, transform.header)
        _xyz_from(pose.position, transform.transform.translation)
        _xyzw_from(pose.orientation, transform.transform.rotation)
    if ros.transforms:
        _header_from(gz.header, ros.transforms[0].header)


def _planar_to(gz: Any) -> dict[str, Any]:
    return {"x": gz.x, "y": gz.y, "z": 0.0}


def _planar_from(gz: Any, ros: Any) -> None:
    gz.x, gz.y = ros.x, ros.y


def _list_to(gz: Any) -> dict[str, Any]:
    return {"data": list(gz.data)}


def _list_from(gz: Any, ros: Any) -> None:
    gz.data.extend(ros.data.tolist())


def _entity_to(gz: Any) -> dict[str, Any]:
    return {name: getattr(gz, name) for name in ("id", "name", "type")}


def _entity_from(gz: Any, ros: Any) -> None:
    gz.id, gz.name, gz.type = int(ros.id), ros.name, int(ros.type)


def _entity_wrench_to(gz: Any) -> dict[str, Any]:
    return {"header": _header_to(gz.header), "entity": _entity_to(gz.entity), "wrench": _wrench_to(gz.wrench)}


def _entity_wrench_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    _entity_from(gz.entity, ros.entity)
    _wrench_from(gz.wrench, ros.wrench)


_PIXELS: Final = {"mono8": 1, "mono16": 2, "rgb8": 3, "rgba8": 4, "bgra8": 5, "rgb16": 6, "bgr8": 8, "32FC1": 13}
"""Encoding of ROS -> number of gz's pixel format."""


def _image_to(gz: Any) -> dict[str, Any]:
    encoding = next((name for name, number in _PIXELS.items() if number == gz.pixel_format_type), "")
    size = {"width": gz.width, "height": gz.height, "step": gz.step}
    return {"header": _header_to(gz.header), **size, "encoding": encoding, "data": np.frombuffer(gz.data, np.uint8)}


def _image_from(gz: Any, ros: Any) -> None:
    _header_from(gz.header, ros.header)
    gz.width, gz.height, gz.step = int(ros.width), int(ros.height), int(ros.step)
    gz.pixel_format_type, gz.data = _PIXELS.get(ros.encoding, 0), np.asarray(ros.data).tobytes()


_POSE_STAMPED = _stamped("pose", _pose_to, _pose_from)
_TWINS: Final[dict[str, tuple[Twin, ...]]] = {
    "Boolean": (Twin("std_msgs/msg/Bool", _data_to, _data_from),),
    "Double": (Twin("std_msgs/msg/Float64", _data_to, _data_from),),
    "Float": (Twin("std_msgs/msg/Float32", _data_to, _data_from),),
    "Int32": (Twin("std_msgs/msg/Int32", _data_to, _data_from),),
    "UInt32": (Twin("std_msgs/msg/UInt32", _data_to, _data_from),),
    "StringMsg": (Twin("std_msgs/msg/String", _data_to, _data_from),),
    "Empty": (Twin("std_msgs/msg/Empty", lambda _: {}, lambda *_: None),),
    "Header": (Twin("std_msgs/msg/Header", _header_to, _header_from),),
    "Color": (Twin("std_msgs/msg/ColorRGBA", _rgba_to, _rgba_from),),
    "Vector3d": (
        Twin("geometry_msgs/msg/Vector3", _xyz_to, _xyz_from),
        Twin("geometry_msgs/msg/Point", _xyz_to, _xyz_from),
    ),
    "Vector2d": (Twin("geometry_msgs/msg/Vector3", _planar_to, _planar_from),),
    "Float_V": (Twin("ros_gz_interfaces/msg/Float32Array", _list_to, _list_from),),
    "Double_V": (Twin("std_msgs/msg/Float64MultiArray", _list_to, _list_from),),
    "Int64": (Twin("std_msgs/msg/Int64", _data_to, _data_from),),
    "Entity": (Twin("ros_gz_interfaces/msg/Entity", _entity_to, _entity_from),),
    "EntityWrench": (Twin("ros_gz_interfaces/msg/EntityWrench", _entity_wrench_to, _entity_wrench_from),),
    "Image": (Twin("sensor_msgs/msg/Image", _image_to, _image_from),),
    "Quaternion": (Twin("geometry_msgs/msg/Quaternion", _quaternion_to, _xyzw_from),),
    "Pose": (
        Twin("geometry_msgs/msg/PoseStamped", *_POSE_STAMPED),
        Twin("geometry_msgs/msg/Pose", _pose_to, _pose_from),
    ),
    "Pose_V": (Twin("tf2_msgs/msg/TFMessage", _frames_to, _frames_from),),
    "Twist": (
        Twin("geometry_msgs/msg/Twist", _twist_to, _twist_from),
        Twin("geometry_msgs/msg/TwistStamped", *_stamped("twist", _twist_to, _twist_from)),
    ),
    "Wrench": (
        Twin("geometry_msgs/msg/Wrench", _wrench_to, _wrench_from),
        Twin("geometry_msgs/msg/WrenchStamped", *_stamped("wrench", _wrench_to, _wrench_from)),
    ),
    "Clock": (Twin("rosgraph_msgs/msg/Clock", _clock_to, _clock_from),),
    "Odometry": (Twin("nav_msgs/msg/Odometry", _odometry_to, _odometry_from),),
    "IMU": (Twin("sensor_msgs/msg/Imu", _imu_to, _imu_from),),
    "LaserScan": (Twin("sensor_msgs/msg/LaserScan", _scan_to, _scan_from),),
    "NavSat": (Twin("sensor_msgs/msg/NavSatFix", _navsat_to, _navsat_from),),
    "Magnetometer": (Twin("sensor_msgs/msg/MagneticField", _magnetometer_to, _magnetometer_from),),
    "FluidPressure": (Twin("sensor_msgs/msg/FluidPressure", _pressure_to, _pressure_from),),
    "Model": (Twin("sensor_msgs/msg/JointState", _joints_to, _joints_from),),
    "Actuators": (Twin("actuator_msgs/msg/Actuators", _actuators_to, _actuators_from),),
}


def twins_of(kind: type[Message]) -> tuple[Twin, ...]:
    """The ROS types of a message class.

    Raises:
        MessageError: it has none.
    """
    found = _TWINS.get(kind.__name__)
    if found is None:
        listed = ", ".join(sorted(_TWINS))
        raise MessageError(f"gz.msgs.{kind.__name__} has no ROS type to go on a topic as; those that have: {listed}")
    return found


def to_ros(message: Message, ros: str) -> Any:
    """A message of a ROS type."""
    twin = next(twin for twin in twins_of(type(message)) if twin.ros == ros)
    return msgs.make(ros, **twin.to_ros(message))


def from_ros(kind: type[Message], message: Any) -> Message:
    """A message of gz of one of ROS, whose type must be a twin of it."""
    name, made = msgs.type_name(message), CLASSES[kind.__name__]()
    twin = next(twin for twin in twins_of(kind) if twin.ros == name)
    twin.from_ros(made, message)
    return made

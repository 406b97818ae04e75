"""Conversion between gz.msgs and ROS messages, and calls of the simulation's services with gz messages."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from simkit import msgs
from simkit.errors import InputError, MessageError
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, PLAIN_DEFAULTS, FieldValue, Message

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Header, Image, JointState, LaserScan, Odometry, ParamVec, Quaternion, TFMessage

RosFields: TypeAlias = dict[str, FieldValue]
"""Fields of a ROS message by name, as `simkit.msgs.make` expects them."""


@dataclass(frozen=True, slots=True)
class RosTwin:
    """ROS type that corresponds to a message of gz.

    Attributes:
        ros: name of the ROS type.
        to_ros: function from a gz message to the fields for `simkit.msgs.make`.
        from_ros: function that fills a gz message from a ROS message.
        is_wrapped: true if the ROS type contains the message next to further fields, such as a header. The type is then
            not used for a gz message inside another message.
    """

    ros: str
    to_ros: Callable[[Message], RosFields]
    from_ros: Callable[[Message, FieldValue], None]
    is_wrapped: bool = False


# ---------------------------------------------------------------------- conversion by field


def _twin_by_fields(name: str, ros: str, fields: list[str]) -> RosTwin:
    """Create the conversion to a ROS type from the fields in a line of the conversion table."""
    pairs = []
    for field in fields:
        gz_name, _, ros_name = field.replace("<", "=").partition("=")
        kind = name if gz_name == "." else MESSAGE_CLASSES[name].FIELDS[gz_name]
        pairs.append((gz_name, tuple((ros_name or gz_name).split(".")), kind, "<" in field))

    def to_ros(gz: Message) -> RosFields:
        ros_fields: RosFields = {}
        for gz_name, (*outer, last), kind, is_read_only in pairs:
            if not is_read_only:
                target = ros_fields
                for part in outer:
                    target = target.setdefault(part, {})
                target[last] = _value_to_ros(kind, gz if gz_name == "." else getattr(gz, gz_name))
        return ros_fields

    def from_ros(gz: Message, message: object) -> None:
        for gz_name, path, kind, _ in pairs:
            value = message
            for part in path:
                value = getattr(value, part)
            if gz_name == ".":
                _twin_of_field(kind).from_ros(gz, value)
            else:
                _value_from_ros(gz, gz_name, kind, value)

    return RosTwin(ros, to_ros, from_ros, is_wrapped="." in (gz_name for gz_name, *_ in pairs))


@cache
def _twin_of_field(kind: str) -> RosTwin:
    """Return the ROS type for a gz message that is a field of another message."""
    return next(twin for twin in _all_twins()[kind] if not twin.is_wrapped)


def _value_to_ros(kind: str, value: FieldValue) -> object:
    if kind in PLAIN_DEFAULTS:
        return value
    if not kind.endswith("[]"):
        return _twin_of_field(kind).to_ros(value)
    return list(value) if kind[:-2] in PLAIN_DEFAULTS else [_value_to_ros(kind[:-2], item) for item in value]


def _value_from_ros(gz: Message, gz_name: str, kind: str, value: FieldValue) -> None:
    if kind in PLAIN_DEFAULTS:
        setattr(gz, gz_name, value)
    elif not kind.endswith("[]"):
        _twin_of_field(kind).from_ros(getattr(gz, gz_name), value)
    elif kind[:-2] in PLAIN_DEFAULTS:
        getattr(gz, gz_name).extend(np.asarray(value).tolist())
    else:
        for item in value:
            _twin_of_field(kind[:-2]).from_ros(getattr(gz, gz_name).add(), item)


# ---------------------------------------------------------------------- conversion by function


def _header_entry(header: Message, key: str) -> str:
    """Return the text of a header entry, such as `frame_id`; empty if the header does not have it."""
    return next((str(entry.value[0]) for entry in header.data if entry.key == key and entry.value), "")


def _header_to(gz: Message) -> RosFields:
    return {"stamp": _value_to_ros("Time", gz.stamp), "frame_id": _header_entry(gz, "frame_id")}


def _header_from(gz: Message, ros: Header) -> None:
    _value_from_ros(gz, "stamp", "Time", ros.stamp)
    if ros.frame_id:
        gz.data.add(key="frame_id", value=[ros.frame_id])


def _quaternion_to(gz: Message) -> RosFields:
    """Convert a quaternion; four zeros, the default of a new gz message, become the identity."""
    values = {axis: getattr(gz, axis) for axis in "xyzw"}
    return values if any(values.values()) else {**values, "w": 1.0}


def _quaternion_from(gz: Message, ros: Quaternion) -> None:
    gz.x, gz.y, gz.z, gz.w = ros.x, ros.y, ros.z, ros.w


def _odometry_to(gz: Message) -> RosFields:
    return {**_plain_twin("Odometry").to_ros(gz), "child_frame_id": _header_entry(gz.header, "child_frame_id")}


def _odometry_from(gz: Message, ros: Odometry) -> None:
    _plain_twin("Odometry").from_ros(gz, ros)
    if ros.child_frame_id:
        gz.header.data.add(key="child_frame_id", value=[ros.child_frame_id])


def _scan_from(gz: Message, ros: LaserScan) -> None:
    _plain_twin("LaserScan").from_ros(gz, ros)
    gz.count, gz.vertical_count = len(gz.ranges), 1


_AXIS: Final = {"position": "position", "velocity": "velocity", "force": "effort"}
"""Field of a ROS JointState for each field of the axis in a gz joint."""


def _joints_to(gz: Message) -> RosFields:
    columns = {ros_name: [getattr(joint.axis1, gz_name) for joint in gz.joint] for gz_name, ros_name in _AXIS.items()}
    return {"header": _header_to(gz.header), "name": [joint.name for joint in gz.joint], **columns}


def _joints_from(gz: Message, ros: JointState) -> None:
    _header_from(gz.header, ros.header)
    for index, name in enumerate(ros.name):
        axis = gz.joint.add(name=name).axis1
        for gz_name, ros_name in _AXIS.items():
            column = getattr(ros, ros_name)
            setattr(axis, gz_name, float(column[index]) if index < len(column) else math.nan)


def _frames_to(gz: Message) -> RosFields:
    transforms = []
    for pose in gz.pose:
        header = _header_to(pose.header if pose.HasField("header") else gz.header)
        transform = {
            "translation": _value_to_ros("Vector3d", pose.position),
            "rotation": _quaternion_to(pose.orientation),
        }
        transforms.append({"header": header, "child_frame_id": pose.name, "transform": transform})
    return {"transforms": transforms}


def _frames_from(gz: Message, ros: TFMessage) -> None:
    for transform in ros.transforms:
        pose = gz.pose.add(name=transform.child_frame_id)
        _header_from(pose.header, transform.header)
        _value_from_ros(pose, "position", "Vector3d", transform.transform.translation)
        _quaternion_from(pose.orientation, transform.transform.rotation)
    if ros.transforms:
        _header_from(gz.header, ros.transforms[0].header)


_PIXELS: Final = {"mono8": 1, "mono16": 2, "rgb8": 3, "rgba8": 4, "bgra8": 5, "rgb16": 6, "bgr8": 8, "32FC1": 13}
"""Number of gz's pixel format for each encoding of ROS."""


def _image_to(gz: Message) -> RosFields:
    encoding = next((name for name, number in _PIXELS.items() if number == gz.pixel_format_type), "")
    size = {"width": gz.width, "height": gz.height, "step": gz.step}
    return {"header": _header_to(gz.header), **size, "encoding": encoding, "data": np.frombuffer(gz.data, np.uint8)}


def _image_from(gz: Message, ros: Image) -> None:
    _header_from(gz.header, ros.header)
    gz.width, gz.height, gz.step = int(ros.width), int(ros.height), int(ros.step)
    gz.pixel_format_type, gz.data = _PIXELS.get(ros.encoding, 0), np.asarray(ros.data).tobytes()


# fields of gz.msgs.Any and of rcl_interfaces/msg/ParameterValue, with the number of the type in each
_PARAMETERS: Final = (
    ("bool_value", "bool_value", 4, 1),
    ("int_value", "integer_value", 2, 2),
    ("double_value", "double_value", 1, 3),
    ("string_value", "string_value", 3, 4),
)
_VECTOR, _DOUBLES = 5, 8  # a gz vector is an array of doubles in ROS


def _parameters_to(gz: Message) -> RosFields:
    return {"header": _header_to(gz.header), "params": [_parameter_to(entry) for entry in gz.params]}


def _parameter_to(entry: Message) -> RosFields:
    value = entry.value
    if value.type == _VECTOR:
        vector = value.vector3d_value
        return {
            "name": entry.key,
            "value": {"type": _DOUBLES, "double_array_value": np.array([vector.x, vector.y, vector.z], float)},
        }
    for gz_name, ros_name, gz_type, ros_type in _PARAMETERS:
        if value.type == gz_type:
            return {"name": entry.key, "value": {"type": ros_type, ros_name: getattr(value, gz_name)}}
    raise MessageError(
        f"parameter {entry.key!r} has the type {value.type}; expected BOOLEAN, INT32, DOUBLE, STRING or VECTOR3D"
    )


def _parameters_from(gz: Message, ros: ParamVec) -> None:
    _header_from(gz.header, ros.header)
    for parameter in ros.params:
        value = gz.params.add(key=parameter.name).value
        if parameter.value.type == _DOUBLES:
            value.type = _VECTOR
            for name, number in zip("xyz", parameter.value.double_array_value, strict=False):
                setattr(value.vector3d_value, name, float(number))
        for gz_name, ros_name, gz_type, ros_type in _PARAMETERS:
            if parameter.value.type == ros_type:
                value.type = gz_type
                setattr(value, gz_name, getattr(parameter.value, ros_name))


# ---------------------------------------------------------------------- the table


@cache
def _twins_by_fields() -> dict[str, tuple[RosTwin, ...]]:
    twins: dict[str, tuple[RosTwin, ...]] = {}
    for line in Path(__file__).with_name("ros_types.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            name, ros, *fields = line.split()
            twins[name] = (*twins.get(name, ()), _twin_by_fields(name, ros, fields))
    return twins


def _plain_twin(name: str) -> RosTwin:
    return _twins_by_fields()[name][0]


@cache
def _all_twins() -> dict[str, tuple[RosTwin, ...]]:
    scan, odometry = _plain_twin("LaserScan"), _plain_twin("Odometry")
    return {
        **_twins_by_fields(),
        "Header": (RosTwin("std_msgs/msg/Header", _header_to, _header_from),),
        "Quaternion": (RosTwin("geometry_msgs/msg/Quaternion", _quaternion_to, _quaternion_from),),
        "Odometry": (RosTwin(odometry.ros, _odometry_to, _odometry_from),),
        "LaserScan": (RosTwin(scan.ros, scan.to_ros, _scan_from),),
        "Model": (RosTwin("sensor_msgs/msg/JointState", _joints_to, _joints_from),),
        "Pose_V": (RosTwin("tf2_msgs/msg/TFMessage", _frames_to, _frames_from),),
        "Image": (RosTwin("sensor_msgs/msg/Image", _image_to, _image_from),),
        "Param": (RosTwin("ros_gz_interfaces/msg/ParamVec", _parameters_to, _parameters_from),),
    }


def twins_of(kind: type[Message]) -> tuple[RosTwin, ...]:
    """Return the ROS types to which a gz message class can be converted.

    Raises:
        MessageError: no ROS type corresponds to the class.
    """
    twins = _all_twins().get(kind.__name__)
    if twins is None:
        listed = ", ".join(sorted(_all_twins()))
        raise MessageError(f"gz.msgs.{kind.__name__} is not supported on topics; supported messages: {listed}")
    return twins


def fields_of(message: Message) -> RosFields:
    """Return the fields of the ROS message for a gz message that is a field of another message."""
    return _twin_of_field(type(message).__name__).to_ros(message)


def to_ros(message: Message, ros: str) -> object:
    """Convert a gz message to a ROS message of the type `ros`."""
    twin = next(twin for twin in twins_of(type(message)) if twin.ros == ros)
    return msgs.make(ros, **twin.to_ros(message))


def from_ros(kind: type[Message], message: object) -> Message:
    """Convert a ROS message to a gz message; the ROS type must be one of `twins_of(kind)`."""
    name, gz = msgs.type_name(message), MESSAGE_CLASSES[kind.__name__]()
    twin = next(twin for twin in twins_of(kind) if twin.ros == name)
    twin.from_ros(gz, message)
    return gz


SERVICE_REQUEST_TYPES: Final = ("WorldControl", "EntityFactory", "Entity", "Pose", "Boolean", "Empty")
"""Message classes that a service request may have."""


def call_service(sim: Simulation, service: str, request: Message, response_kind: type[Message]) -> tuple[bool, Message]:
    """Call a service of the simulation with a gz message.

    Returns:
        A flag and the response. The flag is true if the service exists and accepted the request. A Boolean response is
        true if the service succeeded.
    """
    response = response_kind()
    if service not in sim.communication.services.names():
        return False, response
    try:
        answer = sim.call(service, _request_fields(request))
    except InputError:
        return False, response
    succeeded = bool(getattr(answer, "success", True))
    if "data" in response_kind.FIELDS and response_kind.FIELDS["data"] == "b":
        response.data = succeeded
    return True, response


def _request_fields(request: Message) -> RosFields:
    """Return the fields of the corresponding ROS request.

    Raises:
        InputError: no service of simkit accepts this class of messages.
    """
    kind = type(request).__name__
    if kind == "WorldControl":
        reset = {name: getattr(request.reset, name) for name in ("all", "time_only", "model_only")}
        control = {name: getattr(request, name) for name in ("pause", "step", "multi_step", "seed")}
        until = {"sec": request.run_to_sim_time.sec, "nanosec": request.run_to_sim_time.nsec}
        return {"world_control": {**control, "reset": reset, "run_to_sim_time": until}}
    if kind == "EntityFactory":
        names = ("name", "allow_renaming", "sdf", "sdf_filename", "clone_name")
        plain = {name: getattr(request, name) for name in names}
        return {"entity_factory": {**plain, "pose": fields_of(request.pose)}}
    if kind == "Entity":
        return {"entity": {name: getattr(request, name) for name in ("id", "name", "type")}}
    if kind == "Pose":
        return {"entity": {"name": request.name, "id": request.id, "type": 2}, "pose": fields_of(request)}
    if kind == "Boolean":
        return {"data": request.data}
    if kind == "Empty":
        return {}
    raise InputError(f"simkit has no service for requests of type gz.msgs.{kind}")

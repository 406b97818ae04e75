"""Components of gz-sim: a fixed set that simkit supports, and custom components that a system registers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from enum import IntEnum
from typing import Any, Final

from simkit.extend import SharedByCopies
from simkit_gz_python.math.inertia import Inertiald as _Inertiald
from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.math.pose import Pose3d as _Pose3d
from simkit_gz_python.math.simkit_conversion import simkit_pose, three_numbers
from simkit_gz_python.math.vectors import Vector3d as _Vector3d
from simkit_gz_python.sim.entity_table import EntityRecord
from simkit_gz_python.sim.entity_view import EntityView
from simkit_gz_python.sim.joint import Joint as _Joint
from simkit_gz_python.sim.link import Link as _Link
from simkit_gz_python.sim.model import Model as _Model
from simkit_gz_python.sim.sensors_lights_actors import Sensor as _Sensor
from simkit_gz_python.sim.world import World as _World
from simkit_gz_python.sim.world import world_pose


class ComponentState(IntEnum):
    """Kinds of changes of a component. They exist for gz-sim's interface and have no effect in simkit."""

    NoChange = 0
    PeriodicChange = 1
    OneTimeChange = 2


class ComponentProxy(SharedByCopies):
    """Kind of component, such as `components.Pose`.

    Attributes:
        name: name in gz-sim, such as `Pose`.
        type_id: number that only this kind has, the same in every run.
    """

    __slots__ = ("name", "type_id")

    def __init__(self, name: str) -> None:
        self.name, self.type_id = name, _hash64(f"gz_sim_components.{name}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ComponentProxy) and other.name == self.name

    def __hash__(self) -> int:
        return hash(self.name)

    def __repr__(self) -> str:
        return f"<gz.sim.components.{self.name}>"


def _hash64(text: str) -> int:
    """Return the 64-bit FNV-1a hash."""
    digest = 0xCBF29CE484222325
    for byte in text.encode():
        digest = ((digest ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return digest


def register_custom_component(name: str) -> ComponentProxy:
    """Create a custom kind of component; the data of its components may have any type that can be copied."""
    return ComponentProxy(name)


_TAGS: Final = ("World", "Model", "Link", "Joint", "Visual", "Collision", "Sensor", "Light", "Actor")
_Reader = Callable[[EntityView, EntityRecord], object]


def _kind_reader(kinds: str, read: _Reader) -> _Reader:
    """Create a reader that returns None for entities of other kinds; `kinds` is separated by spaces."""
    return lambda ecm, record: read(ecm, record) if record.kind in kinds.split() else None


_HANDLES: Final = {"model": _Model, "link": _Link, "joint": _Joint, "sensor": _Sensor, "world": _World}


def _handle_reader(kind: str, method: Callable[[Any, EntityView], object]) -> _Reader:
    """Create a reader that calls a method of the entity's handle, such as `Link.world_linear_velocity`."""
    return _kind_reader(kind, lambda ecm, record: method(_HANDLES[kind](record.entity), ecm))


def _local_pose(ecm: EntityView, record: EntityRecord) -> _Pose3d | None:
    """Return the pose in the frame of the parent entity."""
    if record.kind == "joint":
        return _Joint(record.entity).pose(ecm)
    pose = world_pose(record.entity, ecm)
    return pose if record.parent <= 1 else world_pose(record.parent, ecm).inverse() * pose


def _in_link_axes(read: Callable[[_Link, EntityView], _Vector3d | None]) -> _Reader:
    def turned(ecm: EntityView, record: EntityRecord) -> object:
        value, pose = read(_Link(record.entity), ecm), _Link(record.entity).world_pose(ecm)
        return pose.rot().rotate_vector_reverse(value) if value is not None and pose is not None else None

    return turned


def _inertial(ecm: EntityView, record: EntityRecord) -> _Inertiald | None:
    link, pose = _Link(record.entity).world_inertial(ecm), _Link(record.entity).world_pose(ecm)
    if link is None or pose is None:
        return None
    return _Inertiald(link.mass_matrix(), pose.inverse() * link.pose())


_READERS: Final[dict[str, _Reader]] = {
    "Name": lambda _, record: record.name,
    "ParentEntity": lambda _, record: record.parent or None,
    "Pose": _kind_reader("model link joint visual collision sensor light actor", _local_pose),
    "WorldPose": _kind_reader("model link sensor", lambda ecm, record: world_pose(record.entity, ecm)),
    "Static": _kind_reader("model", lambda _, record: record.scene.static),
    "SelfCollide": _kind_reader("model", lambda _, record: record.scene.self_collide),
    "SourceFilePath": _handle_reader("model", _Model.source_file_path),
    "ModelCanonicalLink": _handle_reader("model", _Model.canonical_link),
    "WindMode": _kind_reader("link", lambda _, record: record.scene.enable_wind),
    "Inertial": _kind_reader("link", _inertial),
    "WorldLinearVelocity": _handle_reader("link", _Link.world_linear_velocity),
    "WorldAngularVelocity": _handle_reader("link", _Link.world_angular_velocity),
    "WorldLinearAcceleration": _handle_reader("link", _Link.world_linear_acceleration),
    "WorldAngularAcceleration": _handle_reader("link", _Link.world_angular_acceleration),
    "LinearVelocity": _kind_reader("link", _in_link_axes(_Link.world_linear_velocity)),
    "AngularVelocity": _kind_reader("link", _in_link_axes(_Link.world_angular_velocity)),
    "LinearAcceleration": _kind_reader("link", _in_link_axes(_Link.world_linear_acceleration)),
    "AngularAcceleration": _kind_reader("link", _in_link_axes(_Link.world_angular_acceleration)),
    "JointType": _handle_reader("joint", _Joint.type),
    "JointAxis": _kind_reader("joint", lambda ecm, record: next(iter(_Joint(record.entity).axis(ecm) or ()), None)),
    "JointPosition": _handle_reader("joint", _Joint.position),
    "JointVelocity": _handle_reader("joint", _Joint.velocity),
    "JointTransmittedWrench": _handle_reader("joint", _Joint.transmitted_wrench),
    "ParentLinkName": _handle_reader("joint", _Joint.parent_link_name),
    "ChildLinkName": _handle_reader("joint", _Joint.child_link_name),
    "ThreadPitch": _kind_reader("joint", lambda _, record: record.scene.thread_pitch),
    "SensorTopic": _handle_reader("sensor", _Sensor.topic),
    "Gravity": _handle_reader("world", _World.gravity),
    "MagneticField": _handle_reader("world", _World.magnetic_field),
    "Atmosphere": _handle_reader("world", _World.atmosphere),
    "SphericalCoordinates": _handle_reader("world", _World.spherical_coordinates),
}
_TAG_READERS: Final[dict[str, _Reader]] = {
    **{name: _kind_reader(name.lower(), lambda *_: True) for name in _TAGS},
    "CanonicalLink": _kind_reader("link", lambda ecm, record: _Link(record.entity).is_canonical(ecm) or None),
}

_ENABLING_COMPONENTS: Final = {
    **dict.fromkeys(("WorldLinearVelocity", "WorldAngularVelocity", "LinearVelocity", "AngularVelocity"), "velocity"),
    **dict.fromkeys(
        ("WorldLinearAcceleration", "WorldAngularAcceleration", "LinearAcceleration", "AngularAcceleration"),
        "acceleration",
    ),
    "JointPosition": "position",
    "JointVelocity": "velocity",
    "JointTransmittedWrench": "wrench",
}
"""Reading that is enabled when a system creates the component."""


def _numbers(data: Iterable[float]) -> tuple[float, ...]:
    return tuple(float(v) for v in data)


_COMMANDS: Final[dict[str, tuple[tuple[str, ...], str, Callable[[Any], object]]]] = {
    "JointForceCmd": (("joint",), "force", _numbers),
    "JointVelocityCmd": (("joint",), "velocity", _numbers),
    "JointPositionReset": (("joint",), "position_reset", _numbers),
    "JointVelocityReset": (("joint",), "velocity_reset", _numbers),
    "WorldPoseCmd": (("model",), "pose", simkit_pose),
    "LinearVelocityCmd": (("model", "link"), "linear", three_numbers),
    "AngularVelocityCmd": (("model", "link"), "angular", three_numbers),
}
"""For each command component: kinds of its entities, attribute of `PhysicsCommands`, and conversion of its data."""

COMPONENT_NAMES: Final = (*_READERS, *_TAG_READERS, *_COMMANDS)
"""Supported components of gz-sim."""


def _check_component(kind: ComponentProxy) -> ComponentProxy:
    if not isinstance(kind, ComponentProxy):
        raise TypeError(f"expected a component such as components.Pose, got {kind!r}")
    return kind


def read_component(ecm: EntityView, entity: int, kind: ComponentProxy) -> object:
    """Return the data of a component, or None if the entity does not have the component; for a tag, the tag itself."""
    proxy = _check_component(kind)
    custom = ecm.custom.get(proxy.name, {})
    if entity in custom:
        return custom[entity]
    record = ecm.record(entity)
    if record is None or not record.kind:
        return None
    if proxy.name in _TAG_READERS:
        return proxy if _TAG_READERS[proxy.name](ecm, record) else None
    if proxy.name in _COMMANDS:
        return getattr(ecm.commands, _COMMANDS[proxy.name][1]).get(entity)
    reader = _READERS.get(proxy.name)
    return reader(ecm, record) if reader is not None else None


def write_component(ecm: EntityView, entity: int, kind: ComponentProxy, *data: Any) -> None:
    """Set a component of an entity; a component such as `JointForceCmd` becomes a command for the next step.

    Raises:
        KeyError: the entity does not exist.
        TypeError: data for a tag, no data for any other component, or data of a wrong type.
        NotImplementedError: the component is read-only.
    """
    proxy = _check_component(kind)
    record = ecm.record(entity)
    if record is None:
        raise KeyError(f"there is no entity {entity}")
    is_tag = proxy.name in _TAG_READERS
    if is_tag and data:
        raise TypeError(f"{proxy.name} is a tag and has no data")
    if not record.kind or proxy.name not in COMPONENT_NAMES:
        if not is_tag and (not data or data[0] is None):
            raise TypeError(f"{proxy.name} needs data")
        ecm.custom.setdefault(proxy.name, {})[entity] = proxy if is_tag else data[0]
    elif proxy.name in _COMMANDS:
        kinds, attribute, convert = _COMMANDS[proxy.name]
        if record.kind not in kinds:
            raise TypeError(f"{proxy.name} is for a {' or a '.join(kinds)}, but entity {entity} is a {record.kind}")
        if not data or data[0] is None:
            raise TypeError(f"{proxy.name} needs data")
        if proxy.name == "WorldPoseCmd":
            _Model(entity).set_world_pose_cmd(ecm, data[0])  # with a warning for a nested model
        else:
            getattr(ecm.commands, attribute)[entity] = convert(data[0])
    elif proxy.name in _ENABLING_COMPONENTS:
        ecm.enable(entity, _ENABLING_COMPONENTS[proxy.name], True)
    elif proxy.name == "Pose" and record.kind == "light":
        ecm.handle(entity, "light").set_pose(simkit_pose(data[0]))
    else:
        raise _read_only_error(proxy, record)


def _read_only_error(proxy: ComponentProxy, record: EntityRecord) -> NotImplementedError:
    component = f"{proxy.name} of {record.kind} {record.name!r}"
    return NotImplementedError(f"{component} is read-only; use a command such as WorldPoseCmd")


def mark_changed(ecm: EntityView, entity: int, kind: ComponentProxy) -> None:
    """Check that the data of a component may be changed in place; custom data then needs no further work.

    Raises:
        NotImplementedError: the component is read-only, so a change in place has no effect.
    """
    proxy, record = _check_component(kind), ecm.record(entity)
    if record is not None and record.kind and proxy.name in _READERS and entity not in ecm.custom.get(proxy.name, {}):
        raise _read_only_error(proxy, record)


def remove_component(ecm: EntityView, entity: int, kind: ComponentProxy) -> bool:
    """Remove a component that a system has set; return false if no system has set the component."""
    proxy = _check_component(kind)
    if proxy.name in _COMMANDS and getattr(ecm.commands, _COMMANDS[proxy.name][1]).pop(entity, None) is not None:
        return True
    if (
        proxy.name in _ENABLING_COMPONENTS
        and ecm.checks.pop((entity, _ENABLING_COMPONENTS[proxy.name]), None) is not None
    ):
        return True
    return ecm.custom.get(proxy.name, {}).pop(entity, None) is not None


class ComponentCursor:
    """Current entity of an iteration over the entities that have certain components.

    Attributes:
        entity: number of the current entity.
        components: data of its components, in the requested order.
    """

    entity = 0
    components: list[object]

    def __iter__(self) -> Iterator[object]:
        """Support the loop `for entity, (pose, name) in ecm.each([Pose, Name])`."""
        return iter((self.entity, tuple(self.components)))


def each_entity(ecm: EntityView, kinds: list[ComponentProxy]) -> Iterator[ComponentCursor]:
    """Yield each entity that has all the components, in the order of their numbers; every item is the same cursor."""
    proxies, cursor = [_check_component(kind) for kind in kinds], ComponentCursor()
    for record in list(ecm.sync()):
        values = [read_component(ecm, record.entity, proxy) for proxy in proxies]
        if all(value is not None for value in values):
            cursor.entity, cursor.components = record.entity, values
            yield cursor


def __getattr__(name: str) -> ComponentProxy:
    if name in COMPONENT_NAMES:
        return ComponentProxy(name)
    raise missing_name_error("gz.sim.components", name, COMPONENT_NAMES)

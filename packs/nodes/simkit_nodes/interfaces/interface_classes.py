"""Classes of services and actions, and the class names that each package has in ROS 2 and in ROS 1."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any, Final

from simkit.msgs.definition_parser import PARTS
from simkit_nodes.interfaces.message_flavour import TYPE_ATTRIBUTE, MessageFlavour
from simkit_nodes.interfaces.ros1_messages import ROS1, action_types, register_action, short_name
from simkit_nodes.interfaces.ros2_messages import ROS2, snake_case

MakeClass = Callable[[], type]

_ACTION_SERVICES: Final = ("SendGoal", "GetResult")


class _ServiceType(type):
    """Type of the classes of services. The class of events is made at its first use: only introspection has events."""

    def __getattr__(cls, name: str) -> Any:
        if name == "Event":
            return ROS2.message_class(f"{getattr(cls, TYPE_ATTRIBUTE)}_Event")
        raise AttributeError(f"type object {cls.__name__!r} has no attribute {name!r}")


class _ActionType(type):
    """Type of the classes of actions. `Impl` is made at its first use: only implementations of actions have it."""

    def __getattr__(cls, name: str) -> Any:
        if name == "Impl":
            return _action_implementation(getattr(cls, TYPE_ATTRIBUTE))
        raise AttributeError(f"type object {cls.__name__!r} has no attribute {name!r}")


@cache
def ros2_service(name: str) -> type:
    """Return the class of a service of ROS 2, with `Request`, `Response` and `Event`.

    Args:
        name: full name, such as `example_interfaces/srv/AddTwoInts`.

    Raises:
        MessageError: the service is unknown.
    """

    def __init__(self: object) -> None:  # noqa: N807 - it is one
        raise NotImplementedError("Service classes can not be instantiated")

    parts = {part: ROS2.message_class(f"{name}_{part}") for part in ("Request", "Response")}
    return _ServiceType(name.rpartition("/")[2], (), _namespace(name, __init__) | parts)


@cache
def ros2_action(name: str) -> type:
    """Return the class of an action of ROS 2, with `Goal`, `Result`, `Feedback` and `Impl`.

    Args:
        name: full name, such as `example_interfaces/action/Fibonacci`.

    Raises:
        MessageError: the action is unknown.
    """

    def __init__(self: object) -> None:  # noqa: N807 - it is one
        raise NotImplementedError("Action classes can not be instantiated")

    parts = {part: ROS2.message_class(f"{name}_{part}") for part in ("Goal", "Result", "Feedback")}
    return _ActionType(name.rpartition("/")[2], (), _namespace(name, __init__) | parts)


def _namespace(name: str, constructor: object) -> dict[str, Any]:
    package, kind, short = name.split("/")
    module = f"{package}.{kind}._{snake_case(short.partition('_')[0])}"
    return {"__module__": module, "__init__": constructor, TYPE_ATTRIBUTE: name}


@cache
def _action_implementation(name: str) -> type:
    members = {f"{part}Service": ros2_service(f"{name}_{part}") for part in _ACTION_SERVICES}
    members["FeedbackMessage"] = ROS2.message_class(f"{name}_FeedbackMessage")
    members["CancelGoalService"] = ros2_service("action_msgs/srv/CancelGoal")
    members["GoalStatusMessage"] = ROS2.message_class("action_msgs/msg/GoalStatusArray")
    return type("Impl", (), members)


@cache
def ros1_service(name: str) -> type:
    """Return the class of a service of ROS 1, with `_request_class` and `_response_class`.

    Raises:
        MessageError: the service is unknown.
    """
    package, short = name.split("/")[0], short_name(name)
    members = {f"_{part.lower()}_class": ROS1.message_class(f"{name}_{part}") for part in ("Request", "Response")}
    own = {"__module__": f"{package}.srv._{short}", "_type": f"{package}/{short}", "_md5sum": "*", TYPE_ATTRIBUTE: name}
    return type(short, (), own | members)


def _ros1_action_class(action_name: str, type_name: str) -> type:
    register_action(action_name)
    return ROS1.message_class(type_name)


def classes_of(interface_name: str, flavour: MessageFlavour) -> dict[str, MakeClass]:
    """Return a function for each class of an interface, by the name of the class.

    Args:
        interface_name: full name of a message, service or action.
        flavour: ROS whose classes are wanted.
    """
    _, kind, short = interface_name.split("/")
    if flavour is ROS1:
        return _ros1_classes(interface_name, kind, short_name(interface_name))
    if kind == "msg":
        return {short: partial(ROS2.message_class, interface_name)}
    suffixes = [*PARTS[kind], "_Event"] if kind == "srv" else [*PARTS[kind], *_ACTION_SUFFIXES]
    classes: dict[str, MakeClass] = {
        f"{short}{suffix}": partial(ROS2.message_class, f"{interface_name}{suffix}") for suffix in suffixes
    }
    if kind == "action":
        for service in _ACTION_SERVICES:
            classes[f"{short}_{service}"] = partial(ros2_service, f"{interface_name}_{service}")
    return {short: partial(ros2_service if kind == "srv" else ros2_action, interface_name)} | classes


_ACTION_SUFFIXES: Final = (
    "_FeedbackMessage",
    *(f"_{service}_{part}" for service in _ACTION_SERVICES for part in ("Request", "Response", "Event")),
)


def _ros1_classes(name: str, kind: str, short: str) -> dict[str, MakeClass]:
    if kind == "action":
        return {cls: partial(_ros1_action_class, name, type_name) for cls, type_name in action_types(name).items()}
    if kind == "srv":
        parts = {f"{short}{part}": partial(ROS1.message_class, f"{name}_{part}") for part in ("Request", "Response")}
        return {short: partial(ros1_service, name), **parts}
    return {short: partial(ROS1.message_class, name)}


def module_of(class_name: str, interface_name: str, flavour: MessageFlavour) -> str:
    """Return the name of the file that has a class, such as `_twist` in ROS 2 and `_Twist` in ROS 1."""
    if flavour is ROS2:
        return f"_{snake_case(interface_name.rpartition('/')[2])}"
    return f"_{class_name if '/action/' in interface_name else short_name(interface_name)}"


def folders_of(flavour: MessageFlavour, folder: str) -> tuple[str, ...]:
    """Return the kinds of interfaces in a folder of a package: ROS 1 has its actions in the folder `msg`."""
    if flavour is ROS1:
        return {"msg": ("msg", "action"), "srv": ("srv",)}.get(folder, ())
    return (folder,) if folder in PARTS else ()

"""Elements of a plugin with a message in protobuf's text format: its type, its topic and its fields."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from simkit import Params
from simkit.errors import MessageError
from simkit.extend import did_you_mean
from simkit.msgs import valid_topic
from simkit_gz_python.msgs import message_class
from simkit_gz_python.msgs.message import MESSAGE_CLASSES, Message
from simkit_gz_python.msgs.ros_conversion import to_ros, twins_of
from simkit_gz_python.msgs.text_format import parse_message

if TYPE_CHECKING:
    from simkit import Simulation


def message_kind(element: Params, attribute: str, known: Iterable[str] | None = None) -> type[Message] | None:
    """Return the message class that an attribute names; None after a reported error.

    Args:
        element: Element with the attribute.
        attribute: Name of the attribute.
        known: Names of the allowed classes; by default all classes with a ROS type.
    """
    written = element.attribute(attribute)
    if not written:
        element.error("SK-PARAM-001", f'<{element.name}> needs {attribute}=: a type such as "gz.msgs.Boolean"')
        return None
    package, _, name = written.rpartition(".")
    listed = [name for name in MESSAGE_CLASSES if _has_ros_type(name)] if known is None else list(known)
    if name in listed and package in ("gz.msgs", "ignition.msgs"):
        return message_class(name)
    hint = did_you_mean(name, listed) or f"expected {', '.join(sorted(listed))} of gz.msgs"
    message = f'<{element.name} {attribute}="{written}">: messages of this type are not supported here'
    element.error("SK-PLUGIN-120", message, hint)
    return None


def _has_ros_type(name: str) -> bool:
    try:
        return bool(twins_of(MESSAGE_CLASSES[name]))
    except MessageError:
        return False


def topic_attribute(element: Params) -> str:
    """Return the topic that an element names; an empty text after a reported error."""
    written = element.attribute("topic")
    topic = valid_topic(written)
    if topic == "/":
        element.error("SK-PARAM-001", f'<{element.name}> needs topic="...", the name of a topic; found {written!r}')
        return ""
    return topic


def ros_type_of(sim: Simulation, kind: type[Message], topic: str) -> str:
    """Return the ROS type with which a message is published: that of the topic if it fits, else the first one."""
    known, twins = sim.communication.bus.topics().get(topic), [twin.ros for twin in twins_of(kind)]
    return known if known is not None and known in twins else twins[0]


def read_message(kind: type[Message], text: str, element: Params, label: str) -> Message | None:
    """Return the message that a text describes; None after a reported error that begins with `label`."""
    try:
        message = parse_message(kind, text)
        for twin in twins_of(kind)[:1] if _has_ros_type(kind.__name__) else ():
            to_ros(message, twin.ros)  # report at load time the values that the ROS type cannot store
    except MessageError as error:
        element.error("SK-PLUGIN-121", f"{label} {shortened(text)}: {error}")
        return None
    return message


def shortened(text: str) -> str:
    """Return a text in one line of at most 80 characters."""
    text = " ".join(text.split())
    return text if len(text) <= 80 else text[:77] + "..."

"""Functions of rospy for the node of a program: its start, its end, its parameters and single messages."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any, Final

import yaml

from simkit_nodes import ros1_names as names
from simkit_nodes.ros1_modules.rospy.exceptions import ROSException, ROSInitException, ROSInterruptException
from simkit_nodes.ros1_modules.rospy.log import DEBUG, ERROR, FATAL, INFO, WARN, node_log
from simkit_nodes.ros1_modules.rospy.logger_services import offer_logger_services
from simkit_nodes.ros1_modules.rospy.ros_node import RosNode, ros_node
from simkit_nodes.ros1_modules.rospy.rostime import limit_ns
from simkit_nodes.ros1_modules.rospy.topics import Subscriber

__all__ = [
    "DEBUG",
    "ERROR",
    "FATAL",
    "INFO",
    "WARN",
    "delete_param",
    "get_param",
    "get_param_cached",
    "get_param_names",
    "get_published_topics",
    "has_param",
    "init_node",
    "myargv",
    "on_shutdown",
    "search_param",
    "set_param",
    "spin",
    "wait_for_message",
]

_NO_DEFAULT: Final = object()


def init_node(
    name: str,
    argv: Sequence[str] | None = None,
    anonymous: bool = False,
    log_level: int | None = None,
    disable_rostime: bool = False,
    disable_rosout: bool = False,
    disable_signals: bool = False,
    xmlrpc_port: int = 0,
    tcpros_port: int = 0,
) -> None:
    """Give the node of the program its name, and open what the program has created before.

    Args:
        name: name of the node, without a namespace.
        argv: command line with remappings; None for that of the program.
        anonymous: True for a name that no other node has.
        log_level: lowest level that is logged; None for `INFO`.
        disable_rostime: accepted as in rospy.
        disable_rosout: accepted as in rospy.
        disable_signals: True if Ctrl-C and the end of the run shall not shut the node down.
        xmlrpc_port: accepted as in rospy.
        tcpros_port: accepted as in rospy.

    Raises:
        ValueError: the name is empty or has a namespace.
        ROSException: the node has a name, and the arguments are not those of the first call.
        ROSInitException: a parameter of the command line has no valid value.
    """
    if not name:
        raise ValueError("name must not be empty")
    if names.SEP in name:
        raise ValueError("namespaces are not allowed in node names")
    node = ros_node()
    arguments = (name, argv, anonymous, log_level, disable_rostime, disable_signals)
    if node.arguments is not None:
        if node.arguments != arguments:
            text = f"rospy.init_node() has already been called with different arguments: {node.arguments}"
            raise ROSException(text)
        return
    node.arguments = arguments
    words = list(sys.argv if argv is None else argv)
    if argv is not None:
        node.load_mappings(words)
    if "__name" in node.mappings:
        name = node.mappings["__name"]
    elif anonymous:
        name = node.anonymous_name(name)
    if log_level is not None:
        node_log().level = log_level
    _set_private_parameters(node, name, words)
    node.begin(name, handles_signals=not disable_signals)
    offer_logger_services(node)


def _set_private_parameters(node: RosNode, name: str, words: list[str]) -> None:
    """Set the parameters of words such as `_speed:=0.5`."""
    full_name = names.resolve_name(name, node.name)
    for word in words:
        old, is_remap, value = word.partition(names.REMAP)
        if is_remap and names.is_legal_remap(word) and names.is_parameter(old):
            try:
                node.parameters.set(f"{full_name}/{old[1:]}", yaml.safe_load(value))
            except (yaml.YAMLError, TypeError, OverflowError) as error:
                raise ROSInitException(f"invalid command-line parameters: {error}") from None


def myargv(argv: Sequence[str] | None = None) -> list[str]:
    """Return a command line without the remappings and parameters of ROS."""
    return [word for word in (sys.argv if argv is None else argv) if not names.is_legal_remap(word)]


def spin() -> None:
    """Wait until the node is shut down; the callbacks have threads of their own.

    Raises:
        ROSInitException: the program has not called `init_node`.
    """
    node = ros_node()
    if not node.is_initialized:
        raise ROSInitException("client code must call rospy.init_node() first")
    while not node.is_shutdown:
        node.wait()


def on_shutdown(h: Callable[[], object]) -> None:
    """Call a function when the node is shut down.

    Raises:
        TypeError: the object is no function.
    """
    if not callable(h):
        raise TypeError(f"shutdown hook [{h}] must be a function or callable object: {type(h)}")
    node = ros_node()
    if node.is_shutdown:
        h()
    else:
        node.shutdown_functions.append(h)


def wait_for_message(topic: str, topic_type: type[Any], timeout: object = None) -> Any:
    """Wait for a message of a topic, and return it.

    Args:
        topic: name of the topic.
        topic_type: class of the message.
        timeout: longest wait [s], or a `Duration`; None for no limit.

    Raises:
        ROSException: there is no message in time.
        ROSInterruptException: the node was shut down.
    """
    node = ros_node()
    messages: list[Any] = []
    subscriber = Subscriber(topic, topic_type, messages.append)
    try:
        node.wait(limit_ns(timeout), lambda: bool(messages))
    finally:
        subscriber.unregister()
    if messages:
        return messages[0]
    if node.is_shutdown:
        raise ROSInterruptException("rospy shutdown")
    raise ROSException(f"timeout exceeded while waiting for message on topic {topic}")


def get_published_topics(namespace: str = "/") -> list[list[str]]:
    """Return the names and types of the topics below a namespace that have publishers."""
    node = ros_node()
    graph = node.host.graph
    prefix = names.make_global_ns(node.resolve(namespace))
    topics = []
    for topic, types in graph.topics().items():
        if topic.startswith(prefix) and graph.publishers(topic):
            topics.append([topic, types[0].replace("/msg/", "/")])
    return topics


def get_param(param_name: str, default: object = _NO_DEFAULT) -> Any:
    """Return the value of a parameter, or the default.

    Raises:
        KeyError: there is no such parameter, and no default.
    """
    node = ros_node()
    try:
        return node.parameters.get(node.resolve(param_name))
    except KeyError:
        node.poll()  # a loop may wait for the parameter
        if default is not _NO_DEFAULT:
            return default
        error = KeyError(param_name)
        error.add_note(f"help: nobody has set it; pass -p {str(param_name).lstrip('~')}:=VALUE as its launch file does")
        raise error from None


get_param_cached = get_param


def set_param(param_name: str, param_value: object) -> None:
    """Set a parameter; a dictionary sets all parameters below the name."""
    node = ros_node()
    node.parameters.set(node.resolve(param_name), param_value)


def has_param(param_name: str) -> bool:
    """Check whether there is a parameter."""
    node = ros_node()
    if node.parameters.has(node.resolve(param_name)):
        return True
    node.poll()  # a loop may wait for the parameter
    return False


def delete_param(param_name: str) -> None:
    """Delete a parameter with all parameters below it.

    Raises:
        KeyError: there is no such parameter.
    """
    node = ros_node()
    try:
        node.parameters.delete(node.resolve(param_name))
    except KeyError:
        raise KeyError(param_name) from None


def search_param(param_name: str) -> str | None:
    """Return the global name of a parameter in the innermost namespace around the node that has it."""
    node = ros_node()
    return node.parameters.search(node.name, node.mappings.get(param_name, param_name))


def get_param_names() -> list[str]:
    """Return the global names of all parameters."""
    return ros_node().parameters.names()

"""Callbacks for changes of parameters of other nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from simkit_nodes.interfaces import ROS2, interface_module
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile, qos_profile_parameter_events

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)


class ParameterCallbackHandle:
    """Callback for one parameter of one node."""

    def __init__(self, parameter_name: str, node_name: str, callback: Callable[[Any], None]) -> None:
        self.parameter_name, self.node_name, self.callback = parameter_name, node_name, callback


class ParameterEventCallbackHandle:
    """Callback for all messages on `/parameter_events`."""

    def __init__(self, callback: Callable[[Any], None]) -> None:
        self.callback = callback


class ParameterEventHandler:
    """Subscription to `/parameter_events` that calls callbacks; the newest one first.

    Args:
        node: node of the subscription.
        qos_profile: QoS of the subscription.
        options: other options of `create_subscription`.
    """

    def __init__(self, node: Any, qos_profile: QoSProfile = qos_profile_parameter_events, **options: Any) -> None:
        self.node, self.qos_profile = node, qos_profile
        self._parameter_callbacks: list[ParameterCallbackHandle] = []
        self._event_callbacks: list[ParameterEventCallbackHandle] = []
        self.parameter_event_subscription = node.create_subscription(
            _messages.ParameterEvent, "/parameter_events", self._receive, qos_profile, **options
        )

    def destroy(self) -> None:
        """End the subscription."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    def _receive(self, event: Any) -> None:
        for handle in tuple(self._parameter_callbacks):
            parameter = self.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if parameter is not None:
                handle.callback(parameter)
        for event_handle in tuple(self._event_callbacks):
            event_handle.callback(event)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any:
        """Return the new message `Parameter` of a node's parameter; None if the event does not contain it."""
        changes = ParameterEventHandler.get_parameters_from_event(event) if event.node == node_name else ()
        return next((parameter for parameter in changes if parameter.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterator[Any]:
        """Yield the new and the changed messages `Parameter` of an event."""
        yield from event.new_parameters
        yield from event.changed_parameters

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], None]
    ) -> ParameterCallbackHandle:
        """Call a callback for each change of a parameter; an empty name is that of the handler's own node."""
        handle = ParameterCallbackHandle(parameter_name, self._full_name(node_name), callback)
        self._parameter_callbacks.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove a callback; RuntimeError if it was not added."""
        if handle not in self._parameter_callbacks:
            raise RuntimeError("Callback doesn't exist")
        self._parameter_callbacks.remove(handle)

    def add_parameter_event_callback(self, callback: Callable[[Any], None]) -> ParameterEventCallbackHandle:
        """Call a callback with each message."""
        handle = ParameterEventCallbackHandle(callback)
        self._event_callbacks.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove a callback; RuntimeError if it was not added."""
        if handle not in self._event_callbacks:
            raise RuntimeError("Callback doesn't exist")
        self._event_callbacks.remove(handle)

    def _full_name(self, node: str) -> str:
        if not node:
            return str(self.node.get_fully_qualified_name())
        return node if node.startswith("/") else f"{self.node.get_namespace().rstrip('/')}/{node}"

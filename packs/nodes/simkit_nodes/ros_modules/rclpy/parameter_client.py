"""Client of the parameter services of another node."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.parameter import Parameter, parameter_dict_from_yaml_file
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from simkit_nodes.ros_modules.rclpy.task import Future

__all__ = ["AsyncParameterClient"]

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)
_services: Any = interface_module("rcl_interfaces.srv", ROS2)

DoneCallback = Callable[[Any], object]


class AsyncParameterClient:
    """Client of a node's parameters.

    Args:
        node: node of the clients.
        remote_node_name: name of the node with the parameters.
        qos_profile: QoS of the services.
        callback_group: callback group of the clients; None for the default one of the node.
    """

    def __init__(
        self,
        node: Any,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: object = None,
    ) -> None:
        self.remote_node_name, self.node = remote_node_name, node

        def client(service: str, name: str) -> Any:
            return node.create_client(
                getattr(_services, service),
                f"{remote_node_name}/{name}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )

        self._get_parameter_client = client("GetParameters", "get_parameters")
        self._list_parameter_client = client("ListParameters", "list_parameters")
        self._set_parameter_client = client("SetParameters", "set_parameters")
        self._get_parameter_types_client = client("GetParameterTypes", "get_parameter_types")
        self._describe_parameters_client = client("DescribeParameters", "describe_parameters")
        self._set_parameters_atomically_client = client("SetParametersAtomically", "set_parameters_atomically")
        self._clients = [value for value in vars(self).values() if hasattr(value, "service_is_ready")]

    def services_are_ready(self) -> bool:
        """Check whether the other node offers all services."""
        return all(client.service_is_ready() for client in self._clients)

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait for all services, for up to `timeout_sec` or without limit."""
        host = current_host()
        end_ns = None if timeout_sec is None else host.now_ns() + int(timeout_sec * 1e9)
        for client in self._clients:
            left = None if end_ns is None else max(0.0, (end_ns - host.now_ns()) * 1e-9)
            client.wait_for_service(left)
        return self.services_are_ready()

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: DoneCallback | None = None
    ) -> Future:
        """Request the names below prefixes, down to a depth; None for all."""
        request = _services.ListParameters.Request(prefixes=prefixes or [], depth=depth or 0)
        return _called(self._list_parameter_client, request, callback)

    def get_parameters(self, names: list[str], callback: DoneCallback | None = None) -> Future:
        """Request values."""
        return _called(self._get_parameter_client, _services.GetParameters.Request(names=names), callback)

    def set_parameters(self, parameters: Sequence[Any], callback: DoneCallback | None = None) -> Future:
        """Set parameters, which are `Parameter` or messages, one after another."""
        request = _services.SetParameters.Request(parameters=_as_messages(parameters))
        return _called(self._set_parameter_client, request, callback)

    def describe_parameters(self, names: list[str], callback: DoneCallback | None = None) -> Future:
        """Request descriptors."""
        request = _services.DescribeParameters.Request(names=names)
        return _called(self._describe_parameters_client, request, callback)

    def get_parameter_types(self, names: list[str], callback: DoneCallback | None = None) -> Future:
        """Request the numbers of types."""
        request = _services.GetParameterTypes.Request(names=names)
        return _called(self._get_parameter_types_client, request, callback)

    def set_parameters_atomically(self, parameters: Sequence[Any], callback: DoneCallback | None = None) -> Future:
        """Set all parameters or none."""
        request = _services.SetParametersAtomically.Request(parameters=_as_messages(parameters))
        return _called(self._set_parameters_atomically_client, request, callback)

    def delete_parameters(self, names: list[str], callback: DoneCallback | None = None) -> Future:
        """Remove parameters, which must be dynamically typed."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str, use_wildcard: bool = False, callback: DoneCallback | None = None
    ) -> Future:
        """Set the parameters of a file one after another; see `parameter_dict_from_yaml_file`."""
        return self.set_parameters(list(parameter_dict_from_yaml_file(parameter_file, use_wildcard).values()), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: DoneCallback | None = None
    ) -> Future:
        """Set all parameters of a file or none; see `parameter_dict_from_yaml_file`."""
        parameters = list(parameter_dict_from_yaml_file(parameter_file, use_wildcard).values())
        return self.set_parameters_atomically(parameters, callback)

    def on_parameter_event(
        self, callback: Callable[[Any], object], qos_profile: QoSProfile = qos_profile_parameter_events, **options: Any
    ) -> Any:
        """Subscribe to the changes of all nodes' parameters; the options are those of `create_subscription`."""
        return self.node.create_subscription(
            _messages.ParameterEvent, "/parameter_events", callback, qos_profile, **options
        )


def _called(client: Any, request: ProgramMessage, callback: DoneCallback | None) -> Future:
    future: Future = client.call_async(request)
    if callback is not None:
        future.add_done_callback(callback)
    return future


def _as_messages(parameters: Sequence[Any]) -> list[Any]:
    return [p.to_parameter_msg() if isinstance(p, Parameter) else p for p in parameters]

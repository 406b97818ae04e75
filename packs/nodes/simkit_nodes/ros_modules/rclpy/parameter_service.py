"""The six parameter services of a node."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from simkit_nodes.ros_modules.rclpy.parameter import Parameter
from simkit_nodes.ros_modules.rclpy.qos import qos_profile_parameters

__all__ = ["ParameterService"]

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)
_services: Any = interface_module("rcl_interfaces.srv", ROS2)


class ParameterService:
    """Parameter services of a node, below the node's name.

    Args:
        node: node.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        for service, callback in (
            ("DescribeParameters", self._describe),
            ("GetParameters", self._get),
            ("GetParameterTypes", self._get_types),
            ("ListParameters", self._list),
            ("SetParameters", self._set),
            ("SetParametersAtomically", self._set_atomically),
        ):
            name = "".join(f"_{c.lower()}" if c.isupper() else c for c in service).strip("_")
            service_type = getattr(_services, service)
            node.create_service(service_type, f"{node.get_name()}/{name}", callback, qos_profile=qos_profile_parameters)

    def _describe(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        try:
            response.descriptors = self._node.describe_parameters(request.names)
        except ParameterNotDeclaredException:  # then nothing is described, as in rclpy
            response.descriptors = []
        return response

    def _get(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        try:
            parameters = self._node.get_parameters(request.names)
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            parameters = []
        response.values = [parameter.get_parameter_value() for parameter in parameters]
        return response

    def _get_types(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        try:
            types = self._node.get_parameter_types(request.names)
        except ParameterNotDeclaredException:
            types = []
        response.types = [getattr(kind, "value", kind) for kind in types]
        return response

    def _list(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.result = self._node.list_parameters(list(request.prefixes), request.depth)
        return response

    def _set(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.results = [self._result([parameter]) for parameter in request.parameters]
        return response

    def _set_atomically(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.result = self._result(request.parameters)
        return response

    def _result(self, messages: Any) -> Any:
        try:
            return self._node.set_parameters_atomically([Parameter.from_parameter_msg(m) for m in messages])
        except ParameterNotDeclaredException as error:
            return _messages.SetParametersResult(successful=False, reason=str(error))

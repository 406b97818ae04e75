"""The two services of a node for the levels of its loggers, which `enable_logger_service` opens."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.logging import LoggingSeverity, get_logger_level, set_logger_level

__all__ = ["LoggingService"]

_messages: Any = interface_module("rcl_interfaces.msg", ROS2)
_services: Any = interface_module("rcl_interfaces.srv", ROS2)
_LEVELS = {int(level): level for level in LoggingSeverity}


class LoggingService:
    """Services `get_logger_levels` and `set_logger_levels` of a node, below the node's name.

    Args:
        node: node.
    """

    def __init__(self, node: Any) -> None:
        name = node.get_name()
        node.create_service(_services.GetLoggerLevels, f"{name}/get_logger_levels", self._get)
        node.create_service(_services.SetLoggerLevels, f"{name}/set_logger_levels", self._set)

    def _get(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.levels = [
            _messages.LoggerLevel(name=name, level=int(get_logger_level(name))) for name in request.names
        ]
        return response

    def _set(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        results = []
        for requested in request.levels:
            result = _messages.SetLoggerLevelsResult(successful=requested.level in _LEVELS)
            if result.successful:
                set_logger_level(requested.name, _LEVELS[requested.level])
            else:
                result.reason = f"{requested.level} is not a level; expected {', '.join(map(str, sorted(_LEVELS)))}"
            results.append(result)
        response.results = results
        return response

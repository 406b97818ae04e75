"""Services of a node of ROS 1 that list its logger and set its level: `~get_loggers` and `~set_logger_level`."""

from __future__ import annotations

from collections.abc import Callable

from simkit import msgs
from simkit_nodes.ros1_modules.rospy.log import DEBUG, ERROR, FATAL, INFO, WARN, node_log
from simkit_nodes.ros1_modules.rospy.ros_node import RosNode

_LEVELS = {"debug": DEBUG, "info": INFO, "warn": WARN, "error": ERROR, "fatal": FATAL}
_LOGGER = "rosout"


def offer_logger_services(node: RosNode) -> None:
    """Open both services of a node; they answer at once, also while the program waits."""
    log = node_log()

    def get(request: msgs.Message) -> list[dict[str, str]]:
        level = next((name for name, number in _LEVELS.items() if number >= log.level), "fatal")
        return [{"name": _LOGGER, "level": level}]

    def set_level(request: msgs.Message) -> dict[str, object]:
        if request.level.lower() in _LEVELS and request.logger in (_LOGGER, "ros", ""):
            log.level = _LEVELS[request.level.lower()]
        else:
            node.program.write_log(
                [f"[ERROR] [{node.name}]: no logger {request.logger!r} or no level {request.level!r}"]
            )
        return {}

    _offer(node, "get_loggers", "roscpp/srv/GetLoggers", lambda request: {"loggers": get(request)})
    _offer(node, "set_logger_level", "roscpp/srv/SetLoggerLevel", set_level)


def _offer(node: RosNode, name: str, type_name: str, answer: Callable[[msgs.Message], dict[str, object]]) -> None:
    def respond() -> None:
        request = service.take()
        if request is not None:
            request.answer(msgs.make(f"{type_name}_Response", **answer(request.message)))

    service = node.graph_node.offer(f"{node.name}/{name}", type_name, respond)

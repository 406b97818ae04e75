"""Log of rospy: lines in the log of the program, on the terminal and on `/rosout`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any, Final, NamedTuple

from simkit import msgs
from simkit_nodes.qos import Qos
from simkit_nodes.ros1_modules.rospy.ros_node import RosNode, ros_node

DEBUG: Final = 1
INFO: Final = 2
WARN: Final = 4
ERROR: Final = 8
FATAL: Final = 16


class _Level(NamedTuple):
    name: str
    number: int  # in messages of ROS 2


_LEVELS: Final = {
    DEBUG: _Level("DEBUG", 10),
    INFO: _Level("INFO", 20),
    WARN: _Level("WARN", 30),
    ERROR: _Level("ERROR", 40),
    FATAL: _Level("FATAL", 50),
}
_LOG_TYPE: Final = "rcl_interfaces/msg/Log"


class Log:
    """Log of a node.

    Args:
        node: node.

    Attributes:
        level: lowest level that is logged.
    """

    def __init__(self, node: RosNode) -> None:
        self._node, self.level = node, INFO
        self._publisher: Any = None
        self._last_ns: dict[tuple[str, int], int] = {}
        self._last_text: dict[tuple[str, int], str] = {}

    def write(self, level: int, text: object, args: tuple[Any, ...], kwds: dict[str, Any], frame: FrameType) -> None:
        """Write a line.

        Args:
            level: level of rospy.
            text: text, with a place for each argument as in Python's `%`.
            args: arguments of the text.
            kwds: further arguments, such as `logger_name`.
            frame: frame of the program's line.
        """
        if level < self.level:
            return
        line = str(text)
        if args:  # a single dictionary has the arguments by name, as in Python's `logging`
            line %= args[0] if len(args) == 1 and isinstance(args[0], dict) and args[0] else args
        node = self._node
        now = node.host.now_ns()
        name = _LEVELS[level].name
        seconds, nanoseconds = divmod(now, 1_000_000_000)
        node.program.write_log(f"[{name}] [{seconds}.{nanoseconds:09}] [{self._logger(kwds)}]: {line}".split("\n"))
        self._publish(level, line, now, frame)

    def _logger(self, kwds: dict[str, Any]) -> str:
        name = self._node.name.strip("/").replace("/", ".")
        logger = kwds.get("logger_name")
        return f"{name}.{logger}" if logger else name

    def _publish(self, level: int, line: str, now: int, frame: FrameType) -> None:
        node = self._node
        if not node.is_initialized or node.is_shutdown:
            return
        if self._publisher is None:
            self._publisher = node.graph_node.advertise("/rosout", _LOG_TYPE, Qos(is_transient_local=True, depth=1000))
        code = frame.f_code
        place = {"file": code.co_filename, "function": code.co_name, "line": frame.f_lineno}
        stamp = {"sec": now // 1_000_000_000, "nanosec": now % 1_000_000_000}
        number = _LEVELS[level].number
        fields = {"stamp": stamp, "level": number, "name": self._logger({}), "msg": line, **place}
        self._publisher.publish(msgs.make(_LOG_TYPE, **fields))

    def is_due(self, frame: FrameType, period: float) -> bool:
        """Check whether more than a period [s] has passed since the line before, and remember this one."""
        place, now = _place(frame), self._node.host.now_ns()
        last = self._last_ns.get(place)
        if last is not None and 0 <= now - last <= period * 1e9:
            return False
        self._last_ns[place] = now
        return True

    def is_new(self, frame: FrameType, text: object) -> bool:
        """Check whether a text differs from that of the line before, and remember it."""
        place = _place(frame)
        if self._last_text.get(place) == str(text):
            return False
        self._last_text[place] = str(text)
        return True

    def is_first(self, frame: FrameType) -> bool:
        """Check whether a line is executed for the first time, and remember it."""
        place = _place(frame)
        if place in self._last_ns:
            return False
        self._last_ns[place] = self._node.host.now_ns()
        return True


def _place(frame: FrameType) -> tuple[str, int]:
    return frame.f_code.co_filename, frame.f_lineno


def node_log() -> Log:
    """Return the log of the node of the present program."""
    node = ros_node()
    log = node.program.data.get("rospy log")
    if log is None:
        log = node.program.data["rospy log"] = Log(node)
    assert isinstance(log, Log)
    return log


def _plain(level: int) -> Callable[..., None]:
    def log(msg: object, *args: object, **kwargs: object) -> None:
        node_log().write(level, msg, args, kwargs, sys._getframe(1))

    log.__doc__ = f"Log a text of level {_LEVELS[level].name}; further arguments are put into it with `%`."
    return log


def _once(level: int) -> Callable[..., None]:
    def log(msg: object, *args: object, **kwargs: object) -> None:
        frame = sys._getframe(1)
        if node_log().is_first(frame):
            node_log().write(level, msg, args, kwargs, frame)

    log.__doc__ = f"Log a text of level {_LEVELS[level].name} when the line of the program is executed first."
    return log


def _throttled(level: int) -> Callable[..., None]:
    def log(period: float, msg: object, *args: object, **kwargs: object) -> None:
        frame = sys._getframe(1)
        if node_log().is_due(frame, period):
            node_log().write(level, msg, args, kwargs, frame)

    log.__doc__ = f"Log a text of level {_LEVELS[level].name}, at most once in a period [s]."
    return log


def _throttled_identical(level: int) -> Callable[..., None]:
    def log(period: float, msg: object, *args: object, **kwargs: object) -> None:
        frame, log = sys._getframe(1), node_log()
        is_due = period is not None and log.is_due(frame, period)
        if log.is_new(frame, msg) or is_due:
            log.write(level, msg, args, kwargs, frame)

    log.__doc__ = f"Log a text of level {_LEVELS[level].name}, but the same text at most once in a period [s]."
    return log


logdebug, loginfo, logwarn, logerr, logfatal = map(_plain, _LEVELS)
logdebug_once, loginfo_once, logwarn_once, logerr_once, logfatal_once = map(_once, _LEVELS)
logdebug_throttle, loginfo_throttle, logwarn_throttle, logerr_throttle, logfatal_throttle = map(_throttled, _LEVELS)
(
    logdebug_throttle_identical,
    loginfo_throttle_identical,
    logwarn_throttle_identical,
    logerr_throttle_identical,
    logfatal_throttle_identical,
) = map(_throttled_identical, _LEVELS)
logerror, logout = logerr, loginfo

__all__ = [
    "DEBUG",
    "ERROR",
    "FATAL",
    "INFO",
    "WARN",
    *(
        f"log{level}{form}"
        for level in ("debug", "info", "warn", "err", "fatal")
        for form in ("", "_once", "_throttle", "_throttle_identical")
    ),
    "logerror",
    "logout",
]

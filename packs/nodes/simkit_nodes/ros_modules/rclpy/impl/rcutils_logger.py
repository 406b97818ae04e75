"""Loggers. Messages go to the log of the program, to stderr and to the topic `/rosout`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any, Final

from simkit_nodes.host import current_host, current_program
from simkit_nodes.ros_modules.rclpy.impl.logging_severity import LoggingSeverity

__all__ = ["RcutilsLogger"]

_KEY: Final = "rclpy.log_state"
_FOLDER: Final = f"{Path(__file__).parents[3]}{os.sep}"
_FILTERS: Final = ("throttle", "skip_first", "once")
_OPTIONS: Final = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")
_NANOSECONDS: Final = 1_000_000_000

Rosout = Callable[[int, str, str, str, str, int], None]
"""Function that publishes a message: level, name of the logger, text, file, function and line."""


@dataclass
class LogState:
    """Loggers of a program.

    Attributes:
        levels: levels that were set, by the name of the logger; the name is empty for all others.
        rosout: functions that publish the messages of nodes, by the name of the logger.
        is_stdout_enabled: False after `--disable-stdout-logs`.
    """

    levels: dict[str, LoggingSeverity] = field(default_factory=dict)
    rosout: dict[str, Rosout] = field(default_factory=dict)
    is_stdout_enabled: bool = True


def log_state() -> LogState:
    """Return the loggers of the present program."""
    data = current_program().data
    state: LogState | None = data.get(_KEY)
    if state is None:
        state = data[_KEY] = LogState()
    return state


def effective_level(name: str) -> LoggingSeverity:
    """Return the level of a logger, or else of the nearest logger above it."""
    levels = log_state().levels
    while name:
        level = levels.get(name)
        if level:
            return level
        name = name.rpartition(".")[0]
    return levels.get("") or LoggingSeverity.INFO


class RcutilsLogger:
    """Logger of a name.

    Args:
        name: name; empty for the logger above all others.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._calls: dict[tuple[str, int, int], dict[str, Any]] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the logger with a name below this one's."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: int | LoggingSeverity) -> None:
        """Set the level below which messages are dropped."""
        log_state().levels[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """Return the level below which messages are dropped."""
        return effective_level(self.name)

    def is_enabled_for(self, severity: int | LoggingSeverity) -> bool:
        """Check whether messages of a level are logged."""
        return LoggingSeverity(severity) >= effective_level(self.name)

    def log(self, message: str, severity: int | LoggingSeverity, **kwargs: Any) -> bool:
        """Log a message.

        Args:
            message: text.
            severity: level.
            **kwargs: `throttle_duration_sec` [s] and `throttle_time_source_type` (a clock), `skip_first`, `once`, and
                `name` for another logger.

        Returns:
            False if the message was dropped.

        Raises:
            TypeError: an option is unknown, or the message is no text, such as an exception or a number.
            ValueError: the options of this line of the program have changed.
        """
        if not self.is_enabled_for(severity):
            return False
        severity = LoggingSeverity(severity)
        name = kwargs.pop("name", self.name)
        filters = _filters_of(kwargs)
        line, frame = _callers()
        code = frame.f_code
        call = self._calls.get(line)
        if call is None:
            call = {"name": name, "severity": severity, "filters": filters, "options": dict(kwargs)}
            call |= {"count": 0, "last_ns": None}
            self._calls[line] = call
        else:
            _check_same(call, name, severity, filters, kwargs)
        if not _passes(call):
            return False
        if not isinstance(message, str):
            text = f"the message must be of type str, but is {message!r}"
            raise TypeError(f"rclpy_logging_rcutils_log(): incompatible function arguments: {text}")
        write(severity, name, message, code.co_filename, code.co_name, frame.f_lineno)
        return True

    def debug(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level DEBUG."""
        return self.log(message, LoggingSeverity.DEBUG, **kwargs)

    def info(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level INFO."""
        return self.log(message, LoggingSeverity.INFO, **kwargs)

    def warning(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level WARN."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    def warn(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level WARN."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    def error(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level ERROR."""
        return self.log(message, LoggingSeverity.ERROR, **kwargs)

    def fatal(self, message: str, **kwargs: Any) -> bool:
        """Log a message of the level FATAL."""
        return self.log(message, LoggingSeverity.FATAL, **kwargs)


def write(severity: LoggingSeverity, name: str, text: str, file: str, function: str, line: int) -> None:
    """Write a message to the log of the program, to stderr and to `/rosout`."""
    state = log_state()
    seconds, nanoseconds = divmod(current_host().now_ns(), _NANOSECONDS)
    if state.is_stdout_enabled:
        lines = f"[{severity.name}] [{seconds}.{nanoseconds:09d}] [{name}]: {text}".split("\n")
        current_program().write_log(lines)
    above = name
    while above and above not in state.rosout:
        above = above.rpartition(".")[0]
    if above:
        state.rosout[above](severity, name, text, file, function, line)


def _filters_of(options: dict[str, Any]) -> list[str]:
    """Return the filters that options ask for; complete and check the options."""
    filters = [name for name in _FILTERS if any(value for key, value in options.items() if key.startswith(name))]
    if "throttle" in filters and options.get("throttle_duration_sec") is None:
        raise TypeError(
            'required parameter "throttle_duration_sec" not specified but is required for the the logging filter '
            '"throttle"'
        )
    for option in options:
        if option not in _OPTIONS:
            raise TypeError(f'parameter "{option}" is not one of the recognized logging options "{list(_OPTIONS)}"')
    clock = options.get("throttle_time_source_type")
    if clock is not None and not hasattr(clock, "now"):
        raise ValueError(f'Received throttle_time_source_type of "{clock}" is not a clock instance')
    return filters


def _check_same(
    call: dict[str, Any], name: str, severity: LoggingSeverity, filters: list[str], options: dict[str, Any]
) -> None:
    if severity != call["severity"]:
        raise ValueError("Logger severity cannot be changed between calls.")
    if name != call["name"]:
        raise ValueError("Logger name cannot be changed between calls.")
    if filters != call["filters"]:
        raise ValueError("Requested logging filters cannot be changed between calls.")
    if filters and options != call["options"]:
        raise ValueError("Logging filter parameters cannot be changed between calls.")


def _passes(call: dict[str, Any]) -> bool:
    """Check whether the filters of a call let its message pass, and update them."""
    options = call["options"]
    for name in call["filters"]:
        if name == "throttle":
            clock = options.get("throttle_time_source_type")
            now = current_host().now_ns() if clock is None else clock.now().nanoseconds
            last = 0 if clock is not None and call["last_ns"] is None else call["last_ns"]
            if last is not None and now < last + options["throttle_duration_sec"] * _NANOSECONDS:
                return False
            call["last_ns"] = now
        else:
            is_first, call["count"] = call["count"] == 0, call["count"] + 1
            if is_first is (name == "skip_first"):
                return False
    return True


def _callers() -> tuple[tuple[str, int, int], FrameType]:
    """Return the line that logs, which may be one of simkit, and the frame of the program."""
    frame = sys._getframe(2)
    while frame.f_back is not None and frame.f_code.co_filename == __file__:
        frame = frame.f_back
    line = frame.f_code.co_filename, frame.f_lineno, frame.f_lasti
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_FOLDER):
        frame = frame.f_back
    return line, frame

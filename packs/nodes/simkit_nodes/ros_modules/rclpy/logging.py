"""Loggers by name, and their levels."""

from __future__ import annotations

from pathlib import Path

from simkit_nodes.ros_modules.rclpy.impl import rcutils_logger
from simkit_nodes.ros_modules.rclpy.impl.logging_severity import LoggingSeverity
from simkit_nodes.ros_modules.rclpy.impl.rcutils_logger import RcutilsLogger

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]


def get_logger(name: str) -> RcutilsLogger:
    """Return a logger of a name."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def initialize() -> None:
    """Do nothing: loggers need no preparation."""


def shutdown() -> None:
    """Reset the levels of all loggers."""
    rcutils_logger.log_state().levels.clear()


def clear_config() -> None:
    """Reset the levels of all loggers."""
    shutdown()


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Set the level of a logger, below which its messages are dropped."""
    rcutils_logger.log_state().levels[name] = LoggingSeverity(level)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level of a logger, or else of the nearest logger above it."""
    return rcutils_logger.effective_level(name)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level that was set for a logger; UNSET without one."""
    return rcutils_logger.log_state().levels.get(name, LoggingSeverity.UNSET)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the level of a name, such as `info`."""
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RuntimeError(f"Failed to get log severity from string: {log_severity}") from None


def get_logging_directory() -> Path:
    """Return the folder of log files; simkit writes none."""
    return Path.home() / ".ros" / "log"

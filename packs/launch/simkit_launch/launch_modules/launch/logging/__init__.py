"""Logs of a launch."""

from __future__ import annotations

import logging
from typing import Any

from simkit_launch.planner import current_planner

__all__ = ["LaunchConfig", "get_logger", "get_output_loggers", "launch_config", "reset"]


class _PlanHandler(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        current_planner().log(f"[{record.levelname}] [{record.name}]: {record.getMessage()}")


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger, whose messages are in the log of the launch."""
    planner = current_planner()
    name = name or "launch"
    logger = planner.loggers.get(name)
    if logger is None:
        logger = planner.loggers[name] = logging.Logger(name, logging.INFO)
        logger.addHandler(_PlanHandler())
    return logger


def get_output_loggers(process_name: str, output_config: Any) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of the output and the error output of a process."""
    del output_config
    return get_logger(f"{process_name}-stdout"), get_logger(f"{process_name}-stderr")


class LaunchConfig:
    """Settings of the logs, which have no effect here.

    Attributes:
        level: lowest level of the messages in the log.
        log_dir: folder of the logs.
    """

    def __init__(self) -> None:
        self.level: int = logging.INFO
        self.log_dir = ""

    def reset(self) -> None:
        """Do nothing."""

    def set_screen_format(self, screen_format: Any, *, screen_style: Any = None) -> None:
        """Do nothing."""

    def set_log_format(self, log_format: Any, *, log_style: Any = None) -> None:
        """Do nothing."""

    def get_log_file_path(self, file_name: str = "launch.log") -> str:
        """Return a path in the folder of the plan."""
        return str(current_planner().folder / "log" / file_name)

    def get_screen_handler(self) -> logging.Handler:
        """Return a handler that adds messages to the log of the launch."""
        return _PlanHandler()

    def get_log_file_handler(self, file_name: str = "launch.log") -> logging.Handler:
        """Return a handler that does nothing: no file is written."""
        del file_name
        return logging.NullHandler()


launch_config = LaunchConfig()


def reset() -> None:
    """Do nothing."""

"""Loggers whose messages also go to the topic `/rosout` of a simulation."""

from __future__ import annotations

import logging
from typing import Protocol

from simkit.in_process import InProcess


class LogSink(Protocol):
    """Topic of log messages.

    Attributes:
        is_wanted: True if messages that no Python handler prints are needed.
    """

    @property
    def is_wanted(self) -> bool: ...

    def add_record(self, owner: object, record: logging.LogRecord) -> None:
        """Publish a message; `owner` is its plugin or the name of its node."""


class TopicLogger(InProcess, logging.Logger):
    """Logger of a plugin, a controller or a simulation, whose messages also go to `/rosout`.

    It passes messages to the registered Python logger of the same name, so levels and handlers of that logger apply.

    Args:
        name: name of the Python logger.
        owner: plugin; or `Communication` for messages of the simulation itself.
        node: node of the messages; empty for the node of the owner.
    """

    def __init__(self, name: str, owner: object, node: str = "") -> None:
        super().__init__(name)
        self.parent = logging.getLogger(name)
        self._owner, self._node = owner, node

    def isEnabledFor(self, level: int) -> bool:  # noqa: N802 - overrides logging.Logger
        """Check whether a message of this level is printed or published."""
        if self.parent is not None and self.parent.isEnabledFor(level):
            return True
        topic = self._topic()
        return topic is not None and level >= logging.INFO and topic.is_wanted and not self.disabled

    def handle(self, record: logging.LogRecord) -> None:
        """Print and publish a message."""
        topic = self._topic()
        if topic is not None:
            topic.add_record(self._node or self._owner, record)
        if self.parent is not None and self.parent.isEnabledFor(record.levelno):
            super().handle(record)

    def _topic(self) -> LogSink | None:
        sim = vars(self._owner).get("sim", self._owner)  # a plugin has no simulation before `load`
        owner = vars(sim).get("communication", sim)
        topic: LogSink | None = vars(owner).get("log_topic")
        return topic

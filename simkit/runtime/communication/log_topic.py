"""Topic `/rosout`: log messages of plugins and diagnostics of simkit as `rcl_interfaces/msg/Log`.

The newest 1000 messages are sent to later subscribers, as ROS 2 does. Messages below the level of the Python logger
are made only while the topic has subscribers, and before the first step.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

from simkit import msgs
from simkit.msgs import Message
from simkit.runtime.communication.node_names import node_of
from simkit.runtime.communication.publisher import KEPT_LOG_MESSAGES, ROSOUT
from simkit.runtime.communication.subscription import LazyMessage

if TYPE_CHECKING:
    from simkit.diagnostics import Diagnostic, Diagnostics
    from simkit.runtime.communication.publisher import Publisher
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.runtime.engine.engine import Engine

LOG: Final = "rcl_interfaces/msg/Log"

_LEVELS: Final = {"error": logging.ERROR, "warning": logging.WARNING, "note": logging.INFO}


def open_own_topic(bus: TopicBus, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
    """Open a topic of the simulation itself; recorders and counters ignore it unless the user names it."""
    with bus.owned_by(bus, renames=False):  # the messages are no external inputs
        publisher = bus.advertise(topic, type_name, latched=latched)
    publisher.disown()
    bus.aside.add(topic)
    return publisher


class _Entry(NamedTuple):
    """Log message with the fields of `rcl_interfaces/msg/Log`; `owner` is its plugin or the name of its node."""

    time_ns: int
    level: int
    owner: object
    text: str
    file: str
    function: str
    line: int


class LogTopic:
    """Publisher of `/rosout`.

    Args:
        bus: topic bus.
        engine: engine of the simulation.
        parameter_node: function that returns the node of a plugin with live parameters; empty for another plugin.
    """

    def __init__(self, bus: TopicBus, engine: Engine, parameter_node: Callable[[object], str]) -> None:
        self._engine, self._parameter_node = engine, parameter_node
        self._publisher = open_own_topic(bus, ROSOUT, LOG, latched=True)
        self._history = self._publisher.keep_history(KEPT_LOG_MESSAGES)
        self._waiting: deque[_Entry] = deque(maxlen=KEPT_LOG_MESSAGES)
        self._thread = threading.get_ident()
        self._is_publishing = False

    def hear(self, reports: Diagnostics) -> None:
        """Publish all present and future diagnostics of a collection."""
        reports.tell(self._add_diagnostic)

    @property
    def is_wanted(self) -> bool:
        """True if messages that no Python handler prints are needed: for subscribers, and before the first step."""
        return self._engine.tick == 0 or self._publisher.subscribers > 0

    def use_thread(self) -> None:
        """Publish from the present thread from now on, and publish messages that other threads have logged."""
        self._thread = threading.get_ident()
        while self._waiting:
            self._publish(self._waiting.popleft())

    def add_record(self, owner: object, record: logging.LogRecord) -> None:
        """Publish a message of a Python logger."""
        text = record.getMessage()
        if record.exc_info:
            text = f"{text}\n{logging.Formatter().formatException(record.exc_info)}"
        now, function = self._engine.time_ns, record.funcName or ""
        self._add(_Entry(now, record.levelno, owner, text, record.pathname, function, record.lineno))

    def _add_diagnostic(self, item: Diagnostic) -> None:
        text = f"{item.code} {item.message}" + (f"; help: {item.hint}" if item.hint else "")
        now, level = self._engine.time_ns, _LEVELS[item.severity]
        self._add(_Entry(now, level, "simkit", text, item.file or "", "", item.line or 0))

    def _add(self, entry: _Entry) -> None:
        if threading.get_ident() != self._thread:
            self._waiting.append(entry)  # subscribers are called only by the thread of the simulation
        else:
            self._publish(entry)

    def _publish(self, entry: _Entry) -> None:
        message = LazyMessage(partial(self._message, entry))
        self._history.append(message)
        if self._publisher.subscribers and not self._is_publishing:  # a subscriber may log, too
            self._is_publishing = True
            try:
                self._publisher.publish(message.get())
            finally:
                self._is_publishing = False

    def _message(self, entry: _Entry) -> Message:
        time_ns, level, owner, text, file, function, line = entry
        node = owner if isinstance(owner, str) else self._parameter_node(owner) or node_of(owner)
        return log_message(node, time_ns, level, text, file, function, line)


def log_message(
    node: str, time_ns: int, level: int, text: str, file: str = "", function: str = "", line: int = 0
) -> Message:
    """Return a message of `/rosout`.

    Args:
        node: name of the node; the message has the name of its logger in ROS, `tb3.diff_drive` for `/tb3/diff_drive`.
        time_ns: simulated time [ns].
        level: level of Python's `logging`.
        text: text of the message.
        file: path of the source file that logged the message.
        function: name of the function that logged the message.
        line: line in the file.
    """
    return msgs.make(
        LOG,
        stamp=msgs.time(time_ns),
        level=max(logging.DEBUG, min(logging.CRITICAL, level // 10 * 10)),
        name=node.strip("/").replace("/", "."),
        msg=_valid(text),
        file=_valid(file),
        function=_valid(function),
        line=max(0, line),
    )


def _valid(text: str) -> str:
    """Replace what UTF-8 cannot encode, such as half of a surrogate pair."""
    return text.encode("utf-8", "replace").decode()

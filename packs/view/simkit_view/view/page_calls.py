"""Calls of services and goals of actions that pages have sent, with their progress."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from simkit.msgs.goal_status import GoalStatus
from simkit.msgs.message_text import TextStyle, message_to_yaml
from simkit.run_spec import JsonObject
from simkit.runtime.communication.service_server import ServiceCall
from simkit_view.view.packet import make_packet

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.extend import GoalHandle
    from simkit.msgs import Message

_PERIOD: Final = 0.15  # [s] of wall time between two packets
_MOST_KEPT: Final = 50  # calls and goals that have ended
_MOST_OPEN: Final = 200  # goals and calls that have not ended
_NAMES: Final = {GoalStatus.UNKNOWN: "WAITING"}  # until the next step
_STYLE: Final = TextStyle(truncate=64)
_LONGEST: Final = 20_000  # characters of a message


class PageCalls:
    """Goals, and calls that another process answers; also the stream `calls` that shows them.

    The progress is read between two steps. No callback of a page runs within a step.

    Args:
        sim: simulation with the services and actions.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._entries: dict[int, GoalHandle | ServiceCall] = {}
        self._texts: dict[int, tuple[object, str]] = {}
        self._number, self._due, self._sent = 0, 0.0, b""

    @property
    def is_full(self) -> bool:
        """True if too many goals and calls have not ended."""
        return sum(not _is_done(self._sim, entry) for entry in self._entries.values()) >= _MOST_OPEN

    def add(self, entry: GoalHandle | ServiceCall) -> int:
        """Add a goal or a call and return its number."""
        self._number += 1
        self._entries[self._number] = entry
        ended = [number for number, known in self._entries.items() if _is_done(self._sim, known)]
        for number in ended[: max(0, len(ended) - _MOST_KEPT)]:
            del self._entries[number]
            self._texts.pop(number, None)
        return self._number

    def goal(self, number: int) -> GoalHandle | None:
        """Return a goal; None if there is no such goal."""
        entry = self._entries.get(number)
        return None if isinstance(entry, ServiceCall) else entry

    def packet(self, options: Sequence[object]) -> bytes | None:
        """Return a packet with all goals and calls; None if nothing has changed."""
        now = time.perf_counter()
        if now < self._due:
            return None
        self._due = now + _PERIOD
        packet = make_packet({"kind": "calls", "calls": [self._row(n, e) for n, e in self._entries.items()]}, {})
        if packet == self._sent:
            return None
        self._sent = packet
        return packet

    def close(self) -> None:
        """Send everything again when the next page asks."""
        self._sent = b""

    def _row(self, number: int, entry: GoalHandle | ServiceCall) -> JsonObject:
        is_done = _is_done(self._sim, entry)
        if isinstance(entry, ServiceCall):
            status = "WAITING" if not is_done else "FAILED" if entry.error is not None else "DONE"
            row = {"kind": "service", "name": entry.service.name, "reason": str(entry.error or "")}
            return {**row, "id": number, "status": status, "done": is_done, "text": self._text(number, entry.response)}
        is_undone = is_done and not entry.is_done
        message = entry.result if entry.is_done else entry.feedback
        return {
            "kind": "goal",
            "id": number,
            "name": entry.action.name,
            "status": "UNDONE" if is_undone else _NAMES.get(entry.status, entry.status.name),
            "done": is_done,
            "reason": "a reset or a restore has undone the goal" if is_undone else entry.reason,
            "is_result": entry.is_done,
            "text": self._text(number, message),
        }

    def _text(self, number: int, message: Message) -> str:
        """Return the text of a message, which is made once."""
        known = self._texts.get(number)
        if known is None or known[0] is not message:
            known = self._texts[number] = message, shown_message(message)
        return known[1]


def _is_done(sim: Simulation, entry: GoalHandle | ServiceCall) -> bool:
    """Check whether an entry has ended; also a goal that a reset has undone."""
    return entry.is_done or not (isinstance(entry, ServiceCall) or sim.communication.actions.knows(entry))


def shown_message(message: Message) -> str:
    """Return a message as `ros2 topic echo` prints it, with long arrays truncated."""
    if message is None:
        return ""
    text = message_to_yaml(message, _STYLE)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}\n…"

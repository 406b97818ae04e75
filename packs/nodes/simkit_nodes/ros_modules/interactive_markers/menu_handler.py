"""Menus of interactive markers."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from typing import Any, Final

from simkit_nodes.host import current_program
from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.ros_modules.interactive_markers.interactive_marker_server import Feedback, MarkerServer

__all__ = ["MenuHandler"]

_MENU_SELECT: Final = 2
"""Type of the feedback of a menu."""


@dataclass
class _Entry:
    """Entry of a menu."""

    title: str
    command_type: int
    command: str
    callback: Feedback | None
    entries: list[int] = field(default_factory=list)
    is_visible: bool = True
    check_state: int = 0


class MenuHandler:
    """Menu of interactive markers; its entries have numbers."""

    NO_CHECKBOX, CHECKED, UNCHECKED = 0, 1, 2

    def __init__(self) -> None:
        self._entries: dict[int, _Entry] = {}
        self._top: list[int] = []
        self._marker_names: dict[str, None] = {}

    def insert(
        self,
        title: str,
        parent: int | None = None,
        command_type: int = 0,
        command: str = "",
        callback: Feedback | None = None,
    ) -> int | None:
        """Add an entry.

        Args:
            title: text of the entry.
            parent: number of the entry that it is below; None for the menu itself.
            command_type: constant of `visualization_msgs.msg.MenuEntry`.
            command: command that the showing program runs.
            callback: function that receives an `InteractiveMarkerFeedback`.

        Returns:
            The number of the entry; None if there is no such parent.
        """
        number = len(self._entries) + 1
        if parent is not None and parent not in self._entries:
            print(f"Parent menu entry '{parent}' not found", file=sys.stderr)  # noqa: T201 - as ROS does
            return None
        self._entries[number] = _Entry(title, command_type, command, callback)
        (self._top if parent is None else self._entries[parent].entries).append(number)
        return number

    def setVisible(self, handle: int, visible: bool) -> bool:
        """Show or hide an entry; return False if there is no such entry."""
        if handle in self._entries:
            self._entries[handle].is_visible = visible
        return handle in self._entries

    def setCheckState(self, handle: int, check_state: int) -> bool:
        """Set the check box of an entry; return False if there is no such entry."""
        if handle in self._entries:
            self._entries[handle].check_state = check_state
        return handle in self._entries

    def getCheckState(self, handle: int) -> int | None:
        """Return the state of the check box of an entry; None if there is no such entry."""
        return self._entries[handle].check_state if handle in self._entries else None

    def getTitle(self, handle: int) -> str | None:
        """Return the text of an entry; None if there is no such entry."""
        return self._entries[handle].title if handle in self._entries else None

    def apply(self, server: MarkerServer, marker_name: str) -> bool:
        """Give the menu to a marker; return False if there is no such marker."""
        marker = server.get(marker_name)
        if marker is None:
            self._marker_names.pop(marker_name, None)
            return False
        marker.menu_entries = self._messages(self._top, 0)
        server._insert(marker)
        server.setCallback(marker_name, self.processFeedback, _MENU_SELECT)
        self._marker_names[marker_name] = None
        return True

    def reApply(self, server: MarkerServer) -> bool:
        """Give the changed menu to all its markers; return False if one of them is missing."""
        results = [self.apply(server, name) for name in list(self._marker_names)]
        return all(results)

    def processFeedback(self, feedback: ProgramMessage) -> None:
        """Call the function of the entry that was chosen."""
        entry = self._entries.get(feedback.menu_entry_id)
        if entry is not None and entry.callback is not None:
            entry.callback(feedback)

    def _messages(self, numbers: list[int], parent: int) -> list[Any]:
        messages: list[Any] = []
        for number in numbers:
            entry = self._entries[number]
            if not entry.is_visible:
                continue
            message: ProgramMessage = current_program().flavour.message_class("visualization_msgs/msg/MenuEntry")()
            message.id, message.parent_id = number, parent
            message.title = ("", "[x] ", "[ ] ")[entry.check_state] + entry.title
            message.command, message.command_type = entry.command, entry.command_type
            messages += [message, *self._messages(entry.entries, number)]
        return messages

"""Base class of connections to autopilots: one open port, one peer, and lock-step that survives resets and restores."""

from __future__ import annotations

import abc
import socket
from typing import TYPE_CHECKING

from simkit.extend import SharedByCopies
from simkit.interrupts import stop_requests
from simkit_water_and_air.plugins.autopilots.bounded_wait import WaitLimit

if TYPE_CHECKING:
    from simkit.plugins.one_time_warnings import OneTimeWarnings

Address = tuple[str, int]


class AutopilotLink(SharedByCopies):
    """Connection to an autopilot. It is not part of snapshots: the other program cannot go back.

    Args:
        name: name of the plugin.
        place: address and port.
        is_lock_step: True if every step waits for the answer to the last state.
        timeout: longest wait in lock-step [s].
        once: reporter of warnings.

    Attributes:
        autopilot: name of the program, for messages.
        is_time_broken: True after a reset or a restore has changed the simulated time, until `resume`.
    """

    autopilot = "the autopilot"

    def __init__(self, name: str, place: Address, is_lock_step: bool, timeout: float, once: OneTimeWarnings) -> None:
        self.name = name
        self._place, self._is_lock_step, self._timeout, self._once = place, is_lock_step, timeout, once
        self._socket: socket.socket | None = None
        self._is_answer_due = False  # a state was sent, and no command has come since then
        self.is_time_broken = False
        self._stops_before = stop_requests()

    @abc.abstractmethod
    def open(self) -> None:
        """Open the port.

        Raises:
            OSError: the address cannot be used.
        """

    @property
    @abc.abstractmethod
    def is_connected(self) -> bool:
        """True while there is an autopilot."""

    @abc.abstractmethod
    def send(self, state: bytes) -> None:
        """Send a state to the autopilot."""

    @abc.abstractmethod
    def drop_answer(self) -> None:
        """Receive the answer to the last state, if one is due, and forget it."""

    @abc.abstractmethod
    def drop_peer(self) -> None:
        """Forget the autopilot."""

    @property
    def is_open(self) -> bool:
        """True while the port is open."""
        return self._socket is not None

    @property
    def port(self) -> int:
        """Number of the open port; 0 while it is closed."""
        return 0 if self._socket is None else int(self._socket.getsockname()[1])

    def close(self) -> None:
        """Close the connection and the port."""
        self.drop_peer()
        if self._socket is not None:
            self._socket.close()
        self._socket = None

    def break_time(self) -> None:
        """Note that the simulated time was changed by a reset or a restore."""
        self.is_time_broken = self.is_connected

    def resume(self, state: bytes) -> None:
        """After a change of the simulated time: drop the answer to the last state, and send the present state.

        Args:
            state: present state; empty if there is no measurement yet.
        """
        self.is_time_broken = False
        if self._is_lock_step:
            self.drop_answer()
        self._is_answer_due = False
        if state and self.is_connected:
            self.send(state)

    def limit(self, seconds: float) -> WaitLimit:
        """Return a limit of a wait [s]; a request to stop the run ends the wait as well."""
        return WaitLimit(seconds, self._stops_before)

    def lose(self, reason: str) -> None:
        """Forget the autopilot with a warning."""
        self.drop_peer()
        self._is_answer_due = False
        message = f"the connection to {self.autopilot} is lost: {reason}; the run continues without commands"
        hint = f"start {self.autopilot} again: simkit still listens. A longer wait: <simkit:peer_timeout>"
        self._once.warn("SK-PILOT-003", "lost", message, hint)

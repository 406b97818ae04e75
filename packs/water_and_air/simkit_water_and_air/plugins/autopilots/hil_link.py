"""TCP connection to PX4: MAVLink frames with the state of the vehicle out, actuator controls in."""

from __future__ import annotations

import socket
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from simkit_water_and_air.plugins.autopilots.autopilot_link import Address, AutopilotLink
from simkit_water_and_air.plugins.autopilots.mavlink import MavlinkDecoder, MavlinkMessage

if TYPE_CHECKING:
    from simkit.plugins.one_time_warnings import OneTimeWarnings
    from simkit_water_and_air.plugins.autopilots.bounded_wait import WaitLimit

CONTROLS: Final = "HIL_ACTUATOR_CONTROLS"

_CHUNK: Final = 1 << 16  # bytes read at a time
_MOST_CHUNKS: Final = 16  # chunks read in a step without a wait, so that a flood cannot stop the run


class HilLink(AutopilotLink):
    """Connection to PX4, the client of a TCP server.

    Args:
        name: name of the plugin.
        place: address and port.
        is_lock_step: True if every step waits for the answer to the last state.
        timeout: longest wait in lock-step [s].
        once: reporter of warnings.
        pace: longest wait for each step before the first command [s]. PX4 computes its first outputs some time after it
            has connected; without this wait, the run would be far ahead by then.

    Attributes:
        connections: number of connections so far.
    """

    autopilot = "PX4"

    def __init__(
        self, name: str, place: Address, is_lock_step: bool, timeout: float, once: OneTimeWarnings, pace: float
    ) -> None:
        super().__init__(name, place, is_lock_step, timeout, once)
        self.connections = 0
        self._pace = pace
        self._peer: socket.socket | None = None
        self._decoder = MavlinkDecoder()
        self._unsent = b""
        self._has_commands = False
        self._start_clock()

    @property
    def is_connected(self) -> bool:
        return self._peer is not None

    def open(self) -> None:
        opened = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            opened.bind(self._place)
            opened.listen(4)
            opened.setblocking(False)
        except BaseException:
            opened.close()
            raise
        self._socket = opened

    def drop_peer(self) -> None:
        if self._peer is not None:
            self._peer.close()
        self._peer, self._unsent, self._has_commands = None, b"", False
        self._decoder.clear()

    def drop_answer(self) -> None:
        self.next_controls()

    def _start_clock(self) -> None:
        # [µs] of the newest state, of its message, and the difference of both
        self._last_simulated, self._last_time, self._ahead = -1, -1, 0

    def clock(self, simulated: int, step: int) -> int:
        """Return the time for a message [µs]. It never goes back, because the clock of PX4 cannot.

        Args:
            simulated: simulated time [µs].
            step: physics step [µs].
        """
        if simulated <= self._last_simulated:  # after a reset or a restore
            self._ahead = self._last_time + step - simulated
        self._last_simulated, self._last_time = simulated, simulated + self._ahead
        return self._last_time

    def wait_for_peer(self, seconds: float) -> None:
        """Wait for a connection."""
        limit = self.limit(seconds)
        while self._socket is not None and self._peer is None and limit.wait([self._socket]):
            self._accept()

    def next_controls(self) -> MavlinkMessage | None:
        """Return the newest actuator controls; None if there are none.

        In lock-step, wait for the answer to the last state.
        """
        self._accept()
        if self._peer is None:
            return None
        seconds = 0.0
        if self._is_lock_step and self._is_answer_due:
            seconds = self._timeout if self._has_commands else self._pace
        limit = self.limit(seconds)
        controls = self._read(limit)
        if controls is None and self._has_commands and seconds and self._peer is not None and not limit.is_stopped:
            self.lose(f"no {CONTROLS} for {self._timeout:g} s")
        return controls

    def _accept(self) -> None:
        if self._socket is None:
            return
        for _ in range(_MOST_CHUNKS):
            try:
                accepted, address = self._socket.accept()
            except OSError:
                return
            if self._peer is not None and not self._has_ended():
                accepted.close()
                message = f"a second autopilot at {address[0]}:{address[1]} is refused"
                self._once.warn("SK-PILOT-004", "second", message, "give each vehicle its own <mavlink_tcp_port>")
                continue
            self.drop_peer()
            accepted.setblocking(False)
            with suppress(OSError):
                accepted.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._peer, self._is_answer_due, self.is_time_broken = accepted, False, False
            self.connections += 1
            self._start_clock()

    def _has_ended(self) -> bool:
        """Check whether the other side has closed the connection, so that a new one may take its place."""
        assert self._peer is not None
        try:
            return not self._peer.recv(1, socket.MSG_PEEK)
        except BlockingIOError:
            return False
        except OSError:
            return True

    def _read(self, limit: WaitLimit) -> MavlinkMessage | None:
        """Return the newest controls of the data that have arrived; wait for the first ones until the limit."""
        newest: MavlinkMessage | None = None
        chunks = 0
        while self._peer is not None and (self.limit(0.0) if newest else limit).wait([self._peer]):
            chunks += 1
            try:
                data = self._peer.recv(_CHUNK)
            except OSError:
                data = b""
            if not data:
                self.lose("PX4 has closed it")
                return newest
            for message in self._decoder.feed(data):
                if message.name == CONTROLS:
                    newest, self._is_answer_due, self._has_commands = message, False, True
            if self._decoder.damaged:
                what = "data that are not MAVLink, or are damaged, are ignored"
                self._once.warn("SK-PILOT-004", "data", what)
            if chunks >= _MOST_CHUNKS and (newest is not None or limit.is_over):
                break
        return newest

    def send(self, state: bytes) -> None:
        """Send frames; they are dropped as long as PX4 does not read the last ones."""
        if self._peer is None:
            return
        self._is_answer_due = True
        if self._unsent:
            self._flush()
            if not self.is_connected:
                return
        if self._unsent:
            self._once.warn("SK-PILOT-004", "full", "PX4 does not read; states are dropped")
            return
        self._unsent = state
        self._flush()

    def _flush(self) -> None:
        assert self._peer is not None
        try:
            while self._unsent:
                self._unsent = self._unsent[self._peer.send(self._unsent) :]
        except BlockingIOError:
            return
        except OSError:
            self.lose("PX4 has closed it")

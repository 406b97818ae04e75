"""UDP connection to ArduPilot: one peer, one packet per step in lock-step, and bounded waits."""

from __future__ import annotations

import socket
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from simkit.extend import counted
from simkit_water_and_air.plugins.autopilots.autopilot_link import Address, AutopilotLink
from simkit_water_and_air.plugins.autopilots.bounded_wait import WaitLimit
from simkit_water_and_air.plugins.autopilots.servo_packet import LONGEST, ServoPacket, decode_servo_packet

if TYPE_CHECKING:
    from simkit.plugins.one_time_warnings import OneTimeWarnings

_MOST_AT_ONCE: Final = 256  # datagrams read in a step without a wait, so that a flood cannot stop the run
_MOST_NEWER: Final = 32  # packets in a step without lock-step, of which the newest counts
_SHORT_WAIT: Final = 0.01  # [s] for a packet without lock-step, as in Gazebo


class ServoLink(AutopilotLink):
    """Connection to ArduPilot.

    Args:
        name: name of the plugin.
        place: address and port.
        is_lock_step: True if every step waits for a packet.
        timeout: longest wait in lock-step [s].
        once: reporter of warnings.
        channels: number of channels, 16 or 32.
        most_misses: without lock-step, number of steps without a packet after which the connection is lost.

    Attributes:
        peer: address of ArduPilot; None while there is no connection.
    """

    autopilot = "ArduPilot"

    def __init__(
        self,
        name: str,
        place: Address,
        is_lock_step: bool,
        timeout: float,
        once: OneTimeWarnings,
        channels: int,
        most_misses: int,
    ) -> None:
        super().__init__(name, place, is_lock_step, timeout, once)
        self.peer: Address | None = None
        self._channels, self._most_misses = channels, most_misses
        self._frame = -1
        self._misses = 0
        self._last_line = b""
        self._may_repeat = False  # whether the last state may be sent again in this step

    @property
    def is_connected(self) -> bool:
        return self.peer is not None

    def open(self) -> None:
        opened = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            opened.bind(self._place)
            opened.setblocking(False)
        except BaseException:
            opened.close()
            raise
        self._socket = opened

    def drop_peer(self) -> None:
        self.peer, self._misses = None, 0

    def drop_answer(self) -> None:
        self.next_packet()

    def wait_for_peer(self, seconds: float) -> ServoPacket | None:
        """Wait for the first packet; None at the end of the wait."""
        return self._receive(self.limit(seconds))

    def next_packet(self) -> ServoPacket | None:
        """Return the packet for the next step; None if there is none.

        In lock-step with a connection, wait for the answer to the last state. Without lock-step, return the newest
        packet.
        """
        self._may_repeat = True
        if self.peer is None:
            return self._receive(self.limit(0.0))
        if self._is_lock_step:
            if not self._is_answer_due:
                return None
            limit = self.limit(self._timeout)
            packet = self._receive(limit)
            if packet is None and not limit.is_stopped:
                self.lose(f"no packet for {self._timeout:g} s")
            return packet
        packet = newest = self._receive(self.limit(_SHORT_WAIT))
        for _ in range(_MOST_NEWER):
            if newest is None:
                break
            packet, newest = newest, self._receive(self.limit(0.0))
        self._misses = 0 if packet is not None else self._misses + 1
        if self._misses > self._most_misses:
            self.lose(f"no packet in {counted(self._misses, 'step')}")
        return packet

    def send(self, state: bytes) -> None:
        self._last_line, self._is_answer_due = state, True
        self._send_again()

    def _send_again(self) -> None:
        if self._socket is not None and self.peer is not None and self._last_line:
            with suppress(OSError):  # the peer has ended, or its queue is full: the wait for its answer decides
                self._socket.sendto(self._last_line, self.peer)

    def _receive(self, limit: WaitLimit) -> ServoPacket | None:
        """Return the next valid packet of the peer, or of a new peer while there is none; None at the limit."""
        read = 0
        while self._socket is not None and limit.wait([self._socket]):
            read += 1
            try:
                packet = self._check(*self._socket.recvfrom(LONGEST))
            except OSError:  # the system reports that the peer has closed its socket
                packet = None
            if packet is not None:
                return packet
            if read >= _MOST_AT_ONCE and limit.is_over:
                return None
        return None

    def _check(self, data: bytes, address: Address) -> ServoPacket | None:
        packet = decode_servo_packet(data, self._channels)
        if isinstance(packet, str):
            hint = (
                "set <have_32_channels> to 1 if SERVO_32_ENABLE is 1, and to 0 otherwise" if "magic" in packet else ""
            )
            self._once.warn("SK-PILOT-004", "packet", f"a packet is ignored: {packet}", hint)
            return None
        if self.peer is None:
            self.peer, self._last_line, self._is_answer_due, self._misses = address, b"", False, 0
        elif address != self.peer:
            message = f"packets of a second autopilot at {address[0]}:{address[1]} are ignored"
            hint = "give each vehicle its own <fdm_port_in>"
            self._once.warn("SK-PILOT-004", "second", message, hint)
            return None
        elif packet.frame == self._frame:
            if self._is_lock_step and self._may_repeat:
                self._may_repeat = False  # once a step: several answers to one frame would begin a second exchange
                self._send_again()  # ArduPilot repeats a frame if it has not received the answer
            return None
        self._frame, self._is_answer_due = packet.frame, False
        return packet

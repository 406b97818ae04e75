"""Poses of all bodies at the last ticks, for sensors whose measurement lasts several steps."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt


class PoseRows(NamedTuple):
    """Poses of all bodies at consecutive ticks, as raw bytes, which take a third of the time of array copies.

    Attributes:
        first: tick of the first row.
        positions: positions [m] at each tick; the bytes of an array (nbody, 3).
        quaternions: orientations (w, x, y, z) at each tick; the bytes of an array (nbody, 4).
    """

    first: int
    positions: tuple[bytes, ...]
    quaternions: tuple[bytes, ...]

    def arrays(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the positions [m], shape (ticks, nbody, 3), and the quaternions, shape (ticks, nbody, 4)."""
        count = len(self.positions)
        positions = np.frombuffer(b"".join(self.positions)).reshape(count, -1, 3)
        return positions, np.frombuffer(b"".join(self.quaternions)).reshape(count, -1, 4)


class PoseHistory:
    """Record of the poses of all bodies at the last ticks.

    A step leaves the poses of the tick before it in MuJoCo's data, so that a record costs two copies of memory.
    """

    def __init__(self) -> None:
        self._lengths: dict[object, int] = {}
        self._positions: deque[bytes] = deque(maxlen=0)
        self._quaternions: deque[bytes] = deque(maxlen=0)
        self._next = -1

    def require(self, user: object, ticks: int) -> None:
        """Keep the poses of at least this number of ticks for a user."""
        self._lengths[user] = ticks
        self._resize()

    def release(self, user: object) -> bool:
        """Forget a user, and check whether other users remain."""
        self._lengths.pop(user, None)
        self._resize()
        return bool(self._lengths)

    def _resize(self) -> None:
        length = max(self._lengths.values(), default=0)
        if length != self._positions.maxlen:
            self._positions, self._quaternions = deque(self._positions, length), deque(self._quaternions, length)

    def add(self, tick: int, data: mujoco.MjData) -> None:
        """Add the poses of a tick; a tick that does not follow the last one begins a new record."""
        if tick != self._next:
            self.clear()
        self._positions.append(data.xpos.tobytes())
        self._quaternions.append(data.xquat.tobytes())
        self._next = tick + 1

    def clear(self) -> None:
        """Forget all poses, because the bodies have changed."""
        self._positions.clear()
        self._quaternions.clear()

    def rows(self, first: int, tick: int, data: mujoco.MjData) -> PoseRows:
        """Return the poses from a tick to the present one.

        The first row is later than `first` if the bodies have changed since.

        Args:
            first: first tick.
            tick: present tick.
            data: data of the present tick with up-to-date poses.
        """
        if self._next != tick:  # the present state does not follow from the recorded ones
            self.clear()
        count = len(self._positions)
        skipped = max(0, first - (tick - count))
        positions, quaternions = list(self._positions)[skipped:], list(self._quaternions)[skipped:]
        positions.append(data.xpos.tobytes())
        quaternions.append(data.xquat.tobytes())
        return PoseRows(min(tick, tick - count + skipped), tuple(positions), tuple(quaternions))

    def get_state(self) -> PoseRows:
        """Return all poses, for a snapshot."""
        return PoseRows(self._next - len(self._positions), tuple(self._positions), tuple(self._quaternions))

    def set_state(self, state: PoseRows) -> None:
        """Restore the poses of a snapshot."""
        self.clear()
        self._positions.extend(state.positions)
        self._quaternions.extend(state.quaternions)
        self._next = state.first + len(state.positions)

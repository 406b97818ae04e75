"""Calls into Python between the velocities and the forces of a forward pass that the engine makes by itself.

The engine has one such place, `mjcb_control`, for the whole process and all its threads. It is taken only while steps
need it. Meanwhile passes of others come by as well, also of models that are being compiled and that Python has no
objects of; so the place is taken in C, where passes are told apart by the addresses of their data, and not by
`mujoco.set_mjcb_control`, which cannot stand such passes. What was there before is called as well.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Final

import mujoco

_Control = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


class _Callback:
    """Function that is called for some data.

    Attributes:
        error: what it raised, which cannot pass through the engine.
    """

    def __init__(self, call: Callable[[], None]) -> None:
        self._call, self._is_busy = call, False
        self.error: BaseException | None = None

    def __call__(self) -> None:
        if self._is_busy or self.error is not None:
            return
        self._is_busy = True
        try:
            self._call()
        except BaseException as error:  # noqa: BLE001 - also an interrupt
            self.error = error
        finally:
            self._is_busy = False


class _ControlCallback:
    """MuJoCo's one callback between velocities and forces, shared by all data of the process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._callbacks: dict[int, _Callback] = {}  # by the address of the data; each is of one thread
        self._previous: Callable[[int, int], None] | None = None
        self._function = _Control(self._call)
        self._address = ctypes.cast(self._function, ctypes.c_void_p).value

    def add(self, address: int, callback: _Callback) -> None:
        """Has a callback called in the forward passes of the data at an address."""
        with self._lock:
            if not self._callbacks:
                self._install()
            self._callbacks[address] = callback

    def remove(self, address: int) -> None:
        """Ends it."""
        with self._lock:
            del self._callbacks[address]
            if not self._callbacks:
                self._uninstall()

    def _call(self, model: int, data: int) -> None:
        previous, callback = self._previous, self._callbacks.get(data)
        if previous is not None:
            previous(model, data)
        if callback is not None:
            callback()

    def _install(self) -> None:
        there = _callback_pointer().value
        self._previous = None if there is None else _Control(there)
        _callback_pointer().value = self._address

    def _uninstall(self) -> None:
        pointer, previous = _callback_pointer(), self._previous
        if pointer.value == self._address:
            pointer.value = None if previous is None else ctypes.cast(previous, ctypes.c_void_p).value  # type: ignore[arg-type]
        self._previous = None


@cache
def _callback_pointer() -> ctypes.c_void_p:
    """Return the engine's pointer to its callback."""
    folder = Path(mujoco.__file__).parent
    library = next(path for pattern in ("libmujoco*", "mujoco.dll") for path in sorted(folder.glob(pattern)))
    return ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), "mjcb_control")


_CONTROL: Final = _ControlCallback()


@contextmanager
def call_before_forces(data: mujoco.MjData, call: Callable[[], None]) -> Iterator[None]:
    """Have a function called in every forward pass of some data; not in those that the function itself makes.

    What it raises is raised at the end; until then it is not called again.

    Args:
        data: of the engine; passes of others, on other threads, are left alone.
        call: may change the contacts and the references of constraints of these data.
    """
    address, mine = int(data._address), _Callback(call)
    _CONTROL.add(address, mine)
    try:
        yield
    finally:
        _CONTROL.remove(address)
    if mine.error is not None:
        raise mine.error

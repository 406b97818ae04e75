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


_lock = threading.Lock()
_callbacks: dict[int, _Callback] = {}
"""By the address of the data; each is of one thread."""

_previous: Callable[[int, int], None] | None = None


@contextmanager
def call_before_forces(data: mujoco.MjData, call: Callable[[], None]) -> Iterator[None]:
    """Have a function called in every forward pass of some data; not in those that the function itself makes.

    What it raises is raised at the end; until then it is not called again.

    Args:
        data: of the engine; passes of others, on other threads, are left alone.
        call: may change the contacts and the references of constraints of these data.
    """
    address, mine = int(data._address), _Callback(call)
    with _lock:
        if not _callbacks:
            _install()
        _callbacks[address] = mine
    try:
        yield
    finally:
        with _lock:
            del _callbacks[address]
            if not _callbacks:
                _uninstall()
    if mine.error is not None:
        raise mine.error


def _control(model: int, data: int) -> None:
    before, call = _previous, _callbacks.get(data)
    if before is not None:
        before(model, data)
    if call is not None:
        call()


_POINTER: Final = _Control(_control)
_ADDRESS: Final = ctypes.cast(_POINTER, ctypes.c_void_p).value


@cache
def _callback_pointer() -> ctypes.c_void_p:
    """Return the engine's pointer to its callback."""
    folder = Path(mujoco.__file__).parent
    library = next(path for pattern in ("libmujoco*", "mujoco.dll") for path in sorted(folder.glob(pattern)))
    return ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), "mjcb_control")


def _install() -> None:
    global _previous
    there = _callback_pointer().value
    _previous = None if there is None else _Control(there)
    _callback_pointer().value = _ADDRESS


def _uninstall() -> None:
    global _previous
    place = _callback_pointer()
    if place.value == _ADDRESS:
        place.value = None if _previous is None else ctypes.cast(_previous, ctypes.c_void_p).value  # type: ignore[arg-type]
    _previous = None

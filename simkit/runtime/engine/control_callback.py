"""Python callback between the velocities and the forces of a forward pass that MuJoCo makes by itself.

MuJoCo has one such callback, `mjcb_control`, for the whole process and all its threads. It is installed only while
steps need it. Other forward passes call it too, even for models that are being compiled and have no Python objects.
`mujoco.set_mjcb_control` cannot handle such passes. Therefore a C function is installed, which recognises the pass by
the address of its data. A callback that was installed before is still called.
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

from simkit.interrupts import defer_interrupts

_Control = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)


class _Callback:
    """Function that is called in the forward passes of one `MjData`.

    Attributes:
        error: exception that the function raised; it cannot pass through the engine.
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
        except BaseException as error:  # noqa: BLE001 - for example SystemExit in a plugin
            self.error = error
        finally:
            self._is_busy = False


class _ControlCallback:
    """MuJoCo's only callback between velocities and forces, shared by all data of the process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._callbacks: dict[int, _Callback] = {}  # by the address of the data; each data belongs to one thread
        self._previous: Callable[[int, int], None] | None = None
        self._function = _Control(self._call)
        self._address = ctypes.cast(self._function, ctypes.c_void_p).value

    def add(self, address: int, callback: _Callback) -> None:
        """Call a callback in the forward passes of the data at an address."""
        with self._lock:
            if not self._callbacks:
                self._install()
            self._callbacks[address] = callback

    def remove(self, address: int) -> None:
        """Stop calling the callback of the data at an address."""
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
        installed = _callback_pointer().value
        self._previous = None if installed is None else _Control(installed)
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
    """Call a function in every forward pass of one `MjData`, except in passes that the function itself makes.

    An exception of the function is raised at the end of the `with` block; the function is not called again before that.

    Args:
        data: engine data; forward passes of other data, on other threads, are not affected.
        call: function that may change the contacts and the references of constraints of these data.
    """
    address, callback = int(data._address), _Callback(call)
    with defer_interrupts():
        _CONTROL.add(address, callback)
        try:
            yield
        finally:
            _CONTROL.remove(address)
    if callback.error is not None:
        raise callback.error

"""Control of processes on every system: start and end child processes, and check whether a process has ended."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, Final

_SAFE_PATH: Final = "PYTHONSAFEPATH"
_TASKKILL_TIMEOUT: Final = 10.0  # [s]
_SYNCHRONIZE: Final = 0x0010_0000  # access right of Windows: wait for the end of a process
_ERROR_INVALID_PARAMETER: Final = 87  # error of Windows: no process has this number
_WAIT_OBJECT_0: Final = 0


def kill_process_tree(process: subprocess.Popen[bytes]) -> None:
    """Kill a process and its own child processes, which may outlive it. The caller waits for its end.

    Args:
        process: process that was started with `start_new_session=True`, so that its number is also the number of its
            process group. Windows has no process groups of this kind; there, `taskkill` follows the parent numbers.
    """
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
            return
    elif process.poll() is None:
        with suppress(OSError, subprocess.TimeoutExpired):
            subprocess.run(
                ["taskkill", "/F", "/T", "/PID", str(process.pid)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=_TASKKILL_TIMEOUT,
                check=False,
            )
    if process.poll() is None:
        with suppress(ProcessLookupError, PermissionError):
            process.kill()


def has_ended(number: int) -> bool:
    """Check whether the process with a number has ended; return False if the system does not say."""
    if number <= 0:  # for `os.kill`, such a number means a group of processes
        return False
    if os.name == "nt":  # on Windows, `os.kill` would end the process
        return _has_ended_on_windows(number)
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):
        return False
    return False


def _has_ended_on_windows(number: int) -> bool:
    import ctypes

    api: Any = ctypes
    kernel = api.WinDLL("kernel32", use_last_error=True)
    kernel.OpenProcess.restype = ctypes.c_void_p
    kernel.WaitForSingleObject.argtypes = [ctypes.c_void_p, ctypes.c_uint32]
    kernel.CloseHandle.argtypes = [ctypes.c_void_p]
    handle = kernel.OpenProcess(_SYNCHRONIZE, False, ctypes.c_uint32(number))
    if not handle:
        return bool(api.get_last_error() == _ERROR_INVALID_PARAMETER)
    try:
        return bool(kernel.WaitForSingleObject(handle, 0) == _WAIT_OBJECT_0)
    finally:
        kernel.CloseHandle(handle)


@contextmanager
def without_interrupts() -> Iterator[None]:
    """Start child processes that ignore Ctrl-C. The terminal sends it to them too, but the parent process ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # with the first child process, it would allow interrupts again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # child processes inherit the mask
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def safe_path() -> Iterator[None]:
    """Start child processes that import no file of the working directory, which `python -c` would search first."""
    before = os.environ.get(_SAFE_PATH)
    os.environ[_SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[_SAFE_PATH]
        else:
            os.environ[_SAFE_PATH] = before


def end_with_parent() -> None:
    """End this child process when its parent process ends for any reason."""
    import multiprocessing
    from multiprocessing.connection import wait

    parent = multiprocessing.parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, name="simkit ends with its parent", daemon=True).start()

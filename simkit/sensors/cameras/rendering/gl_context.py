"""The one OpenGL context of the process; its library is chosen before OpenGL is used."""

from __future__ import annotations

import atexit
import ctypes
import ctypes.util
import importlib
import importlib.util
import logging
import os
import sys
import threading
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol

import mujoco

from simkit.errors import RenderError
from simkit.interrupts import defer_interrupts
from simkit.runtime.engine.step_loop import stop_other_loops
from simkit.sensors.cameras.rendering import render_thread

WAYS_TO_GET_GL = "on Debian and Ubuntu: apt install libegl1 libopengl0 libgl1-mesa-dri (or libosmesa6)"
HINT = f"{WAYS_TO_GET_GL}, or draw with --renderer software; run `simkit doctor` for details"
_OFF = {"disable", "disabled", "off", "false", "0"}
_ON = {"", "enable", "enabled", "on", "true", "1"}
_LIBRARIES = {"egl": "egl", "osmesa": "osmesa", "glfw": "glfw", "glx": "glfw", "cgl": "cgl", "wgl": "glfw"}
"""Library of each renderer that `MUJOCO_GL` accepts."""

_FUNCTION_LIBRARIES = ("libOpenGL.so.0", "libGL.so.1", "libGLESv2.so.2")
"""Libraries in which PyOpenGL searches its functions when EGL provides the context; libEGL depends on none of them."""

_PLATFORM_DEVICE = 0x313F

_FORKED = (
    "this process was forked after its parent had drawn images, which the graphics library does not support; "
    "start it with multiprocessing's 'spawn' or 'forkserver', or fork before the first image"
)


class GpuMemoryHolder(Protocol):
    """Object that owns graphics memory, which must be freed before the graphics library is closed."""

    def uploaded(self) -> Sequence[mujoco.MjrContext]:
        """Return the MuJoCo contexts that the object owns."""

    def free(self) -> None:
        """Free the graphics memory."""


class _ProcessContext:
    """OpenGL context of this process and the state that depends on it.

    Attributes:
        context: the context; None before the first image and after the end.
        failure: error that every use raises from now on; None without an error.
        lock: lock held by the thread in which the context is current.
        description: description of the renderer; empty before the first image.
        holders: owners of graphics memory.
    """

    def __init__(self) -> None:
        self.context: Any = None
        self.failure: RenderError | None = None
        self.lock = threading.RLock()
        self.description = ""
        self.holders: weakref.WeakSet[GpuMemoryHolder] = weakref.WeakSet()

    @contextmanager
    def current(self) -> Iterator[None]:
        with defer_interrupts(), self.lock:
            if self.failure is not None:
                raise _copy(self.failure)  # a raised error would keep the simulations of its traceback alive
            if self.context is None:
                try:
                    self.context, self.description = _open()
                except RenderError as error:
                    self.failure = _copy(error)
                    raise
                atexit.register(self.close)
            with self.context.as_current():
                yield

    def close(self) -> None:
        """Free everything at exit before the libraries are closed; a context freed later writes to the terminal."""
        stop_other_loops()  # cameras of simulations that still run would find no context
        render_thread.end()
        with self.lock:  # a thread that is drawing finishes its image first
            if self.context is None:
                return
            for holder in list(self.holders):
                holder.free()
            context, self.context = self.context, None
            self.failure = RenderError("the interpreter is shutting down")
            context.free()

    def reset_after_fork(self) -> None:
        """Forbid drawing in a forked child, because the threads of the software renderer do not exist there."""
        self.lock = threading.RLock()  # another thread may have locked the old lock at the fork
        if self.context is None:
            return
        # these objects belong to the parent; the extra references keep the child's interpreter from freeing them
        for parent_object in (self.context, *(upload for holder in list(self.holders) for upload in holder.uploaded())):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(parent_object))
        terminate = getattr(sys.modules.get(type(self.context).__module__), "_terminate_display", None)
        if terminate is not None:
            atexit.unregister(terminate)
        self.context = None
        self.failure = RenderError("SK-RENDER-011", _FORKED)


def _copy(error: RenderError) -> RenderError:
    return RenderError(error.code, error.message)


_process = _ProcessContext()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_process.reset_after_fork)


@contextmanager
def current() -> Iterator[None]:
    """Make the context of the process current in this thread; the first use opens it.

    Other threads wait until the block ends. If a context of other code was current, it is current again afterwards.
    Interrupts are deferred until then.

    Raises:
        RenderError: no library provides a context; every call raises the same error without trying again.
    """
    with _process.current():
        yield


def ensure_open() -> None:
    """Open the context of the process, unless it is open.

    Raises:
        RenderError: no library provides a context; every call raises the same error without trying again.
    """
    if not is_open():
        with current():
            pass


def is_open() -> bool:
    """Check whether a context exists; there is none before the first image and after the end."""
    return _process.context is not None


def describe_renderer() -> str:
    """Return a text such as `llvmpipe (LLVM 15.0.6, 256 bits) through EGL`; empty before the first image."""
    return _process.description


def hold_memory(holder: GpuMemoryHolder) -> None:
    """Register an owner of graphics memory to be freed before the context closes; the reference to it is weak."""
    _process.holders.add(holder)


def find_library() -> str:
    """Return the library that would be used: egl, osmesa, glfw or cgl.

    Raises:
        RenderError: no library is usable; the message lists the problems and a remedy.
    """
    tried = []
    for name in _candidates():
        problem = _PROBES[name]()
        if not problem:
            return name
        tried.append(f"{name}: {problem}")
    raise RenderError(f"OpenGL cannot be opened ({'; '.join(tried)}); {HINT}")


def _candidates() -> tuple[str, ...]:
    requested = os.environ.get("MUJOCO_GL", "").strip().lower()
    platform = os.environ.get("PYOPENGL_PLATFORM", "").strip().lower()
    if requested in _OFF:
        raise RenderError(f"OpenGL is switched off by MUJOCO_GL={requested}; run `unset MUJOCO_GL`")
    if unknown := unknown_request():
        raise RenderError(f"{unknown}; {help_for_request()}")
    if requested in _LIBRARIES:
        return (_LIBRARIES[requested],)
    if sys.platform == "darwin":
        return ("cgl",)
    if sys.platform == "win32":
        return ("glfw",)
    return (platform,) if platform in ("egl", "osmesa") else ("egl", "osmesa")


def unknown_request() -> str:
    """Return the problem that `MUJOCO_GL` has a value that nobody knows; empty if the value is known."""
    requested = os.environ.get("MUJOCO_GL", "").strip().lower()
    is_known = requested in (*_LIBRARIES, *_ON, *_OFF)
    return "" if is_known else f"MUJOCO_GL={requested}: unknown renderer; expected {', '.join(_LIBRARIES)} or disable"


def help_for_request() -> str:
    """Return the remedy for an unknown value of `MUJOCO_GL`, with the values that work on this machine."""
    working = [name for name in ("egl", "osmesa", "glfw") if not _PROBES[name]()]
    return f"unset MUJOCO_GL; here {' and '.join(working) or 'none of them'} can draw"


def _egl_problem() -> str:
    """Return the reason why EGL provides no display on any device, or ""; the check bypasses PyOpenGL."""
    try:
        egl = ctypes.CDLL(ctypes.util.find_library("EGL") or "libEGL.so.1")
    except OSError:
        return "libEGL.so.1 not found"
    if not _is_any_loadable(_FUNCTION_LIBRARIES):
        return f"{_FUNCTION_LIBRARIES[0]} not found"
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    display_of = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return "the EGL library cannot list devices"
    devices, count = (ctypes.c_void_p * 16)(), ctypes.c_int32()
    query_devices = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)(query)
    if not query_devices(16, devices, ctypes.byref(count)) or count.value < 1:
        return "no EGL device (no driver is installed)"
    get = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_void_p)(display_of)
    egl.eglInitialize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    for device in devices[: count.value]:
        display = get(_PLATFORM_DEVICE, device, None)
        if display and egl.eglInitialize(display, None, None):
            return ""
    return "no EGL device can be initialised"


def _osmesa_problem() -> str:
    names = (ctypes.util.find_library("OSMesa"), "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")
    return "" if _is_any_loadable(names) else "libOSMesa not found"


def _is_any_loadable(names: Sequence[str | None]) -> bool:
    for name in filter(None, names):
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return True
    return False


def _glfw_problem() -> str:
    if importlib.util.find_spec("glfw") is None:
        return "the Python package glfw is not installed"
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return "there is no display; without a display only egl and osmesa work"
    return ""


_PROBES: dict[str, Callable[[], str]] = {
    "egl": _egl_problem,
    "osmesa": _osmesa_problem,
    "glfw": _glfw_problem,
    "cgl": lambda: "",
}


def _open() -> tuple[Any, str]:
    """Return a new context and the name of its renderer."""
    library = find_library()
    try:
        logging.getLogger("OpenGL.acceleratesupport").setLevel(logging.WARNING)  # hides messages about optional modules
        with _platform(library):
            context = importlib.import_module(f"mujoco.{library}").GLContext(16, 16)
            with context.as_current():
                name = _renderer_name()
    except Exception as error:
        # drivers raise various errors: ImportError, AttributeError, ctypes errors, GLError
        raise RenderError(f"OpenGL cannot be opened ({library}: {type(error).__name__}: {error}); {HINT}") from error
    return context, f"{name} through {'EGL' if library == 'egl' else library}"


@contextmanager
def _platform(library: str) -> Iterator[None]:
    """Set the variable that selects PyOpenGL's library, inside the `with` block; PyOpenGL reads it only at import."""
    previous = os.environ.get("PYOPENGL_PLATFORM")
    if library in ("egl", "osmesa"):
        os.environ["PYOPENGL_PLATFORM"] = library
    try:
        yield
    finally:
        if previous:
            os.environ["PYOPENGL_PLATFORM"] = previous


def _renderer_name() -> str:
    from OpenGL import GL

    name = GL.glGetString(GL.GL_RENDERER)
    if not name:
        raise RuntimeError("the context returns no renderer name")
    return str(name.decode())

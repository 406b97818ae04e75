"""The one OpenGL context of the process; its library is chosen before OpenGL is touched."""

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
from simkit.runtime.engine.step_loop import stop_other_loops
from simkit.sensors.cameras.rendering import render_thread

_HINT = "on Debian and Ubuntu: apt install libegl1 libgl1-mesa-dri (or libosmesa6); `simkit doctor` says more"
_OFF = {"disable", "disabled", "off", "false", "0"}
_ON = {"", "enable", "enabled", "on", "true", "1"}
_LIBRARIES = {"egl": "egl", "osmesa": "osmesa", "glfw": "glfw", "glx": "glfw", "cgl": "cgl", "wgl": "glfw"}
"""Library of each renderer that `MUJOCO_GL` may name."""

_PLATFORM_DEVICE = 0x313F

_FORKED = (
    "this process was forked from one that had drawn pictures already, and the graphics library does not survive that; "
    "start it with multiprocessing's 'spawn' or 'forkserver', or fork before the first picture"
)


class GpuMemoryHolder(Protocol):
    """Something that holds memory of the graphics library, which is given back before the library goes."""

    def uploaded(self) -> Sequence[mujoco.MjrContext]:
        """Return the MuJoCo contexts that it holds."""

    def free(self) -> None:
        """Give the memory back."""


class _ProcessContext:
    """The OpenGL context of this process and what depends on it.

    Attributes:
        context: None before the first picture and after the end.
        failure: raised at every use from now on.
        lock: held by the thread whose context it is at the moment.
        description: of the renderer; empty before the first picture.
        holders: of memory of the graphics library.
    """

    def __init__(self) -> None:
        self.context: Any = None
        self.failure: RenderError | None = None
        self.lock = threading.RLock()
        self.description = ""
        self.holders: weakref.WeakSet[GpuMemoryHolder] = weakref.WeakSet()

    @contextmanager
    def current(self) -> Iterator[None]:
        with render_thread.defer_interrupts(), self.lock:
            if self.failure is not None:
                raise self.failure
            if self.context is None:
                try:
                    self.context, self.description = _open()
                except RenderError as error:
                    self.failure = error
                    raise
                atexit.register(self.close)
            with self.context.as_current():
                yield

    def close(self) -> None:
        """Free everything at exit, before the libraries go: a context freed later writes to the terminal."""
        stop_other_loops()  # or their cameras would find the context gone
        render_thread.end()
        with self.lock:  # a thread that still runs draws to the end, and nothing more
            if self.context is None:
                return
            for holder in list(self.holders):
                holder.free()
            context, self.context = self.context, None
            self.failure = RenderError("the interpreter is shutting down")
            context.free()

    def reset_after_fork(self) -> None:
        """Forbid drawing in a forked child: the threads of the software renderer have stayed behind."""
        self.lock = threading.RLock()  # another thread may have held it
        if self.context is None:
            return
        # nobody may free what is the parent's: not even the interpreter, which would when the child ends
        for kept in (self.context, *(upload for holder in list(self.holders) for upload in holder.uploaded())):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(kept))
        terminate = getattr(sys.modules.get(type(self.context).__module__), "_terminate_display", None)
        if terminate is not None:
            atexit.unregister(terminate)
        self.context = None
        self.failure = RenderError(_FORKED, "SK-RENDER-011")


_process = _ProcessContext()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_process.reset_after_fork)


@contextmanager
def current() -> Iterator[None]:
    """Make the context of the process current in this thread; it is opened at the first use.

    Threads take turns; whatever context of somebody else's was current comes back afterwards. An interrupt waits
    until then.

    Raises:
        RenderError: no library gives one; the same error at every call, without trying again.
    """
    with _process.current():
        yield


def is_open() -> bool:
    """Whether there is a context (none before the first picture and after the end)."""
    return _process.context is not None


def describe_renderer() -> str:
    """`llvmpipe (LLVM 15.0.6, 256 bits) through EGL`; empty before the first picture."""
    return _process.description


def hold_memory(holder: GpuMemoryHolder) -> None:
    """Have the memory of a holder given back before the context closes; the holder itself is not kept alive."""
    _process.holders.add(holder)


def find_library() -> str:
    """Which library would be used: egl, osmesa, glfw or cgl.

    Raises:
        RenderError: none is usable; says what was tried and what helps.
    """
    tried = []
    for name in _candidates():
        problem = _PROBES[name]()
        if not problem:
            return name
        tried.append(f"{name}: {problem}")
    raise RenderError(f"no renderer for cameras ({'; '.join(tried)}); {_HINT}")


def _candidates() -> tuple[str, ...]:
    wanted = os.environ.get("MUJOCO_GL", "").strip().lower()
    platform = os.environ.get("PYOPENGL_PLATFORM", "").strip().lower()
    if wanted in _OFF:
        raise RenderError(f"rendering is switched off by MUJOCO_GL={wanted}; unset it")
    if wanted not in (*_LIBRARIES, *_ON):
        raise RenderError(f"MUJOCO_GL={wanted}: no such renderer, allowed is one of {', '.join(_LIBRARIES)}")
    if wanted in _LIBRARIES:
        return (_LIBRARIES[wanted],)
    if sys.platform == "darwin":
        return ("cgl",)
    if sys.platform == "win32":
        return ("glfw",)
    return (platform,) if platform in ("egl", "osmesa") else ("egl", "osmesa")


def _egl_problem() -> str:
    """Why EGL gives no display on any device; empty where it does. Asks the library itself, without PyOpenGL."""
    try:
        egl = ctypes.CDLL(ctypes.util.find_library("EGL") or "libEGL.so.1")
    except OSError:
        return "libEGL.so.1 not found"
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    display_of = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not display_of:
        return "the EGL library knows no devices"
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
    for name in (ctypes.util.find_library("OSMesa"), "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"):
        try:
            if name and ctypes.CDLL(name):
                return ""
        except OSError:
            continue
    return "libOSMesa not found"


def _glfw_problem() -> str:
    if importlib.util.find_spec("glfw") is None:
        return "the Python package glfw is not installed"
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return "there is no display, and without one only egl and osmesa draw"
    return ""


_PROBES: dict[str, Callable[[], str]] = {
    "egl": _egl_problem,
    "osmesa": _osmesa_problem,
    "glfw": _glfw_problem,
    "cgl": lambda: "",
}


def _open() -> tuple[Any, str]:
    """The context, and in words who draws with it."""
    library = find_library()
    try:
        logging.getLogger("OpenGL.acceleratesupport").setLevel(logging.WARNING)  # says nothing a user can use
        with _platform(library):
            context = importlib.import_module(f"mujoco.{library}").GLContext(16, 16)
            with context.as_current():
                name = _renderer_name()
    except Exception as error:
        # drivers fail in their own ways: ImportError, AttributeError, ctypes errors, GLError
        raise RenderError(f"no renderer for cameras ({library}: {type(error).__name__}: {error}); {_HINT}") from error
    return context, f"{name} through {'EGL' if library == 'egl' else library}"


@contextmanager
def _platform(library: str) -> Iterator[None]:
    """While it lasts, PyOpenGL is told the library that was chosen: whoever imports it decides for good."""
    kept = os.environ.get("PYOPENGL_PLATFORM")
    if library in ("egl", "osmesa"):
        os.environ["PYOPENGL_PLATFORM"] = library
    try:
        yield
    finally:
        if kept:
            os.environ["PYOPENGL_PLATFORM"] = kept


def _renderer_name() -> str:
    from OpenGL import GL

    name = GL.glGetString(GL.GL_RENDERER)
    if not name:
        raise RuntimeError("the context cannot be used")
    return str(name.decode())

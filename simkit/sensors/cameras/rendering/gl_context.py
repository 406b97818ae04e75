"""The one OpenGL context of the process: which library gives it is decided before OpenGL is touched."""

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
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from simkit.errors import RenderError
from simkit.sensors.cameras.rendering.render_thread import defer_interrupts

_HINT = "on Debian and Ubuntu: apt install libegl1 libgl1-mesa-dri (or libosmesa6); `simkit doctor` says more"
_OFF = {"disable", "disabled", "off", "false", "0"}
_ON = {"", "enable", "enabled", "on", "true", "1"}
_LIBRARY_CHOICES = {
    "egl": ("egl",),
    "osmesa": ("osmesa",),
    "glfw": ("glfw",),
    "glx": ("glfw",),
    "cgl": ("cgl",),
    "wgl": ("glfw",),
}
_PLATFORM_DEVICE = 0x313F

_FORKED = (
    "this process was forked from one that had drawn pictures already, and the graphics library does not survive that; "
    "start it with multiprocessing's 'spawn' or 'forkserver', or fork before the first picture"
)

_context: Any = None
_failure: RenderError | None = None
_lock = threading.RLock()
_description = ""


@contextmanager
def current() -> Iterator[None]:
    """The process's context, current in this thread while it lasts; opened at the first use.

    Threads take turns; whatever context of somebody else's was current comes back afterwards. An interrupt waits
    until then.

    Raises:
        RenderError: no library gives one; the same error at every call, without trying again.
    """
    global _context, _failure
    with defer_interrupts(), _lock:
        if _failure is not None:
            raise _failure
        if _context is None:
            try:
                _context = _open()
            except RenderError as error:
                _failure = error
                raise
            atexit.register(_close)
        with _context.as_current():
            yield


def is_open() -> bool:
    """Whether there is a context (none before the first picture and after the end)."""
    return _context is not None


def describe_renderer() -> str:
    """`llvmpipe (LLVM 15.0.6, 256 bits) through EGL`; empty before the first picture."""
    return _description


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
    if wanted not in (*_LIBRARY_CHOICES, *_ON):
        raise RenderError(f"MUJOCO_GL={wanted}: no such renderer, allowed is one of {', '.join(_LIBRARY_CHOICES)}")
    if wanted in _LIBRARY_CHOICES:
        return _LIBRARY_CHOICES[wanted]
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
    asked = ctypes.CFUNCTYPE(ctypes.c_uint32, ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)(query)
    if not asked(16, devices, ctypes.byref(count)) or count.value < 1:
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


def _open() -> Any:
    global _description
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
    _description = f"{name} through {'EGL' if library == 'egl' else library}"
    return context


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


def _close() -> None:
    """At exit, before the libraries go: a context freed later writes to the terminal."""
    global _context, _failure
    from simkit.runtime.engine.step_loop import stop_other_loops
    from simkit.sensors.cameras.rendering import render_thread, renderer

    stop_other_loops()  # or their cameras would find the context gone
    render_thread.end()
    with _lock:  # a thread that still runs draws to the end, and nothing more
        if _context is None:
            return
        renderer.free_all()
        context, _context = _context, None
        _failure = RenderError("the interpreter is shutting down")
        context.free()


def _reset_after_fork() -> None:
    """In a forked child: the threads of the software renderer have stayed behind, so that drawing would never end."""
    global _context, _failure, _lock
    _lock = threading.RLock()  # another thread may have held it
    if _context is None:
        return
    from simkit.sensors.cameras.rendering import renderer

    # nobody may free what is the parent's: not even the interpreter, which would when the child ends
    for kept in (_context, *renderer.all_uploads()):
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(kept))
    terminate = getattr(sys.modules.get(type(_context).__module__), "_terminate_display", None)
    if terminate is not None:
        atexit.unregister(terminate)
    _context = None
    _failure = RenderError(_FORKED, "SK-RENDER-011")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_reset_after_fork)

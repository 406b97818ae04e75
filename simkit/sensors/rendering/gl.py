"""The one OpenGL context of the process: which library gives it is decided before OpenGL is touched."""

from __future__ import annotations

import atexit
import ctypes
import ctypes.util
import importlib
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from simkit.errors import RenderError

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

_context: Any = None
_failure: RenderError | None = None
_turn = threading.RLock()
_description = ""


@contextmanager
def current() -> Iterator[None]:
    """The process's context, current in this thread while it lasts; opened at the first use.

    Threads take turns; whatever context of somebody else's was current comes back afterwards.

    Raises:
        RenderError: no library gives one; the same error at every call, without trying again.
    """
    global _context, _failure
    with _turn:
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


_PROBES: dict[str, Callable[[], str]] = {
    "egl": _egl_problem,
    "osmesa": _osmesa_problem,
    "glfw": lambda: "",
    "cgl": lambda: "",
}


def _open() -> Any:
    global _description
    library = find_library()
    try:
        logging.getLogger("OpenGL.acceleratesupport").setLevel(logging.WARNING)  # says nothing a user can use
        if library in ("egl", "osmesa"):
            os.environ.setdefault("PYOPENGL_PLATFORM", library)
        context = importlib.import_module(f"mujoco.{library}").GLContext(16, 16)
        with context.as_current():
            name = _renderer_name()
    except Exception as error:
        # drivers fail in their own ways: ImportError, AttributeError, ctypes errors, GLError
        raise RenderError(f"no renderer for cameras ({library}: {type(error).__name__}: {error}); {_HINT}") from error
    _description = f"{name} through {'EGL' if library == 'egl' else library}"
    logging.getLogger("simkit").info("renderer: %s", _description)
    return context


def _renderer_name() -> str:
    try:
        from OpenGL import GL

        return str(GL.glGetString(GL.GL_RENDERER).decode())
    except Exception:  # noqa: BLE001 - the name is only for the log
        return "OpenGL"


def _close() -> None:
    """At exit, before the libraries go: a context freed later writes to the terminal."""
    global _context, _failure
    from simkit.sensors.rendering import renderer

    renderer.free_all()
    context, _context = _context, None
    _failure = RenderError("the interpreter is shutting down")
    context.free()

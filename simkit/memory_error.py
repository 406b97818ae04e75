"""Recognition of errors that mean too little memory, whichever library raises them."""

from __future__ import annotations

import errno
import mmap
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from simkit.errors import SimkitError

CODE: Final = "SK-CORE-008"
# Address space [MiB] that the imports of NumPy and MuJoCo take, and what OpenBLAS takes for each thread. With less,
# OpenBLAS ends the process by itself.
_IMPORTS, _THREAD = 200, 40
# SciPy and OpenCV each have an OpenBLAS of their own. With too little memory for its threads, it tries without end or
# sends itself the signal of Ctrl-C.
_SCIPY: Final = frozenset(
    f"scipy.{name}" for name in ("linalg", "special", "sparse.linalg", "optimize", "integrate", "interpolate", "odr")
)
_WITH_OPENBLAS: Final = ((_SCIPY, 60), (frozenset({"cv2"}), 230))  # modules, and what they take beside threads [MiB]
_TEXTS: Final = (
    "could not allocate memory",  # MuJoCo
    "failed to allocate",
    "unable to allocate",
    "cannot allocate memory",
    "failed to map segment",  # the loader of shared libraries
    "memory allocation failed",  # libxml2
    "out of memory",
    "insufficient memory",  # OpenCV
    "can't start new thread",
    "bad_alloc",
)


class OutOfMemory(SimkitError, MemoryError):
    """End of the available memory, or of the memory that a limit allows."""

    code = CODE

    def __init__(self, reason: str = "") -> None:
        super().__init__(CODE, f"too little memory{f': {reason}' if reason else ''}", help=remedy())


def remedy() -> str:
    """Return what helps against too little memory, with the limit of this process if there is one."""
    limit = memory_limit()
    rest = "close other programs, or use a smaller world, fewer --jobs or smaller images"
    return f"raise the limit of this process (ulimit -v), now {limit >> 20} MiB; or {rest}" if limit else rest


def memory_limit() -> int:
    """Return the limit of the address space of this process [bytes]; 0 without one."""
    try:
        import resource
    except ImportError:  # Windows
        return 0

    limits = [resource.getrlimit(getattr(resource, name))[0] for name in ("RLIMIT_AS", "RLIMIT_DATA")]
    return min((limit for limit in limits if limit != resource.RLIM_INFINITY), default=0)


def check_memory_limit() -> None:
    """Raise OutOfMemory if a limit of the process is so small that NumPy and MuJoCo cannot be imported.

    With a limit, each later import of SciPy or OpenCV checks the memory that is left.
    """
    limit = memory_limit()
    if limit:
        least = _IMPORTS + _openblas_size()
        if limit < least << 20:
            raise OutOfMemory(f"simkit needs at least {least} MiB")
        if not any(isinstance(finder, _OpenBlasCheck) for finder in sys.meta_path):
            sys.meta_path.insert(0, _OpenBlasCheck())


class _OpenBlasCheck:
    """Check of the memory that is left before SciPy or OpenCV is imported, whichever module imports it."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> None:
        """Find nothing.

        Raises:
            OutOfMemory: the process may not have the memory that the library needs.
        """
        for users, size in _WITH_OPENBLAS:
            if name in users and users.isdisjoint(sys.modules):
                least = size + _openblas_size()
                try:
                    mmap.mmap(-1, least << 20).close()
                except (OSError, ValueError):
                    raise OutOfMemory(f"the import of {name} needs {least} MiB more") from None


def _openblas_size() -> int:
    """Return the address space [MiB] of one OpenBLAS for its threads."""
    threads = os.environ.get("OPENBLAS_NUM_THREADS", "")
    count = int(threads) if threads.isdecimal() and len(threads) < 4 else os.cpu_count() or 1
    return _THREAD * max(1, count)


def find_memory_error(error: BaseException) -> OutOfMemory | None:
    """Return the error for too little memory, if this is the cause of an exception."""
    seen: set[int] = set()
    cause: BaseException | None = error
    while cause is not None and id(cause) not in seen:
        seen.add(id(cause))
        if isinstance(cause, OutOfMemory):
            return cause
        if _is_memory_error(cause):
            return OutOfMemory()
        cause = cause.__cause__ or cause.__context__
    return None


@contextmanager
def memory_errors() -> Iterator[None]:
    """Convert the exceptions of a block that mean too little memory to OutOfMemory."""
    try:
        yield
    except Exception as error:
        memory_error = find_memory_error(error)
        if memory_error is None or memory_error is error:
            raise
        raise memory_error from error


def _is_memory_error(error: BaseException) -> bool:
    if isinstance(error, MemoryError):
        return True
    if isinstance(error, OSError):
        return error.errno == errno.ENOMEM
    if isinstance(error, SimkitError):
        return False
    text = str(error).lower()
    if "caught an unknown exception" in text:  # of MuJoCo's bindings, if the engine cannot allocate
        return memory_limit() > 0
    return any(part in text for part in _TEXTS)

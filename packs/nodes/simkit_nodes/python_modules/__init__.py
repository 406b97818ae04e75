"""Modules of Python that a program gets in a version of its own.

Some wait in simulated time, such as `time`. Others are Python's own modules, executed again for each program, such as
`threading`: they import the first ones, so that their locks and clocks are the program's. All others are shared.
"""

from __future__ import annotations

import os
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import module_from_spec
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit_nodes.shared_imports import import_shared

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

EXECUTED_AGAIN: Final = frozenset(
    (
        "_threading_local",
        "asyncio",
        "cmd",
        "code",
        "concurrent",
        "getpass",
        "logging",
        "multiprocessing",
        "queue",
        "random",
        "runpy",
        "sched",
        "secrets",
        "selectors",
        "socketserver",
        "threading",
        "timeit",
        "tty",
        "uuid",
    )
)
"""Modules of Python's library that are executed again for each program, with their submodules."""

CHANGED: Final = {
    "_queue": "queue_core_module",
    "_thread": "thread_module",
    "atexit": "atexit_module",
    "concurrent.futures": "executor_module",
    "cv2": "cv2_module",
    "cv2.aruco": "aruco_module",
    "datetime": "datetime_module",
    "fcntl": "terminal_module",
    "getpass": "terminal_module",
    "importlib": "importlib_module",
    "importlib.machinery": "importlib_module",
    "importlib.util": "importlib_module",
    "keyboard": "keyboard_module",
    "matplotlib": "matplotlib_module",
    "matplotlib.pyplot": "matplotlib_module",
    "msvcrt": "terminal_module",
    "multiprocessing": "multiprocessing_module",
    "numpy": "numpy_module",
    "numpy.core.numeric": "numpy_module",
    "os": "os_module",
    "pynput": "pynput_module",
    "pynput.keyboard": "pynput_module",
    "queue": "queue_module",
    "random": "random_module",
    "select": "select_module",
    "signal": "signal_module",
    "socket": "socket_module",
    "subprocess": "subprocess_module",
    "termios": "terminal_module",
    "threading": "threading_module",
    "time": "time_module",
    "uuid": "random_module",
}
"""File in this folder with the changes of a module: the names in `__all__`, and a function `adapt(module, program)`."""

MADE_HERE: Final = frozenset(("keyboard", "pynput", "pynput.keyboard"))
"""Changed modules that need not be installed."""

BLOCKED: Final = frozenset(("_asyncio",))
"""Parts in C of modules that are executed again; Python's library has the same in Python."""

TOP_LEVEL: Final = EXECUTED_AGAIN | BLOCKED | {"builtins", *(name.partition(".")[0] for name in CHANGED)}
"""Names of packages and modules for which `program_module` is responsible."""

_LIBRARY: Final = os.path.dirname(os.__file__)  # noqa: PTH120 - it may be a zip file


class ChangedModule(ModuleType):
    """Copy of a module with other names in it; names that the module gets later are visible too.

    Attributes:
        original: module of the process; None if it is not installed.
        hints: ends of the messages about missing names, by name.
    """

    original: ModuleType | None = None
    hints: ClassVar[dict[str, str]] = {}

    def __getattr__(self, name: str) -> Any:
        original = self.__dict__.get("original")
        if original is not None and not name.startswith("__") and hasattr(original, name):
            return getattr(original, name)
        hint = self.__dict__.get("hints", self.hints).get(name)
        raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}" + (f"; {hint}" if hint else ""))


def program_module(program: NodeProgram, name: str) -> ModuleType:
    """Return the module that a program gets for a dotted name, whose first part is in `TOP_LEVEL`.

    Raises:
        ModuleNotFoundError: there is no such module.
    """
    module = program.replaced.get(name)
    if module is not None:
        return module
    parent, _, child = name.rpartition(".")
    package = program_module(program, parent) if parent else None
    if name in program.replaced:  # the package has imported it
        return program.replaced[name]
    top = name.partition(".")[0]
    if name in BLOCKED:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    if top in EXECUTED_AGAIN:
        module = _execute_again(program, name, package)
    elif name in CHANGED:
        module = _copy(name)
        program.replaced[name] = module
    else:
        return import_shared(name)
    _change(program, module)
    if package is not None:
        setattr(package, child, module)
    return module


def _copy(name: str) -> ModuleType:
    try:
        original: ModuleType | None = import_shared(name)
    except ImportError:
        if name not in MADE_HERE:
            raise
        original = None
    module = ChangedModule(name, original.__doc__ if original else None)
    if original is not None:
        module.__dict__.update(vars(original))
        module.original = original
    elif name == "pynput":
        module.__path__ = []
    return module


def _execute_again(program: NodeProgram, name: str, package: ModuleType | None) -> ModuleType:
    spec: ModuleSpec | None = PathFinder.find_spec(name, [_LIBRARY] if package is None else list(package.__path__))
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    module = module_from_spec(spec)
    vars(module)["__builtins__"] = program.builtins
    program.replaced[name] = module
    if package is not None:  # now, because its submodules may import each other
        setattr(package, name.rpartition(".")[2], module)
    try:
        exec(spec.loader.get_code(name), vars(module))  # type: ignore[attr-defined]
    except BaseException:
        del program.replaced[name]
        raise
    return module


def _change(program: NodeProgram, module: ModuleType) -> None:
    file = CHANGED.get(module.__name__)
    if file is None:
        return
    source = import_shared(f"{__name__}.{file}")
    for name in getattr(source, "__all__", ()):
        setattr(module, name, unbound(getattr(source, name)))
    adapt = getattr(source, "adapt", None)
    if adapt is not None:
        adapt(module, program)


def unbound(function: object) -> Any:
    """Return a function that stays one as an attribute of a class, as functions in C do; any other object as it is."""
    return staticmethod(function) if isinstance(function, FunctionType) else function

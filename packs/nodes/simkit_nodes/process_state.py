"""State of the process that each program has for itself: modules, arguments, folders, environment, streams."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from types import ModuleType
from typing import Any

from simkit_nodes.program_streams import ProgramInput, ProgramOutput
from simkit_nodes.shared_imports import import_shared


class ProcessState:
    """Values that are in the process while a program has the turn.

    Args:
        argv: command line of the program.
        search_path: folders in which the program's modules are searched, before those of the process.
        streams: standard input, output and error output of the program.
        variables: variables of the environment that the program has, if the process does not have them.
        seed: seed of the functions of `numpy.random`.

    Attributes:
        modules: modules of the program by name, such as `__main__` and `rclpy`.
        argv: command line.
        search_path: folders with the program's own modules.
        uses_numpy: True after the program has imported NumPy, or a package that may use it.
    """

    def __init__(
        self,
        argv: list[str],
        search_path: list[str],
        streams: tuple[ProgramInput, ProgramOutput, ProgramOutput],
        variables: Mapping[str, str],
        seed: int,
    ) -> None:
        self.modules: dict[str, ModuleType] = {}
        self.argv, self.search_path = argv, search_path
        self._path = [*search_path, *sys.path]
        self._outputs = streams[1:]
        self._streams: tuple[Any, Any, Any] = streams
        self._hooks: tuple[Any, Any] = sys.excepthook, sys.displayhook
        self._folder = self._outer_folder = os.getcwd()  # noqa: PTH109 - Path takes four times as long
        encode, encode_value = os.environ.encodekey, os.environ.encodevalue
        self._changed_variables: dict[Any, Any] = {  # None for a variable that the program has removed
            encode(name): encode_value(value) for name, value in variables.items() if name not in os.environ
        }
        self._own_variables: set[Any] = set()  # those that the program itself has changed
        self._variables: dict[Any, Any] = {}
        self._variables_at_entry: dict[Any, Any] = {}
        self._outer_variables: dict[Any, Any] = {}
        self._outer_variables_at_entry: dict[Any, Any] | None = None
        self._hidden: set[str] = set()
        self._outer_modules: dict[str, ModuleType] = {}
        self._module_count = 0
        self.uses_numpy = False
        self._numpy_seed = seed
        self._numpy: dict[str, Any] | None = None
        self._outer_numpy: dict[str, Any] = {}
        self._outer_functions: tuple[Any, ...] = ()
        self._entered_numpy: dict[str, Any] | None = None  # names of `numpy.random` while they are those of the program
        self._outer: tuple[Any, ...] = ()

    def change(self, variables: Mapping[str, str], folder: str | None) -> None:
        """Give the program other variables of the environment, and another working directory, before its start."""
        for name, value in variables.items():
            key = os.environ.encodekey(name)
            self._changed_variables[key] = os.environ.encodevalue(value)
            self._own_variables.add(key)
        if folder is not None:
            self._folder = os.path.abspath(folder)  # noqa: PTH100 - Path takes four times as long

    def enter(self) -> None:
        """Replace the values of the process by those of the program."""
        self._outer = sys.argv, sys.path, (sys.stdin, sys.stdout, sys.stderr), (sys.excepthook, sys.displayhook)
        for output, outer in zip(self._outputs, (sys.stdout, sys.stderr), strict=True):
            output.outer = outer
        sys.argv, sys.path = self.argv, self._path
        sys.stdin, sys.stdout, sys.stderr = self._streams
        sys.excepthook, sys.displayhook = self._hooks
        modules = sys.modules
        for name in self._hidden:
            if name in modules:
                self._outer_modules[name] = modules.pop(name)
        for name in self.modules:
            if name in modules:
                self._outer_modules[name] = modules[name]
        modules.update(self.modules)
        self._module_count = len(modules)
        if self.uses_numpy:
            self._enter_numpy()
        if self._folder != self._outer_folder:
            with suppress(FileNotFoundError):  # another program has removed it
                os.chdir(self._folder)
        self._enter_environment()

    def leave(self) -> None:
        """Restore the values of the process, and store those of the program."""
        self.argv, self._path = sys.argv, sys.path
        self._streams = sys.stdin, sys.stdout, sys.stderr
        self._hooks = sys.excepthook, sys.displayhook
        sys.argv, sys.path, (sys.stdin, sys.stdout, sys.stderr), (sys.excepthook, sys.displayhook) = self._outer
        if len(sys.modules) != self._module_count:
            self._take_assigned_modules()
        for name in tuple(self.modules):
            module = sys.modules.pop(name, None)
            if module is None:
                del self.modules[name]  # its import failed, or the program has deleted it
            else:
                self.modules[name] = module
        sys.modules.update(self._outer_modules)
        self._outer_modules.clear()
        self._leave_numpy()
        try:
            self._folder = os.getcwd()  # noqa: PTH109 - Path takes four times as long
        except FileNotFoundError:  # the program has removed it; nothing can return to it
            self._folder = self._outer_folder
            os.chdir(self._outer_folder)
        if self._folder != self._outer_folder:
            os.chdir(self._outer_folder)
        self._leave_environment()

    # ------------------------------------------------------------------ environment

    def _enter_environment(self) -> None:
        """Let `os.environ` use the variables of the program: those of the process, with the program's changes.

        Code in C and other processes see those that the program itself has changed.
        """
        outer = self._outer_variables = _variables()
        if outer != self._outer_variables_at_entry:
            self._outer_variables_at_entry = outer.copy()
            changed = {**outer, **self._changed_variables}
            self._variables = {name: value for name, value in changed.items() if value is not None}
            self._variables_at_entry = self._variables.copy()
        _set_variables(self._variables)
        if self._own_variables:
            self._put_own_variables(self._variables)

    def _leave_environment(self) -> None:
        """Let `os.environ` use the variables of the process again, and store what the program has changed."""
        present, before = self._variables, self._variables_at_entry
        if present != before:
            changed = {name for name in {**before, **present} if before.get(name) != present.get(name)}
            self._changed_variables |= {name: present.get(name) for name in changed}
            self._own_variables |= changed
            self._variables_at_entry = present.copy()
        _set_variables(self._outer_variables)
        if self._own_variables:
            self._put_own_variables(self._outer_variables)

    def _put_own_variables(self, variables: Mapping[Any, Any]) -> None:
        for name in sorted(self._own_variables):
            value = variables.get(name)
            os.unsetenv(name) if value is None else os.putenv(name, value)

    # ------------------------------------------------------------------ modules

    def add_module(self, name: str, module: ModuleType) -> None:
        """Add a module to those of the program, which has the turn."""
        if name not in self.modules:
            if name in sys.modules and sys.modules[name] is not module:
                self._outer_modules.setdefault(name, sys.modules[name])
            elif name not in sys.modules:
                self._module_count += 1
        self.modules[name] = sys.modules[name] = module

    def hide_module(self, top: str) -> None:
        """Hide a module of the process, and its submodules, from the program, which has a module of that name."""
        for name in tuple(sys.modules):
            if (name == top or name.startswith(f"{top}.")) and name not in self.modules:
                self._hidden.add(name)
                self._outer_modules[name] = sys.modules.pop(name)
                self._module_count -= 1

    def _take_assigned_modules(self) -> None:
        """Find modules that the program itself has written into `sys.modules`, such as a stand-in for hardware."""
        added = max(0, len(sys.modules) - self._module_count)
        for name, module in tuple(sys.modules.items())[len(sys.modules) - added :]:
            package = sys.modules.get(name.partition(".")[0])
            if name not in self.modules and all(getattr(each, "__spec__", None) is None for each in (module, package)):
                self.modules[name] = module

    # ------------------------------------------------------------------ numpy.random

    def _enter_numpy(self) -> None:
        """Let the functions of `numpy.random` use a generator of the program; the shared one keeps its state."""
        random = getattr(sys.modules.get("numpy"), "random", None)
        if random is None:
            return
        if self._numpy is None:
            generator = random.RandomState(self._numpy_seed & 0xFFFFFFFF)
            names = [name for name in dir(generator) if not name.startswith("_") and name in vars(random)]
            self._numpy = {name: getattr(generator, name) for name in names}
            self._numpy["default_rng"] = self._make_default_rng(random.default_rng)
        self._entered_numpy = vars(random)
        functions = tuple(map(self._entered_numpy.__getitem__, self._numpy))
        if functions != self._outer_functions:
            self._outer_functions = functions
            self._outer_numpy = dict(zip(self._numpy, functions, strict=True))
        self._entered_numpy.update(self._numpy)

    def _make_default_rng(self, original: Any) -> Any:
        count = 0

        def default_rng(seed: Any = None) -> Any:
            nonlocal count
            count += seed is None
            return original((self._numpy_seed, count) if seed is None else seed)

        default_rng.__doc__ = original.__doc__
        return default_rng

    def _leave_numpy(self) -> None:
        if self._entered_numpy is not None:
            self._entered_numpy.update(self._outer_numpy)
            self._entered_numpy = None

    def note_import(self) -> None:
        """Give the program its own generator of `numpy.random`, if NumPy is there now."""
        if not self.uses_numpy and "numpy" in sys.modules:
            self.uses_numpy = True
            import_shared("numpy.random")  # NumPy imports it only at its first use
            self._enter_numpy()


def _variables() -> dict[Any, Any]:
    """Return the encoded variables of the environment as `os.environ` stores them; a copy of that takes 30 µs."""
    return os.environ._data  # type: ignore[attr-defined, no-any-return]


def _set_variables(variables: dict[Any, Any]) -> None:
    """Replace the variables of `os.environ`, and those of `os.environb`, which shares them."""
    os.environ._data = variables  # type: ignore[attr-defined]
    if os.supports_bytes_environ:
        os.environb._data = variables  # type: ignore[attr-defined]

"""Imports of a program: it gets modules with the names of ROS, its own files, and its own copies of modules that wait.

The modules of a program have their own `__import__`. Modules of the process, such as NumPy, are shared and import what
they always do.
"""

from __future__ import annotations

import builtins
import os
import sys
from collections.abc import Mapping, Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import resolve_name
from types import CodeType, FunctionType, ModuleType
from typing import TYPE_CHECKING, Any, Final

from simkit.msgs.interface_definitions import interface_names
from simkit.packs import is_shipped_module
from simkit_nodes.interfaces.interface_modules import FOLDERS, interface_module
from simkit_nodes.private_packages import is_installed, is_private
from simkit_nodes.python_modules import TOP_LEVEL, program_module
from simkit_nodes.ros_modules import ros_module
from simkit_nodes.shared_imports import SharedImports
from simkit_nodes.tasks import current_task

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

_LIBRARY: Final = os.path.dirname(os.__file__)  # noqa: PTH120 - it may be a zip file


class ProgramLoader(SourceFileLoader):
    """Loader of a module that belongs to a program."""

    program: NodeProgram

    def exec_module(self, module: ModuleType) -> None:
        """Execute the module with the imports of its program."""
        self.program.process.add_module(module.__name__, module)
        vars(module)["__builtins__"] = self.program.builtins
        code = self.get_code(module.__name__)
        if code is None:
            raise ImportError(f"no code for {module.__name__}", name=module.__name__)
        self.program.note_source(self.path)
        exec(code, vars(module))


class TableLoader(Loader):
    """Loader of a module that simkit makes."""

    def __init__(self, module: ModuleType, program: NodeProgram) -> None:
        self._module, self._program = module, program

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module."""
        return self._module

    def exec_module(self, module: ModuleType) -> None:
        """Note that the module belongs to the program."""
        self._program.process.add_module(module.__name__, module)


class ProgramFinder(MetaPathFinder):
    """Finder of the modules of the program that has the turn; finds nothing for other threads."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of a module of ROS or of the program; None for any other module."""
        task = current_task()
        return None if task is None or SharedImports.are_active else program_spec(task.program, name, path)


def program_spec(program: NodeProgram, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
    """Return the specification of a module that a program does not share with the process; None if it shares it.

    The program's own folders come first, then the modules of ROS and the interfaces that simkit has, then the search
    path, and then the other packages of the program's workspace.
    """
    with SharedImports.active():
        return _program_spec(program, name, path)


def _program_spec(program: NodeProgram, name: str, path: Sequence[str] | None) -> ModuleSpec | None:
    process = program.process
    own = process.search_path if path is None else [folder for folder in path if program.has_folder(folder)]
    spec = _spec_in(program, name, own)
    if spec is not None:
        return spec
    module = ros_module(name, program.flavour) or shipped_interfaces(program, name)
    if module is None and path is None:
        spec = _spec_in(program, name, [folder for folder in sys.path if folder not in own])
        spec = spec or _workspace_spec(program, name)
    elif module is None and path and name.rpartition(".")[0] in process.modules:
        spec = _spec_in(program, name, path)
    if spec is None and module is None:
        module = workspace_interfaces(program, name)
    if module is not None:
        return ModuleSpec(name, TableLoader(module, program), is_package=hasattr(module, "__path__"))
    return spec or (_folder_of(name, own) if path is None else None)


def _spec_in(program: NodeProgram, name: str, folders: Sequence[str]) -> ModuleSpec | None:
    """Return the specification of a module in folders, if the program does not share it with the process."""
    spec = PathFinder.find_spec(name, folders) if folders else None
    if spec is None or spec.loader is None:  # no module, or a folder without __init__.py
        return None
    origin = spec.origin or ""
    if is_installed(origin):
        if "." not in name and not is_private(name, spec):
            return None
    elif origin.startswith(_LIBRARY + os.sep) or is_shipped_module(name):
        return None
    if isinstance(spec.loader, SourceFileLoader):
        spec.loader = program.source_loader(spec.loader.name, spec.loader.path)
        return spec
    return spec if program.has_folder(os.path.dirname(origin)) else None  # noqa: PTH120 - a compiled module


def _workspace_spec(program: NodeProgram, name: str) -> ModuleSpec | None:
    """Return the specification of a module in another package of the workspace; None for a module of the process."""
    if name in sys.builtin_module_names or PathFinder.find_spec(name) is not None:
        return None
    folder = program.workspace.module_folder(name)
    if folder is None:
        return None
    program.module_roots.append(str(folder))
    return _spec_in(program, name, [str(folder)])


def shipped_interfaces(program: NodeProgram, name: str) -> ModuleType | None:
    """Return the module of interfaces that simkit ships; None for other packages."""
    package = name.partition(".")[0]
    if not any(known.startswith(f"{package}/") for kind in FOLDERS for known in interface_names(kind)):
        return None
    if program.workspace.package(package) is not None:
        if name == package and program.workspace.module_folder(name) is not None:
            return None  # the package has modules besides its interfaces, which another program has made known
        program.workspace.add_interfaces()  # simkit may have only some types of the package
    return interface_module(name, program.flavour)


def workspace_interfaces(program: NodeProgram, name: str) -> ModuleType | None:
    """Return the module of interfaces that a package of the workspace defines; None for other packages."""
    package, _, rest = name.partition(".")
    if (rest and rest.partition(".")[0] not in FOLDERS) or package in sys.stdlib_module_names:
        return None  # to search a large workspace takes a second
    if program.workspace.package(package) is None:
        return None
    program.workspace.add_interfaces()
    return interface_module(name, program.flavour)


def _folder_of(name: str, folders: Sequence[str]) -> ModuleSpec | None:
    """Return the specification of a folder without `__init__.py`, which Python imports if there is no such module."""
    spec = PathFinder.find_spec(name, folders)
    anywhere = PathFinder.find_spec(name)
    return None if anywhere is not None and anywhere.loader is not None else spec


_FINDER: Final = ProgramFinder()


def install_finder() -> None:
    """Add the finder to those of the process; it does nothing outside programs."""
    if _FINDER not in sys.meta_path:
        sys.meta_path.insert(0, _FINDER)


def program_builtins(program: NodeProgram) -> dict[str, Any]:
    """Return the built-in names of a program's modules, with its own `__import__`; they are its module `builtins`."""
    modules = program.process.modules
    is_shared: dict[str, bool] = {}  # by the name of a top-level module of the process

    def import_(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        package = _package_of(globals) if level else ""
        full = resolve_name("." * level + name, package) if package else name
        top = full.partition(".")[0]
        if top not in modules and bool(package) == bool(level):
            if isinstance(fromlist, list) and not level:  # compiled code, which reads sys.modules after the import
                return _import_shared(program, name, fromlist)
            if top in TOP_LEVEL and (top in program.replaced or not _has_file(program, top)):
                module = program_module(program, full)
                if fromlist:
                    _import_submodules(program, module, fromlist)
                    return module
                return module if level else program_module(program, top)
            if top not in is_shared:
                is_shared[top] = top in sys.builtin_module_names or program_spec(program, top, None) is None
                if not is_shared[top] and top in sys.modules:
                    program.process.hide_module(top)
            if is_shared[top] and not level:
                return _import_shared(program, name, fromlist or ())
        return builtins.__import__(name, globals, locals, fromlist or (), level)

    module = program.replaced["builtins"] = ModuleType("builtins")
    names = vars(module)
    names.update(vars(builtins), __import__=import_, input=program.read_input)
    return names


def _import_shared(program: NodeProgram, name: str, fromlist: Sequence[str]) -> ModuleType:
    """Import a module of the process; what it imports itself are modules of the process too."""
    try:
        with SharedImports.active():
            return builtins.__import__(name, {}, {}, fromlist, 0)
    finally:
        if name.partition(".")[0] not in sys.stdlib_module_names:
            program.process.note_import()


def _has_file(program: NodeProgram, name: str) -> bool:
    """Check whether a program has a file with the name of a module of Python's library, which it then imports."""
    spec = None if name in sys.builtin_module_names else PathFinder.find_spec(name, program.process.search_path)
    return spec is not None and spec.loader is not None


def _package_of(names: Mapping[str, object] | None) -> str:
    names = names or {}
    package = names.get("__package__")
    if isinstance(package, str):
        return package
    module = str(names.get("__name__", ""))
    return module if "__path__" in names else module.rpartition(".")[0]


def _import_submodules(program: NodeProgram, module: ModuleType, names: Sequence[str]) -> None:
    """Import the submodules among the names of `from MODULE import NAMES`."""
    if module.__name__ not in program.replaced or not hasattr(module, "__path__"):
        return
    for name in names:
        if name == "*":
            _import_submodules(program, module, [each for each in getattr(module, "__all__", ()) if each != "*"])
        elif not hasattr(module, name):
            try:
                program_module(program, f"{module.__name__}.{name}")
            except ModuleNotFoundError:
                continue  # Python itself then says which name is missing


def run_as_main(program: NodeProgram, code: CodeType, file: str, package: str | None) -> ModuleType:
    """Execute code as the module `__main__` of a program, and return the module."""
    module = ModuleType("__main__")
    names = vars(module)
    names.update(__file__=file, __builtins__=program.replaced["builtins"], __package__=package)
    program.process.add_module("__main__", module)
    program.note_source(file)
    exec(code, names)
    return module


def with_imports(program: NodeProgram, function: object) -> Any:
    """Return a function whose imports are those of a program; other objects are returned as they are."""
    if not isinstance(function, FunctionType):
        return function
    names = function.__globals__
    before = names.get("__builtins__", builtins)
    names["__builtins__"] = program.builtins  # a function takes the built-in names when it is made
    try:
        copy = FunctionType(function.__code__, names, function.__name__, function.__defaults__, function.__closure__)
    finally:
        names["__builtins__"] = before
    copy.__kwdefaults__ = function.__kwdefaults__
    return copy

"""Search for plugins written by users, only in entry points and in folders that the user allows."""

from __future__ import annotations

import ast
import importlib.util
import inspect
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import EntryPoint
from pathlib import Path
from types import ModuleType

from simkit.diagnostics import Diagnostics, closest, did_you_mean
from simkit.entry_points import entry_points_of
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.linked_files import hide_linked_text
from simkit.plugins.adapters import (
    describe_allowed_plugins,
    has_hooks,
    makes_systems,
    missing_system_pack,
    user_code_line,
)
from simkit.plugins.base import Plugin
from simkit.plugins.discovery.python_plugins import as_class
from simkit.plugins.plugin_folders import find_module, folder_help, is_inside, split_python_name
from simkit.plugins.plugin_names import ENTRY_POINT_GROUP, aliases, normalise
from simkit.scene import ScenePlugin

_siblings: dict[Path, dict[str, ModuleType]] = {}
"""Modules that plugins imported from their own folders, by folder and name."""


def find_user_plugin(plugin: ScenePlugin, paths: Sequence[Path], diagnostics: Diagnostics) -> type[Plugin] | None:
    """Return the class for `module:Class`, `file.py`, `file.py:Class` or a library name.

    The module must be installed or allowed. A Python plugin that is not found is an error. A library without a Python
    plugin is not reported.
    """
    named = split_python_name(plugin.filename)
    if named is None:
        return _find_by_alias(plugin, paths, diagnostics)
    for point in entry_points_of(ENTRY_POINT_GROUP):
        if point.value.replace(" ", "") == plugin.filename:
            return _load_entry_point(point, plugin, diagnostics)
    module_name, class_name = named
    module, file = _allowed_module(module_name, plugin, paths, diagnostics)
    if module is None:
        return None
    if class_name:
        return _named_class(module, class_name, file, plugin, diagnostics)
    return _only_class(module, plugin, diagnostics)


def find_user_class(named: ScenePlugin, paths: Sequence[Path], diagnostics: Diagnostics) -> type | None:
    """Return a class that need not be a plugin, such as a planner of a navigation server; None after an error.

    Args:
        named: description whose `filename` is `file.py:Class` or `package.module:Class`.
        paths: folders whose modules the user allows.
        diagnostics: collector of the problems.
    """
    module_name, _, class_name = named.filename.partition(":")
    module, file = _allowed_module(module_name, named, paths, diagnostics)
    named_class = getattr(module, class_name, None)
    if module is None or inspect.isclass(named_class):
        return named_class
    names = [name for name, cls in inspect.getmembers(module, inspect.isclass) if cls.__module__ == module.__name__]
    hint = did_you_mean(class_name, names) or ("classes: " + (", ".join(names) or "none"))
    diagnostics.error("SK-PLUGIN-008", f"plugin {named.name!r}: {file} has no class {class_name!r}", named.where, hint)
    return None


def find_user_class_by_name(named: ScenePlugin, paths: Sequence[Path], diagnostics: Diagnostics) -> type | None:
    """Return a class whose attribute `names` has a name of C++; None if no module in the allowed folders has one.

    Such a class need not be a plugin. Only modules whose text contains the name are imported; subfolders are not
    searched.

    Args:
        named: description whose `filename` is a name such as `my_package::MyPlanner` or `my_package/MyPlanner`.
        paths: folders whose modules the user allows.
        diagnostics: collector of the problems.
    """
    name = named.filename.replace("/", "::")
    spellings = {name, "/".join(name.rsplit("::", 1))}
    for folder in paths:
        for file in sorted(folder.glob("*.py")):
            if not is_inside(file, folder) or not spellings & _plain_literals(file):
                continue
            module = _import_file(file.stem, file, named, diagnostics)
            for cls in _own_classes(module) if module else ():
                names = getattr(cls, "names", ())
                names = (names,) if isinstance(names, str) else tuple(names)
                if name in (str(one).replace("/", "::") for one in names):
                    return cls
    return None


def _allowed_module(
    name: str, plugin: ScenePlugin, paths: Sequence[Path], diagnostics: Diagnostics
) -> tuple[ModuleType | None, Path]:
    """Return a module under a plugin path and its file; None after an error."""
    file_and_folder = find_module(name, paths)
    if file_and_folder is None:
        places = "under a plugin path" if name.endswith(".py") else "in an entry point or under a plugin path"
        kind = "file" if name.endswith(".py") else "module"
        message = f"plugin {plugin.filename!r} is not found: no {kind} {name!r} {places}"
        diagnostics.error("SK-PLUGIN-001", message, plugin.where, folder_help(name, plugin.where, paths))
        return None, Path()
    return _import_file(name, file_and_folder[0], plugin, diagnostics), file_and_folder[0]


def _named_class(
    module: object, name: str, file: Path, plugin: ScenePlugin, diagnostics: Diagnostics
) -> type[Plugin] | None:
    """Return the class of that name, or report the closest name."""
    if hasattr(module, name):
        return _checked_class(getattr(module, name), plugin, diagnostics)
    names = [cls.__name__ for cls in _classes_of(module)]
    hint = did_you_mean(name, names) or ("plugin classes: " + (", ".join(names) or "none"))
    diagnostics.error("SK-PLUGIN-008", f"plugin {plugin.filename!r}: {file} has no class {name!r}", plugin.where, hint)
    return None


def _only_class(module: object, plugin: ScenePlugin, diagnostics: Diagnostics) -> type[Plugin] | None:
    """Return the only plugin class of a module; if there are several, the class with the name of the plugin."""
    classes = _classes_of(module)
    matching = [c for c in classes if c.__name__ == plugin.name] or classes
    if len(matching) == 1:
        return as_class(matching[0])
    module_as_class = None if any(issubclass(c, Plugin) for c in classes) else as_class(module)
    if module_as_class is not None:
        return module_as_class
    names = [c.__name__ for c in classes]
    listed = ", ".join(names) or "none with a load method"
    message = f"{plugin.filename!r} needs one plugin class, or one named {plugin.name!r}; it has: {listed}"
    if names:
        hint = f'write filename="{plugin.filename}:{closest(plugin.name, names) or names[0]}"'
    else:
        hint = missing_system_pack([module, *_own_classes(module)])
    diagnostics.error("SK-PLUGIN-008", message, plugin.where, hint)
    return None


def _find_by_alias(plugin: ScenePlugin, paths: Sequence[Path], diagnostics: Diagnostics) -> type[Plugin] | None:
    """Search the names of entry points, then the plugin classes of the modules in the allowed folders.

    Subfolders are not searched.
    """
    names = set(aliases(plugin))
    for point in entry_points_of(ENTRY_POINT_GROUP):
        if normalise(point.name) in names:
            return _load_entry_point(point, plugin, diagnostics)
    for folder in paths:
        for file in sorted(folder.glob("*.py")):
            if not is_inside(file, folder) or not names & _string_literals(file):
                continue  # import only files that contain the name
            module = _import_file(file.stem, file, plugin, diagnostics)
            for cls in _classes_of(module) if module else ():
                if names & set(map(normalise, (*getattr(cls, "filenames", ()), *getattr(cls, "names", ())))):
                    return as_class(cls)
    return None


def _load_entry_point(point: EntryPoint, plugin: ScenePlugin, diagnostics: Diagnostics) -> type[Plugin] | None:
    try:
        loaded = point.load()
    except (Exception, SystemExit) as error:  # noqa: BLE001 - an installed package may raise anything
        message = f"plugin {plugin.filename!r}: loading entry point {point.name!r} ({point.value}) failed"
        diagnostics.error("SK-PLUGIN-008", f"{message}: {type(error).__name__}: {error}", plugin.where)
        return None
    return _checked_class(loaded, plugin, diagnostics)


def _string_literals(file: Path) -> set[str]:
    """Return all text literals of a Python file as normalised plugin names; the file is parsed, not executed."""
    return set(map(normalise, _plain_literals(file)))


def _plain_literals(file: Path) -> set[str]:
    """Return the short text literals of a Python file."""
    try:
        tree = ast.parse(read_input(file, TEXT_LIMIT), str(file))
    except (OSError, SyntaxError, ValueError):
        return set()
    texts = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant))
    return {text for text in texts if isinstance(text, str) and len(text) < 200}


def _import_file(name: str, file: Path, plugin: ScenePlugin, diagnostics: Diagnostics) -> ModuleType | None:
    """Import a file under a module name made from its path, so that it never replaces another module."""
    key = f"simkit_user_plugins.{file.resolve()}"
    if key in sys.modules:
        return sys.modules[key]
    spec = importlib.util.spec_from_file_location(key, file)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[key] = module
    hide_linked_text(file)
    try:
        with _sibling_modules(file.resolve().parent):
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a user's module may raise anything
        del sys.modules[key]
        message = f"plugin {plugin.filename!r}: importing {name!r} from {file} failed{user_code_line(error)}"
        diagnostics.error("SK-PLUGIN-008", f"{message}: {type(error).__name__}: {error}", plugin.where)
        return None
    return module


@contextmanager
def _sibling_modules(folder: Path) -> Iterator[None]:
    """Let a plugin's file import the modules of its folder by their plain names, while the file is imported.

    The names are removed afterwards, because another plugin's folder may have modules of the same names.
    """
    known = _siblings.setdefault(folder, {})
    for name, module in known.items():
        sys.modules.setdefault(name, module)
    before = {name for name in sys.modules if name not in known}
    sys.path.append(str(folder))  # the last place: no module of the folder replaces one of Python or of a package
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in [name for name in sys.modules if name not in before]:
            file = getattr(sys.modules[name], "__file__", None)
            if file and Path(file).parent == folder:
                known[name] = sys.modules.pop(name)


def _classes_of(module: object) -> list[type]:
    """Return the plugin classes that a module defines; systems only if no class is derived from `Plugin`."""
    classes = _own_classes(module)
    derived = [cls for cls in classes if issubclass(cls, Plugin) and not inspect.isabstract(cls)]
    if derived or makes_systems(module):
        return derived
    return [cls for cls in classes if has_hooks(cls)]


def _own_classes(module: object) -> list[type]:
    """Return the classes that a module defines, without those that it imports."""
    name = getattr(module, "__name__", "")
    return [cls for _, cls in inspect.getmembers(module, inspect.isclass) if cls.__module__ == name]


def _checked_class(candidate: object, plugin: ScenePlugin, diagnostics: Diagnostics) -> type[Plugin] | None:
    cls = as_class(candidate)
    if cls is None:
        message = f"{plugin.filename!r} is not {describe_allowed_plugins()}"
        diagnostics.error("SK-PLUGIN-008", message, plugin.where, missing_system_pack([candidate]))
    return cls

"""Python systems of gz-sim: `PythonSystemLoader` loads a module whose `get_system` returns a system."""

from __future__ import annotations

import ast
import hashlib
import importlib
import os
import re
import sys
import types
from importlib.metadata import entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import Options, OptionsOf, text
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.packs import is_shipped_module
from simkit.plugins.adapters import user_code_line
from simkit.plugins.plugin_folders import find_module, folder_help
from simkit.plugins.plugin_names import ENTRY_POINT_GROUP
from simkit_gz_python import import_hook
from simkit_gz_python.plugins.gz_system_plugin import GzSystem, System

if TYPE_CHECKING:
    from simkit.extend import SpecBuilder

VARIABLES: Final = ("GZ_SIM_SYSTEM_PLUGIN_PATH", "IGN_GAZEBO_SYSTEM_PLUGIN_PATH", "PYTHONPATH")
"""Environment variables with folders from which Python modules may be loaded."""

SHADOW: Final = "SIMKIT_SHADOW_GZ"
_NAME: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*\Z")


class PythonSystemLoaderOptions(Options):
    """Options of `PythonSystemLoader`."""

    module_name: str = text(required=True)


class PythonSystemLoader(GzSystem):
    """Loads `<module_name>` from the folders that the user allows, and runs the system that its `get_system()` returns.

    The search order is: the plugin paths, the folders of `GZ_SIM_SYSTEM_PLUGIN_PATH` and `PYTHONPATH`, then modules of
    installed packages with an entry point in the group `simkit.plugins`. With `<simkit:shadow_gz>`, simkit's `gz`
    modules take precedence over installed ones.
    """

    options = OptionsOf(PythonSystemLoaderOptions)
    filenames = ("gz-sim-python-system-loader-system",)
    names = ("gz::sim::systems::PythonSystemLoader",)

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        self._module_name = self.options.module_name
        default = os.environ.get(SHADOW, "") not in ("", "0")
        self.shadow = params.boolean("shadow_gz", default)
        self._module: types.ModuleType | None = None
        self._file: Path | None = None
        if not self._module_name:
            return
        if not _NAME.match(self._module_name):
            message = f"<module_name>{self._module_name}</module_name> is not the name of a Python module"
            params.error("SK-PLUGIN-080", message, "write the name as after `import`: without folder and without .py")
            return
        self._find(params)

    def _find(self, params: Params) -> None:
        """Find and import the module, or report why that is not possible."""
        folders = [path.absolute() for path in (*self.plugin_paths, *folders_of_environment())]
        file_and_folder = find_module(self._module_name, folders)
        if file_and_folder is not None:
            self._file, folder = file_and_folder
            if not has_get_system(self._file):
                message = f"{self._file} has no function get_system for PythonSystemLoader; the file is not run"
                params.error("SK-PLUGIN-081", message, "add def get_system(): return MySystem()")
                return
            self._import(params, folder, folders)
        elif self._module_name in {p.value.split(":")[0].strip() for p in entry_points(group=ENTRY_POINT_GROUP)}:
            self._import(params, None, folders)
        else:
            searched = ", ".join(map(str, folders)) or "no folder, because no folder is allowed"
            message = f"no module {self._module_name!r} for PythonSystemLoader; searched: {searched}"
            hint = folder_help(self._module_name, self.where, self.plugin_paths)
            params.diagnostics.error("SK-PLUGIN-080", message, self.where, hint)

    def _import(self, params: Params, folder: Path | None, folders: list[Path]) -> None:
        added = [str(f) for f in folders if str(f) not in sys.path]
        sys.path.extend(added)  # the module may import other modules of its folder
        try:
            with self.importing():
                name = self._module_name if folder is None else f"{_package_of(folder)}.{self._module_name}"
                importlib.invalidate_caches()  # the file may be newer than Python's folder cache
                self._module = importlib.import_module(name)
                self._report_installed(params)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - a user's module may raise anything
            message = f"importing {self._module_name!r}{user_code_line(error)} failed: {type(error).__name__}: {error}"
            params.error("SK-PLUGIN-082", message)
        finally:
            for path in added:
                sys.path.remove(path)

    def _report_installed(self, params: Params) -> None:
        """Report installed Gazebo modules that the import loaded instead of simkit's modules."""
        for name, module in sorted(sys.modules.items()):
            target = import_hook.module_behind(name)
            if not target or import_hook.is_shim(module) or is_shipped_module(name):
                continue
            place = getattr(module, "__file__", None) or "a package"
            message = f"module {name} is installed ({place}) and takes precedence over simkit's own"
            hint = f"add <simkit:shadow_gz>true</simkit:shadow_gz> or set {SHADOW}=1 to use simkit's"
            if target.endswith(".sim"):
                params.error("SK-PLUGIN-083", f"{message}; it cannot access a simulation of simkit", hint)
            else:
                params.diagnostics.note("SK-PLUGIN-083", message, self.where, hint)

    def code_objects(self) -> tuple[object, ...]:
        return super().code_objects() if self._module is None else (*super().code_objects(), self._module)

    def find_system(self) -> System:
        if self._module is None:
            return None
        system = self._module.get_system()
        if not any(callable(getattr(system, hook, None)) for hook in self.hooks):
            message = f"get_system() of {self._module_name!r} returns {type(system).__name__}, which has no hook"
            self.params.error("SK-PLUGIN-084", message, "define one of the hooks: " + ", ".join(self.hooks))
            return None
        return system


def folders_of_environment() -> list[Path]:
    """Return the existing folders in the environment variables; relative paths start at the working directory."""
    named = [part for variable in VARIABLES for part in os.environ.get(variable, "").split(os.pathsep) if part]
    return [Path(part) for part in dict.fromkeys(named) if Path(part).is_dir()]


def _package_of(folder: Path) -> str:
    """Return the package name for the modules of a folder; a separate package prevents conflicts with other modules."""
    name = f"simkit_gz_systems_{hashlib.sha1(str(folder.resolve()).encode(), usedforsecurity=False).hexdigest()[:16]}"
    if name not in sys.modules:
        package = types.ModuleType(name)
        package.__path__ = [str(folder)]
        sys.modules[name] = package
    return name


def has_get_system(file: Path) -> bool:
    """Check whether a file defines the name `get_system`, without running it; True also for invalid Python."""
    try:
        tree = ast.parse(read_input(file, TEXT_LIMIT), str(file))
    except (OSError, SyntaxError, ValueError):
        return True  # the import reports the error
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == "get_system":
            return True
        if isinstance(node, ast.Name) and node.id == "get_system" and isinstance(node.ctx, ast.Store):
            return True
        if isinstance(node, (ast.Import, ast.ImportFrom)) and any(
            (alias.asname or alias.name) in ("get_system", "*") for alias in node.names
        ):
            return True
    return False

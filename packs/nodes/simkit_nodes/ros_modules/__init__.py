"""Modules with the names of ROS packages, for programs: the folder `rclpy` here is what a program imports as `rclpy`.

Each file is a normal module of simkit; a program gets the names in its `__all__`. Programs of ROS 1 get the modules of
`ros1_modules`, and those of this folder that they do not have. A pack adds modules with a folder `launch_modules`.
"""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from simkit.packs import installed_packs
from simkit_nodes.interfaces import ROS1, ROS2, MessageFlavour

_FOLDERS: Final = {ROS1: ("ros1_modules", "ros_modules"), ROS2: ("ros_modules",)}
_PACKAGE: Final = Path(__file__).parent.parent
_SAME_PACKAGES: Final = {"ros_numpy": "ros2_numpy"}
"""Packages with the same modules as another one."""


class RosModule(ModuleType):
    """Module of a program; a submodule is imported when a program reads its name."""

    def __init__(self, name: str, text: str | None, flavour: MessageFlavour) -> None:
        super().__init__(name, text)
        self._flavour = flavour

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and source_of(f"{self.__name__}.{name}", self._flavour) is not None:
            return import_module(f"{self.__name__}.{name}")
        origin = _tables()[0].get((self.__name__, name))
        if origin is not None:
            return getattr(import_module(origin), name)
        raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")


@cache
def _tables() -> tuple[dict[tuple[str, str], str], dict[str, str]]:
    """Return names that a module has from another one, and modules with the same names as another one.

    The first table has the module that defines a name, by the other module and the name. The second one has the module
    of simkit by the name of a module that ROS has too.
    """
    names: dict[tuple[str, str], str] = {}
    same: dict[str, str] = {}
    for _, folder in _folders(ROS2):
        file = folder / "imported_names.toml"
        table = tomllib.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
        same.update(table.pop("same_modules", {}))
        names.update(
            ((module, name), origin)
            for module, origins in table.items()
            for origin, found in origins.items()
            for name in found
        )
    return names, same


@cache
def source_of(name: str, flavour: MessageFlavour) -> str | None:
    """Return the module of simkit for a dotted name such as `rclpy.node`; None if simkit has no such module."""
    parts = name.split(".")
    if not all(part.isidentifier() and not part.startswith("__") for part in parts):
        return None
    parts[0] = _SAME_PACKAGES.get(parts[0], parts[0])
    for package, folder in _folders(flavour):
        path = folder.joinpath(*parts)
        if path.with_suffix(".py").is_file() or (path / "__init__.py").is_file():
            return ".".join((package, *parts))
    same = _tables()[1].get(name)
    return None if same is None else source_of(same, flavour)


@cache
def _folders(flavour: MessageFlavour) -> tuple[tuple[str, Path], ...]:
    """Return the folders with modules for programs, each with the dotted name of its package."""
    own = [(f"{_PACKAGE.name}.{folder}", _PACKAGE / folder) for folder in _FOLDERS[flavour]]
    packs = [(f"{pack.package}.launch_modules", Path(pack.folder, "launch_modules")) for pack in installed_packs()]
    return tuple((name, folder) for name, folder in (*own, *packs) if folder.is_dir())


def ros_module(name: str, flavour: MessageFlavour) -> ModuleType | None:
    """Return a new module for a program; None if simkit has no module of that name, or only one beside its messages.

    Args:
        name: such as `rclpy.node`.
        flavour: ROS of the program.
    """
    source_name = source_of(name, flavour)
    if source_name is None:
        return None
    source = import_module(source_name)
    if getattr(source, "IS_OF_INTERFACES", False):
        return None  # its messages come from the definitions
    module = RosModule(name, source.__doc__, flavour)
    names = getattr(source, "__all__", ())
    for key in names:
        _rename(getattr(source, key), source_name, name)
    module.__dict__.update({key: getattr(source, key) for key in names}, __all__=list(names))
    if hasattr(source, "__path__"):
        module.__path__ = []
    return module


def _rename(value: object, source_name: str, name: str) -> None:
    """Give a class of simkit the module in which programs know it; tracebacks, `repr` and `pickle` show the name."""
    prefix = source_name.removesuffix(name)
    if isinstance(value, type) and value.__module__.startswith(prefix):
        value.__module__ = value.__module__.removeprefix(prefix)

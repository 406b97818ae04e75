"""Messages, services and actions that the packages of a program define: `.msg`, `.srv` and `.action` files.

The files of a workspace are only listed at first. A definition is read when a program uses it, with the definitions
that it uses: an error in a package that the program does not need does not stop it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from simkit.input_file import read_input_text
from simkit.msgs import own_interfaces
from simkit.msgs.definition_parser import PARTS, name_problem, parse_interface
from simkit.msgs.interface_definitions import interface_names
from simkit.msgs.interface_folders import definitions_in
from simkit.msgs.shipped_interfaces import shipped_parts
from simkit_nodes.interfaces import ros1_definitions

_files: dict[str, Path] = {}  # by interface: the file in the workspace that was added last
_defined: dict[str, Path] = {}
_LARGEST_FILE: Final = 1 << 20  # [bytes]


def add_workspace(folder: Path) -> list[str]:
    """Make the interfaces in a folder and below it known to programs.

    A definition of a type that simkit ships is left out. A type has one definition in a process: if two workspaces have
    different ones, the first that is used stays, and the use of the other one is an error.

    Args:
        folder: ROS package, workspace, or folder with such packages.

    Returns:
        Full names of the added interfaces, sorted.
    """
    added = {}
    for ros1_name, file in definitions_in(folder):
        name = ros1_definitions.ros2_name(ros1_name)
        if name not in added and name_problem(name) is None and shipped_parts(name) is None:
            added[name] = file
    _files.update(added)
    return sorted(added)


def names_in(package: str, kinds: tuple[str, ...]) -> list[str]:
    """Return the full names of all interfaces of a package, sorted by kind and name.

    Args:
        package: name of the package.
        kinds: `msg`, `srv` or `action`; their order is kept.
    """
    return [
        name
        for kind in kinds
        for name in sorted({*interface_names(kind), *_files})
        if name.startswith(f"{package}/{kind}/")
    ]


def package_is_known(package: str) -> bool:
    """Check whether any interface is in a package."""
    return bool(names_in(package, tuple(PARTS)))


def define(interface_name: str, *, is_ros1: bool = False) -> None:
    """Define an interface of a workspace, with all interfaces of workspaces that it uses, if that is not done yet.

    Args:
        interface_name: full name; an interface that is in no workspace is left alone.
        is_ros1: True to read the definition by the rules of ROS 1.

    Raises:
        InterfaceError: a definition has errors, or differs from one that is in use.
    """
    if _defined.get(interface_name) == _files.get(interface_name):
        return
    definitions: dict[str, str | Path] = {}
    waiting = [interface_name]
    while waiting:
        name = waiting.pop()
        if name not in _files or name in definitions:
            continue
        file = _files[name]
        try:
            text = read_input_text(file, _LARGEST_FILE, inside=file.parent)
        except (OSError, UnicodeDecodeError):
            text = ""
        if is_ros1:
            text = ros1_definitions.ros2_text(name, text)
        definitions[name] = text if is_ros1 and text else file  # errors name the file, if there is no other text
        parts, _ = parse_interface(name, text)
        waiting += [used for part in parts for _, used in part.used_types()]
    own_interfaces.add_definitions(definitions)
    _defined.update({name: _files[name] for name in definitions})

"""Flavour of ROS that a program is written for: ROS 1 if it imports `rospy`, else ROS 2."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import CodeType
from typing import Final, Literal

from simkit.input_file import read_input, read_input_text
from simkit.loaders.resources.ros_packages import enclosing_package
from simkit_nodes.syntax_tree import parsed

Flavour = Literal["ros1", "ros2"]

_MARKS: Final[dict[str, Flavour]] = {"rclpy": "ros2", "rospy": "ros1"}
"""Package that each program of a flavour imports."""

_LONGEST: Final = 1_000_000  # bytes of a package.xml

_IMPORT: Final = re.compile(r"^[ \t]*(?:import|from)[ \t]+([\w.]+)", re.MULTILINE)


def flavour_of(source: Path | Callable[[], object], folders: Iterable[str] = ()) -> Flavour:
    """Return the flavour of a program.

    The first import of `rclpy` or `rospy` decides. It is looked for in the file, and then in the modules of the program
    that the file imports. Without one, the build tool of the ROS package around the file decides.

    Args:
        source: Python file, or function.
        folders: folders in which the program's own modules are.
    """
    if isinstance(source, Path):
        return _flavour_of_file(source, [Path(folder) for folder in folders], set()) or _flavour_of_package(source)
    code = getattr(source, "__code__", None)
    return next((_MARKS[name] for name in _names(code) if name in _MARKS), "ros2") if code else "ros2"


def _flavour_of_file(file: Path, folders: list[Path], seen: set[Path]) -> Flavour | None:
    if file in seen:
        return None
    seen.add(file)
    names = list(_imports(file))
    for name in names:
        mark = _MARKS.get(name.partition(".")[0])
        if mark is not None:
            return mark
    for name in names:
        for module in _files_of(name.strip("."), [file.parent, *folders]):
            flavour = _flavour_of_file(module, folders, seen)
            if flavour is not None:
                return flavour
    return None


def _flavour_of_package(file: Path) -> Flavour:
    package = enclosing_package(file.parent)
    if package is None:
        return "ros2"
    text = read_input(package / "package.xml", _LONGEST, inside=package)
    return "ros1" if b"catkin" in text and b"ament" not in text else "ros2"


def _imports(file: Path) -> Iterator[str]:
    """Yield the names of the modules that a file imports, in the order of their lines."""
    text = read_input_text(file, errors="replace")
    try:
        tree = parsed(text)
    except (SyntaxError, ValueError):  # for example a file for Python 2
        yield from _IMPORT.findall(text)
        return
    statements = [node for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom))]
    for node in sorted(statements, key=lambda node: node.lineno):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        else:
            base = node.module or ""
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def _files_of(name: str, folders: Iterable[Path]) -> Iterator[Path]:
    for folder in folders:
        path = folder.joinpath(*name.split("."))
        yield from (file for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file())


def _names(code: CodeType) -> Iterator[str]:
    """Yield the global names of a function and of the functions in it."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)

"""Executables of ROS packages that are written in Python. Nothing is built, and no file of a package is run.

A package in a source tree has the executables that its `setup.py`, `setup.cfg` or `CMakeLists.txt` would install; an
installed package has those in `lib`. The executables of ROS 1 packages that nothing installs are found, too: `rosrun`
starts every executable file of a package.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.input_file import open_input, read_input
from simkit.trusted_folders import OutsideError, join_below
from simkit_nodes.cmake_file import Command, cmake_commands
from simkit_nodes.setup_file import console_scripts, scripts_of_ini, setup_arguments

_NAME: Final = re.compile(r"<name>\s*([A-Za-z0-9_.-]+)\s*</name>")
_DEPENDENCY: Final = re.compile(
    r"<(?:(?:buildtool_|build_|build_export_|exec_|run_|test_)?depend)\b[^>]*>\s*([A-Za-z0-9_.-]+)\s*</"
)
_INSTALL_KEYWORDS: Final = ("DESTINATION", "PROGRAMS", "FILES", "DIRECTORY", "TARGETS", "RENAME", "PERMISSIONS")
_INSTALL_KEYWORDS_OF_FOLDERS: Final = (
    *_INSTALL_KEYWORDS,
    "PATTERN",
    "FILES_MATCHING",
    "USE_SOURCE_PERMISSIONS",
    "REGEX",
)
_ROS1_FOLDERS: Final = ("nodes", "scripts", "src", "bin")
_SHEBANG: Final = re.compile(rb"#!.*python")
_LARGEST: Final = 1_000_000  # [bytes]


@dataclass(frozen=True)
class Executable:
    """Executable of a package.

    Attributes:
        package: name of the package.
        name: name of the executable.
        file: Python file.
        module: module that has the function, such as `my_package.follower`; empty to run the file itself.
        function: function that the executable calls; empty to run the file itself.
        root: folder in which the module is searched.
    """

    package: str
    name: str
    file: Path
    module: str = ""
    function: str = ""
    root: Path | None = None


def package_name(package: Path) -> str:
    """Return the name in a folder's `package.xml`, or the name of the folder."""
    try:
        match = _NAME.search(read_input(package / "package.xml", _LARGEST, inside=package).decode(errors="replace"))
    except OSError:
        match = None
    return match[1] if match else package.name


def dependencies_of(package: Path) -> list[str]:
    """Return the names of the packages that a `package.xml` depends on, each once, in their order."""
    try:
        text = read_input(package / "package.xml", _LARGEST, inside=package).decode(errors="replace")
    except OSError:
        return []
    plain = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    return list(dict.fromkeys(match[1] for match in _DEPENDENCY.finditer(plain)))


def executables_of(package: Path) -> dict[str, Executable]:
    """Return the Python executables of a package by name, sorted.

    Args:
        package: folder of the package, in a source tree or `share/NAME`.
    """
    name = package_name(package)
    executables: dict[str, Executable] = {}
    for executable in (*_scripts(package, name), *_installed(package, name), *_of_cmake(package, name)):
        executables.setdefault(executable.name, executable)
    if not executables:
        executables = {executable.name: executable for executable in _of_ros1(package, name)}
    return dict(sorted(executables.items()))


def compiled_executables_of(package: Path) -> list[str]:
    """Return the names of the executables that a package builds from C++, sorted; they cannot run without ROS."""
    commands = cmake_commands(package, package_name(package))
    return sorted({command.words[0] for command in commands if command.name == "add_executable" and command.words})


def python_folders(package: Path) -> list[Path]:
    """Return the folders of a package from which its Python modules are imported after its installation."""
    name = package_name(package)
    folders = [package, package / "src"]
    package_dir = setup_arguments(package).get("package_dir", {})
    if isinstance(package_dir, dict):
        folders += [below for text in package_dir.values() if (below := _below(package, str(text))) is not None]
    for command in cmake_commands(package, name):
        texts = command.after("PACKAGE_DIR", "VERSION", "SETUP_CFG", "DESTINATION", "SCRIPTS_DESTINATION")
        if command.name == "ament_python_install_package":
            folders += [below.parent for text in texts if (below := _below(package, text)) is not None]
    return list(dict.fromkeys(folder for folder in (*folders, *module_folders(package)) if folder.is_dir()))


def module_folders(package: Path) -> list[Path]:
    """Return the folders of a package whose files CMake installs as Python modules."""
    folders = []
    for command in cmake_commands(package, package_name(package)):
        target = "".join(command.after("DESTINATION")[:1])
        if command.name == "install" and "site-packages" in target:
            for text in command.after("DIRECTORY", *_INSTALL_KEYWORDS_OF_FOLDERS):
                below = _below(package, text)
                if below is not None and text.endswith("/"):
                    folders.append(below)
    return folders


# ---------------------------------------------------------------------- sources of executables


def _scripts(package: Path, name: str) -> Iterator[Executable]:
    """Yield the entry points and the scripts of `setup.py` and `setup.cfg`."""
    yield from _entry_points(name, console_scripts(package), python_folders(package))
    scripts = setup_arguments(package).get("scripts", [])
    for text in scripts if isinstance(scripts, list) else []:
        yield from _file(package, name, str(text))


def _installed(package: Path, name: str) -> Iterator[Executable]:
    """Yield the executables of an installed package, in `PREFIX/lib/NAME`."""
    if package.parent.name != "share":
        return
    library = package.parents[1] / "lib"
    for folder in sorted(library.glob("python3*/site-packages")):
        for file in sorted(folder.glob(f"{name}-*/entry_points.txt")):
            scripts = scripts_of_ini(read_input(file, _LARGEST).decode(errors="replace"))
            yield from _entry_points(name, scripts, [folder])
    for file in sorted((library / name).glob("*")):
        if _is_python(file):
            yield Executable(name, file.name, file)


def _of_cmake(package: Path, name: str) -> Iterator[Executable]:
    """Yield the programs that CMake installs in `lib/NAME`."""
    for command in cmake_commands(package, name):
        if not _is_for_programs(command, name):
            continue
        renamed = command.after("RENAME")[:1]
        for text in command.after("PROGRAMS", *(word for word in _INSTALL_KEYWORDS if word != "PROGRAMS")):
            yield from _file(package, name, text, *renamed)
        for text in command.after("DIRECTORY", *_INSTALL_KEYWORDS_OF_FOLDERS):
            folder = _below(package, text)
            for file in sorted(folder.glob("*")) if folder is not None else ():
                yield from _file(package, name, file.relative_to(package).as_posix())


def _is_for_programs(command: Command, name: str) -> bool:
    if command.name == "catkin_install_python":
        return True
    target = "".join(command.after("DESTINATION")[:1]).strip("/")
    return command.name == "install" and target in (f"lib/{name}", f"libexec/{name}")


def _of_ros1(package: Path, name: str) -> Iterator[Executable]:
    """Yield the Python files that may be executed, as `rosrun` finds them."""
    for folder in (package, *(package / below for below in _ROS1_FOLDERS)):
        for file in sorted(folder.glob("*")):
            if _is_python(file) and os.access(file, os.X_OK):
                yield Executable(name, file.name, file)


def _entry_points(name: str, scripts: dict[str, str], folders: list[Path]) -> Iterator[Executable]:
    for script, target in scripts.items():
        module, _, function = target.partition(":")
        for folder in folders:
            file = _module_file(folder, module)
            if file is not None:
                yield Executable(name, script, file, module, function, folder)
                break


def _module_file(folder: Path, module: str) -> Path | None:
    base = folder.joinpath(*module.split("."))
    return next((file for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()), None)


def _file(package: Path, name: str, text: str, renamed: str = "") -> Iterator[Executable]:
    file = _below(package, text)
    if file is not None and _is_python(file):
        yield Executable(name, renamed or file.name, file)


def _is_python(file: Path) -> bool:
    """Check whether a file is a Python program, by its name or its first line."""
    if not file.is_file():
        return False
    if file.suffix:
        return file.suffix == ".py"
    try:
        with open_input(file) as stream:
            return _SHEBANG.match(stream.read(100)) is not None
    except OSError:
        return False


def _below(package: Path, text: str) -> Path | None:
    try:
        return join_below(package, text.removeprefix(f"{package}/") or ".")
    except OutsideError:
        return None

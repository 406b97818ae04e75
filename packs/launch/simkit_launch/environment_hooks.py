"""Environment variables that the packages of a workspace set when it is sourced: files of `env-hooks` and `*.dsv`.

The files are read, not run: lines such as `prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/my_robot/models` of ROS 2,
and `: ${TURTLEBOT_BASE:=kobuki}`, `export NAME=value` and `ament_prepend_unique_value NAME …` of shell scripts.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from simkit.input_file import read_input_text

_FOLDERS: Final = ("env-hooks", "env_hooks", "hooks")
_PATTERNS: Final = (
    *("*.dsv", "*.dsv.in"),
    *(f"{folder}/*.{end}" for folder in _FOLDERS for end in ("dsv", "dsv.in")),
    *(f"{folder}/*.{shell}{end}" for folder in _FOLDERS for shell in ("sh", "bash") for end in ("", ".in", ".em")),
)
_LARGEST: Final = 1 << 20  # [bytes]
_DEFAULT: Final = re.compile(r"^\s*:\s+\"?\$\{(?P<name>\w+):?=(?P<value>.*)\}\"?\s*(?:#.*)?$")
_EXPORT: Final = re.compile(r"^\s*export\s+(?P<name>\w+)=(?P<value>.*?)\s*(?:\s#.*)?$")
_ADD: Final = re.compile(
    r"^\s*ament_(?P<operation>prepend|append)_unique_value\s+(?P<name>\w+)\s+\"?(?P<value>[^\"\s]+)\"?\s*$"
)
_PREFIX: Final = re.compile(r"^(?:@CMAKE_INSTALL_PREFIX@|\$\{?(?:AMENT_CURRENT_PREFIX|CMAKE_INSTALL_PREFIX)\}?)/")
_SOURCE_FOLDERS: Final = ("@(CMAKE_CURRENT_SOURCE_DIR)", "@CMAKE_CURRENT_SOURCE_DIR@")
_FIND: Final = re.compile(r"`rospack find (\w+)`|\$\(rospack find (\w+)\)")


def workspace_variables(packages: Mapping[str, Path]) -> dict[str, str]:
    """Return the variables that the packages of a workspace set, by name.

    Args:
        packages: folders of the packages by name.
    """
    variables: dict[str, str] = {}
    for name, folder in packages.items():
        for pattern in _PATTERNS:
            for file in sorted(folder.glob(pattern)):
                try:
                    text = read_input_text(file, _LARGEST, errors="replace", inside=folder)
                except OSError:
                    continue
                text = text.replace("@PROJECT_NAME@", name)
                if ".dsv" in file.name:
                    _add_dsv(text, folder, packages, variables)
                else:
                    _add_shell(text, folder, packages, variables)
    return variables


def _add_dsv(text: str, folder: Path, packages: Mapping[str, Path], variables: dict[str, str]) -> None:
    for line in text.splitlines():
        operation, _, rest = line.strip().partition(";")
        variable, _, value = rest.partition(";")
        if operation in ("set", "set-if-unset"):
            if operation == "set" or variable not in variables:
                variables[variable] = value
        elif operation.startswith(("prepend-non-duplicate", "append-non-duplicate")):
            _add_path(variables, variable, _installed_path(value, folder, packages), operation.partition("-")[0])


def _add_path(variables: dict[str, str], name: str, path: str | None, operation: str) -> None:
    known = [part for part in variables.get(name, "").split(os.pathsep) if part]
    if path is not None and path not in known:
        variables[name] = os.pathsep.join([path, *known] if operation == "prepend" else [*known, path])


def _installed_path(text: str, folder: Path, packages: Mapping[str, Path]) -> str | None:
    """Return the folder of the source tree that would be installed as `share/PACKAGE/…`; None for other folders.

    Args:
        text: folder below the prefix of an installation.
        folder: folder of the package whose file names it.
        packages: folders of the packages by name.
    """
    first, _, rest = _PREFIX.sub("", text).rstrip("/").partition("/")
    name, _, below = rest.partition("/")
    if first != "share" or (name and name not in packages):
        return None
    path = packages[name] / below if name else folder.parent
    return str(path) if path.is_dir() else None


def _add_shell(text: str, folder: Path, packages: Mapping[str, Path], variables: dict[str, str]) -> None:
    for line in text.splitlines():
        addition = _ADD.match(line)
        if addition is not None:
            path = _installed_path(addition["value"], folder, packages)
            _add_path(variables, addition["name"], path, addition["operation"])
            continue
        match = _DEFAULT.match(line) or _EXPORT.match(line)
        if match is None:
            continue
        value = _FIND.sub(lambda found: str(packages.get(found[1] or found[2], "")), match["value"].strip("\"'"))
        for source in _SOURCE_FOLDERS:
            value = value.replace(source, str(folder))
        parts = [part for part in value.split(os.pathsep) if not any(sign in part for sign in "$`@")]
        if parts:
            variables.setdefault(match["name"], os.pathsep.join(parts))

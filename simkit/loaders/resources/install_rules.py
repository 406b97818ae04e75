"""Rules by which a ROS package installs folders under other names, as its `CMakeLists.txt` states them.

With `install(DIRECTORY description/urdf DESTINATION share/NAME)`, the folder `description/urdf` becomes `urdf`.
Files of the package then name `package://robot/urdf/…`, which the source tree does not have.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simkit.input_file import read_input

_LARGEST: Final = 1_000_000  # [bytes]
_COMMENT: Final = re.compile(r"#[^\n]*")
_INSTALL: Final = re.compile(r"\binstall\s*\(\s*DIRECTORY\s+([^()]*)\)", re.IGNORECASE)
_PROJECT: Final = re.compile(r"\bproject\s*\(\s*([\w.-]+)", re.IGNORECASE)
_SHARE: Final = re.compile(r"(?:\$\{(?:CMAKE_INSTALL_PREFIX)\}/)?share/([\w.-]+|\$\{\w+\})/?(.*)")
_CATKIN_SHARE: Final = re.compile(r"\$\{CATKIN_PACKAGE_SHARE_DESTINATION\}/?(.*)")
_SOURCE_FOLDER: Final = re.compile(r"^\$\{(?:CMAKE_CURRENT_SOURCE_DIR|PROJECT_SOURCE_DIR)\}/")


def installed_sources(package: Path, inside: str) -> Iterator[str]:
    """Yield the paths in the source tree of a package that CMake would install at a path.

    Args:
        package: folder of the package.
        inside: path of a file or folder in the installed folder `share/NAME`, with slashes.
    """
    for target, source in _rules(package):
        if not target:
            yield f"{source}/{inside}"
        elif inside == target or inside.startswith(f"{target}/"):
            yield source + inside.removeprefix(target)


def _rules(package: Path) -> Iterator[tuple[str, str]]:
    """Yield the installed and the source folder of each rule that gives a folder another name."""
    try:
        text = read_input(package / "CMakeLists.txt", _LARGEST, inside=package).decode(errors="replace")
    except OSError:
        return
    text = _COMMENT.sub("", text)
    project = _PROJECT.search(text)
    name = project[1] if project else package.name
    for match in _INSTALL.finditer(text):
        words = [word.strip('"') for word in match[1].split()]
        if "DESTINATION" not in words[:-1]:
            continue
        at = words.index("DESTINATION")
        place = _place(words[at + 1].replace("${PROJECT_NAME}", name), name)
        for source in words[:at] if place is not None else ():
            source = _SOURCE_FOLDER.sub("", source)
            target = place if source.endswith("/") else f"{place}/{source.rpartition('/')[2]}".strip("/")
            source = source.strip("/")
            if target != source and source and "$" not in source:
                yield str(target), source


def _place(destination: str, name: str) -> str | None:
    """Return the path of a destination in `share/NAME`; None for another place."""
    catkin, share = _CATKIN_SHARE.fullmatch(destination), _SHARE.fullmatch(destination)
    if catkin is not None:
        return catkin[1].strip("/")
    return share[2].strip("/") if share is not None and share[1] == name else None

"""Search for definition files of messages, services and actions: in a folder of the user, and in ROS workspaces."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from simkit.input_file import read_input

_KINDS: Final = ("msg", "srv", "action")
_OTHER_FOLDERS: Final = frozenset(("build", "log", "node_modules", "__pycache__", "site-packages", "dist-packages"))
_IGNORE_MARKERS: Final = frozenset(("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"))
_DEEPEST: Final = 8  # levels of folders: workspace/install/package/share/package/msg
_PACKAGE_NAME = re.compile(rb"<name>\s*([A-Za-z0-9_.-]+)\s*</name>")


def definitions_in(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield the name and the file of each definition in a folder and below it, sorted by path.

    The package is the name in the nearest `package.xml`. Without that file it is the name of the folder that contains
    the file, or that contains the folder `msg`, `srv` or `action` with the file.
    """
    root = folder.resolve()
    for path, folders, files in os.walk(root):
        here = Path(path)
        depth = len(here.parts) - len(root.parts)
        is_ignored = here != root and not _IGNORE_MARKERS.isdisjoint(files)
        names = [] if depth >= _DEEPEST or is_ignored else folders
        folders[:] = sorted(name for name in names if not name.startswith(".") and name not in _OTHER_FOLDERS)
        for name in () if is_ignored else sorted(files):
            short, _, kind = name.rpartition(".")
            # older ROS distributions install `srv/Name_Request.msg` beside `srv/Name.srv`
            if kind in _KINDS and short and (here.name == kind or here.name not in _KINDS):
                yield f"{_package_of(here)}/{kind}/{short}", here / name


def _package_of(folder: Path) -> str:
    home = folder.parent if folder.name in _KINDS else folder
    for ancestor in (home, *home.parents[:3]):
        name = _package_xml_name(ancestor)
        if name:
            return name
    return home.name


def _package_xml_name(folder: Path) -> str:
    try:
        match = _PACKAGE_NAME.search(read_input(folder / "package.xml", 65536, inside=folder))
    except OSError:
        return ""
    return match[1].decode() if match else folder.name


def is_in_ros1_package(file: Path) -> bool:
    """Check whether the package of a definition file is built with catkin, the build tool of ROS 1."""
    for ancestor in file.resolve().parents[:4]:
        try:
            return b"catkin" in read_input(ancestor / "package.xml", 65536, inside=ancestor)
        except OSError:
            continue
    return False


def _prefixes() -> list[Path]:
    return [Path(p) for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]


def installed_file(package: str, file: str) -> Path | None:
    """Return a package's file in the first ROS workspace of `AMENT_PREFIX_PATH` that has it; None if none has it."""
    places = (prefix / "share" / package / file for prefix in _prefixes())
    return next((path for path in places if path.is_file()), None)


def installed_names() -> Iterator[str]:
    """Yield the name of each interface in the ROS workspaces of `AMENT_PREFIX_PATH`."""
    for prefix in _prefixes():
        for kind in _KINDS:
            for path in prefix.glob(f"share/*/{kind}/*.{kind}"):
                yield f"{path.parent.parent.name}/{kind}/{path.stem}"

"""Known nodes: executables of ROS packages in C++ for which a pack has a program, or which have no effect here.

Each pack may have a file `known_nodes.toml` in the folder of its package:

    ["tf2_ros/static_transform_publisher"]
    program = "programs/static_transform_publisher.py"
    also = ["tf/static_transform_publisher"]

    ["rqt_*/*"]
    nothing = "use the page of --web"

A program is a Python file that a node of ROS could be, relative to the folder of the package. It imports `rclpy` or
`rospy` as all programs do, other files in its folder as its own modules, and modules of packs by their full names. The
latter are shared by all programs and must not import modules of ROS at their top level.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from typing import Final

from simkit.packs import Pack, installed_packs, warn_of_pack

FILE: Final = "known_nodes.toml"
_KEYS: Final = frozenset(("program", "also", "nothing", "ends", "world", "loads_controllers"))


@dataclass(frozen=True)
class KnownNode:
    """Executable of a ROS package for which a pack has a program.

    Attributes:
        name: name `PACKAGE/EXECUTABLE`; in a table also a shell pattern for names.
        pack: name of the pack.
        file: Python file of the program; None for an executable that has no effect.
        nothing: reason why the executable has no effect; empty for a program.
        ends: True if an executable that has no effect ends at once; by default it runs until the end of the run.
        world: world that a launch file with this node runs in if it starts no simulator; empty for any.
        loads_controllers: texts of which one is in an argument of a node that loads controllers; an empty text is in
            any. The robots of such a run start without controllers.
    """

    name: str
    pack: str
    file: Path | None = None
    nothing: str = ""
    ends: bool = False
    world: str = ""
    loads_controllers: tuple[str, ...] = ()

    def is_loading_controllers(self, arguments: Sequence[str]) -> bool:
        """Check whether the node loads controllers, given the words of its command line."""
        return any(text in word for text in self.loads_controllers for word in ("", *arguments))

    @property
    def executable(self) -> str:
        """Name of the executable without its package."""
        return self.name.rpartition("/")[2]


def known_node(name: str) -> KnownNode | None:
    """Return the known node with a name `PACKAGE/EXECUTABLE`; None without one.

    An exact name comes before a pattern, and a pack of another distribution before those that simkit ships.
    """
    exact, patterns = _tables(installed_packs())
    found = exact.get(name) or next((node for node in patterns if fnmatchcase(name, node.name)), None)
    return None if found is None else replace(found, name=name)


def known_node_names() -> list[str]:
    """Return the names and patterns of all known nodes, sorted."""
    exact, patterns = _tables(installed_packs())
    return sorted({*exact, *(node.name for node in patterns)})


@lru_cache(maxsize=4)
def _tables(packs: tuple[Pack, ...]) -> tuple[dict[str, KnownNode], tuple[KnownNode, ...]]:
    """Return the known nodes by exact name, and those with a pattern in the order of their search."""
    exact: dict[str, KnownNode] = {}
    patterns: list[KnownNode] = []
    for pack in sorted(packs, key=lambda pack: pack.is_shipped):
        for node in _nodes_of(pack):
            if any(sign in node.name for sign in "*?["):
                patterns.append(node)
            else:
                exact.setdefault(node.name, node)
    return exact, tuple(patterns)


def _nodes_of(pack: Pack) -> Iterator[KnownNode]:
    """Yield the known nodes of a pack; a fault in the table of a pack is reported, and the entry is left out."""
    path = Path(pack.folder, FILE)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        warn_of_pack(pack.package, f"{path}: {error}")
        return
    for name, entry in table.items():
        fault = _fault(path.parent, name, entry)
        if fault:
            warn_of_pack(pack.package, f"{path}: [{name}] {fault}")
            continue
        file = path.parent / entry["program"] if "program" in entry else None
        values = {key: entry[key] for key in ("nothing", "ends", "world") if key in entry}
        loads = tuple(entry.get("loads_controllers", ()))
        node = KnownNode(name, pack.name, file, loads_controllers=loads, **values)
        yield from (replace(node, name=each) for each in (name, *entry.get("also", ())))


def _fault(folder: Path, name: str, entry: object) -> str:
    """Return what is wrong with an entry of a table; an empty text if it is valid."""
    if not isinstance(entry, dict):
        return "is no table"
    unknown = sorted(entry.keys() - _KEYS)
    if unknown:
        return f"has no key {unknown[0]!r}; allowed: {', '.join(sorted(_KEYS))}"
    if ("program" in entry) == ("nothing" in entry):
        return "needs either 'program' or 'nothing'"
    also = entry.get("also", [])
    if not isinstance(also, list) or not all(isinstance(each, str) for each in also):
        return "needs a list of names for 'also'"
    wrong = [each for each in (name, *also) if each.count("/") != 1]
    if wrong:
        return f"has the name {wrong[0]!r}; expected PACKAGE/EXECUTABLE"
    if "program" in entry and not (isinstance(entry["program"], str) and (folder / entry["program"]).is_file()):
        return f"has no file {entry['program']}"
    if "nothing" in entry and not (isinstance(entry["nothing"], str) and entry["nothing"]):
        return "needs a text for 'nothing'"
    texts = entry.get("loads_controllers", [])
    if not isinstance(texts, list) or not all(isinstance(each, str) for each in texts):
        return "needs a list of texts for 'loads_controllers'"
    if not isinstance(entry.get("world", ""), str):
        return "needs a name of a world for 'world'"
    return "" if isinstance(entry.get("ends", False), bool) else "needs true or false for 'ends'"

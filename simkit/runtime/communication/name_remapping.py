"""Other names for topics, services and actions of a world, as of the option `--remap OLD:=NEW`.

Only what plugins and sensors open is renamed. Scripts, nodes and other processes use the new names.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from simkit.errors import InputError
from simkit.msgs.topic_names import absolute_name, valid_topic


class NameRemapping:
    """New names by old ones.

    Args:
        names: new names by old ones; a missing leading slash is added to both.

    Attributes:
        names: absolute new names by old ones.
        used: old names that the world has used.

    Raises:
        InputError: SK-CLI-018 a name is not valid.
    """

    def __init__(self, names: Mapping[str, str] = MappingProxyType({})) -> None:
        self.names: dict[str, str] = {}
        for old, new in names.items():
            for name in (old, new):
                if not name.strip("/") or valid_topic(name) != absolute_name(name):
                    text = f"--remap: {old}:={new} has the invalid name {name!r}"
                    raise InputError("SK-CLI-018", text, help="write absolute names: --remap /scan:=/robot/scan")
            self.names[absolute_name(old)] = absolute_name(new)
        self.used: set[str] = set()

    def new_name(self, name: str) -> str:
        """Return the new name of an absolute name; the name itself if it has none."""
        return self.names.get(name, name)

    def use(self, name: str) -> str:
        """Return the new name of an absolute name that the world opens."""
        new = self.names.get(name)
        if new is None:
            return name
        self.used.add(name)
        return new


def type_conflict(types: Iterable[tuple[str, ...]]) -> str:
    """Return the text for types of which no two ends of a topic have one in common; empty without a conflict."""
    known: list[tuple[str, ...]] = []
    for kinds in types:
        for others in known:
            if not set(kinds) & set(others):
                return f"one end has the type {' or '.join(others)}, another one {' or '.join(kinds)}"
        known.append(kinds)
    return ""

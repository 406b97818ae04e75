"""Definitions of messages, services and actions of simkit and its packs, and of rosbags for ROS 2 Jazzy.

The definition of a simkit type is the file `definitions/<package>/<msg, srv or action>/<Name>.<msg, srv or action>`,
in this folder or in the folder `msgs` of a pack. It has the published fields, constants and default values in the
published order. The hash of a type depends on field names, types and order, and not on constants and defaults;
`tests/msgs/published_interfaces.py` compares these as well.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Final

from simkit.msgs.definition_parser import PARTS, UNKNOWN_TYPE, MessageDefinition, name_problem, parse_interface
from simkit.packs import Pack, foreign_packs, shipped_packs, warn_of_pack

_FOLDER: Final = os.path.join(os.path.dirname(__file__), "definitions")  # noqa: PTH118, PTH120 (pathlib takes 3 ms)
PACKAGES_WITH_LONG_NAMES: Final = frozenset(
    (
        "example_interfaces",
        "kobuki_msgs",
        "nav2_msgs",
        "osrf_gear",
        "simulation_interfaces",
    )
)
"""Packages that repeat names of other packages, such as `Trigger`; a class of another package has the short name."""
NO_FIELD: Final = "structure_needs_at_least_one_member"
"""Name of the only field of a type that has no fields."""
_ROSBAGS_DEFAULTS: Final[dict[str, dict[str, object]]] = {
    "geometry_msgs/msg/Quaternion": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    "rcl_interfaces/msg/ParameterDescriptor": {"read_only": False, "dynamic_typing": False},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},  # STATUS_UNKNOWN
    "type_description_interfaces/msg/FieldType": {"type_id": 0},
}
"""Published default values of the types in rosbags, by type and field: rosbags has the fields without them."""


@cache
def definition_files() -> dict[str, str]:
    """Return the path of each definition file by the full name of its message, service or action.

    A pack of others with a definition that has errors, or that differs from another one, causes a warning, and the type
    is left out. A pack cannot replace a definition of the core or of rosbags.
    """
    shipped = [os.path.join(pack.folder, "msgs", "definitions") for pack in reversed(shipped_packs())]  # noqa: PTH118
    files = {name: file for folder in (*shipped, _FOLDER) for name, file in _definitions_in(folder)}
    for pack in foreign_packs():
        folder = os.path.join(pack.folder, "msgs", "definitions")  # noqa: PTH118
        added: dict[str, _ForeignDefinition] = {}
        for name, file in _definitions_in(folder):
            definition = _read_foreign(name, file, pack)
            if definition is not None and not _is_known(definition, files):
                added[name] = definition
        files |= {name: added[name].file for name in _with_known_types(added, files)}
    return files


def _definitions_in(folder: str) -> Iterator[tuple[str, str]]:
    """Yield the full name and the path of each definition file in a folder, sorted by name; skip all other files."""
    for package in _sorted_names(folder):
        for kind in PARTS:
            place = os.path.join(folder, package, kind)  # noqa: PTH118
            for file in _sorted_names(place):
                if file.endswith(f".{kind}"):
                    path = os.path.join(place, file)  # noqa: PTH118
                    yield f"{package}/{kind}/{file.removesuffix(f'.{kind}')}", path


def _sorted_names(folder: str) -> list[str]:
    try:
        return sorted(os.listdir(folder))  # noqa: PTH208
    except (FileNotFoundError, NotADirectoryError):
        return []


@dataclass(frozen=True)
class _ForeignDefinition:
    """Definition in a pack of another distribution.

    Attributes:
        name: full name of the message, service or action.
        file: path of its file.
        package: package of the pack.
        parts: definition of each part.
    """

    name: str
    file: str
    package: str
    parts: Sequence[MessageDefinition]

    def warn(self, line: int, code: str, text: str, hint: str = "") -> None:
        """Report that the definition is left out."""
        place = f"{self.file}:{line}" if line else self.file
        advice = f"; {hint}" if hint else ""
        warn_of_pack(self.package, f"{place}: {code} {text}{advice}; {self.name} is left out")


def _read_foreign(name: str, file: str, pack: Pack) -> _ForeignDefinition | None:
    """Read a definition of a pack of others; None, with a warning, if it has errors."""
    definition = _ForeignDefinition(name, file, pack.package, ())
    problem = name_problem(name)
    if problem is None:
        try:
            with open(file, encoding="utf-8") as stream:
                parts, problems = parse_interface(name, stream.read())
        except (OSError, ValueError) as error:
            definition.warn(0, "SK-INTERFACE-006", f"the definition cannot be read: {error}")
            return None
        if not problems:
            return replace(definition, parts=parts)
        problem = problems[0]
    definition.warn(problem.line, problem.code, problem.message, problem.hint)
    return None


def _is_known(definition: _ForeignDefinition, files: Mapping[str, str]) -> bool:
    """Check whether a type has a definition already; if it differs, report that."""
    name = definition.name
    if name in files:
        with open(files[name], encoding="utf-8") as stream:
            parts = tuple(parse_interface(name, stream.read())[0])
    elif name in rosbags_types():
        parts = _rosbags_parts(name)
    else:
        return False
    if [part.content for part in parts] != [part.content for part in definition.parts]:
        text = f"another definition than that of {files.get(name, 'ROS 2')}, which is used"
        definition.warn(0, "SK-INTERFACE-004", text)
    return True


def _with_known_types(added: Mapping[str, _ForeignDefinition], files: Mapping[str, str]) -> set[str]:
    """Return the names of those definitions whose fields have known types; report each other one."""
    valid, count = set(added), -1
    while count != len(valid):
        count = len(valid)
        known = {*files, *valid}
        for name in sorted(valid):
            definition = added[name]
            used = ((part.lines[field], type_) for part in definition.parts for field, type_ in part.used_types())
            wrong = next(((n, type_) for n, type_ in used if type_ not in known and type_ not in rosbags_types()), None)
            if wrong is not None:
                valid.remove(name)
                definition.warn(wrong[0], UNKNOWN_TYPE, f"unknown type {wrong[1]!r}")
    return valid


@cache
def foreign_message_types() -> frozenset[str]:
    """Return the message types whose definitions are in packs of other distributions."""
    folders, files = tuple(pack.folder for pack in foreign_packs()), definition_files()
    return frozenset(name for name, file in shipped_message_types().items() if files[file].startswith(folders))


@cache
def pack_message_types() -> frozenset[str]:
    """Return the message types whose definitions are in packs, also in those of other distributions."""
    files = definition_files()
    return frozenset(name for name, file in shipped_message_types().items() if not files[file].startswith(_FOLDER))


@cache
def definition_text(interface_name: str) -> str:
    """Return the text of the definition file of a message, service or action in `definitions/`."""
    with open(definition_files()[interface_name], encoding="utf-8") as file:
        return file.read()


@cache
def shipped_message_types() -> dict[str, str]:
    """Return the interface of each message type in `definitions/`."""
    return {f"{name}{part}": name for name in definition_files() for part in PARTS[name.split("/")[1]]}


@cache
def shipped_parts(interface_name: str) -> tuple[MessageDefinition, ...] | None:
    """Return the parts of an interface that is shipped with simkit or rosbags; None for any other."""
    if interface_name in definition_files():
        return tuple(parse_interface(interface_name, definition_text(interface_name))[0])
    if interface_name not in rosbags_types():
        return None
    return _rosbags_parts(interface_name)


def _rosbags_parts(type_name: str) -> tuple[MessageDefinition, ...]:
    constants, fields = rosbags_types()[type_name]
    plain = [(name, (int(node[0]), node[1])) for name, node in fields if name != NO_FIELD]
    return (MessageDefinition("", list(constants), plain, rosbags_defaults(type_name)),)


def rosbags_defaults(type_name: str) -> dict[str, object]:
    """Return the published default values of a type in rosbags, by the name of the field."""
    return _ROSBAGS_DEFAULTS.get(type_name, {})


@cache
def rosbags_types() -> Mapping[str, Any]:
    """Return constants and fields of the message types that come with rosbags, by name."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY).fielddefs

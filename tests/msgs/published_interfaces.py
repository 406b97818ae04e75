"""Facts about published definitions of messages, services and actions, and a program that compares them with simkit's.

The file `published_interfaces.toml` has a version and a digest for each type. The digest covers the fields, constants
and default values of the published definition, in their order, and no comments. Another package may publish the same
type with other fields in another version, so the version is part of the table. Where a definition was read alone, its
version is a commit; `generated` is code that ROS 2 generated of a package without a public definition. `osrf_gear` has
the definitions of `nist_gear`, its later name, and `turtlesim_msgs` those of `turtlesim`, from which it was split off.

The program reads folders with published packages (`package.xml` and `msg/`, `srv/`, `action/`), such as those of an
installed ROS or clones of the repositories that the table names. It prints each difference, and with `--write` it
replaces the entries of the types that it found and that simkit ships::

    python tests/msgs/published_interfaces.py /opt/ros/jazzy/share
    python tests/msgs/published_interfaces.py --write ~/simulation_interfaces ~/common_interfaces
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode, MessageDefinition
from simkit.msgs.interface_folders import definitions_in
from simkit.msgs.shipped_interfaces import definition_files, rosbags_types, shipped_parts

TABLE = Path(__file__).with_suffix(".toml")
OWN_PACKAGE = "simkit_msgs"
"""The package of types that only simkit has."""

_HEAD = """\
# Version and digest of each published definition that simkit ships; written by published_interfaces.py.
"""
_BASIC = re.compile(r"bool|byte|char|w?string|float(32|64)|u?int(8|16|32|64)")
_TYPE = re.compile(r"([A-Za-z][\w/]*)((?:<=\d+)?(?:\[[^\]]*\])?)")
_LINE = re.compile(r"(\S+)\s+([A-Za-z]\w*)\s*(=?)\s*(.*)")
_SHORT_NAMES = {
    "Header": "std_msgs/msg/Header",
    "time": "builtin_interfaces/msg/Time",
    "duration": "builtin_interfaces/msg/Duration",
}


def shipped_names() -> list[str]:
    """Return the names of all published types that simkit ships, sorted."""
    return sorted(name for name in {*definition_files(), *rosbags_types()} if not name.startswith(f"{OWN_PACKAGE}/"))


def facts(name: str, text: str) -> str:
    """Return the constants and fields of a definition, one a line, in one spelling.

    This function shares no code with simkit's parser, so an error of the parser is found too.
    """
    parts: list[tuple[list[str], list[str]]] = [([], [])]
    for line in text.splitlines():
        content = line.partition("#")[0].strip()
        if content == "---":
            parts.append(([], []))
        elif content:
            found = _LINE.fullmatch(content)
            kind = found and _TYPE.fullmatch(found[1])
            if not found or not kind:
                raise ValueError(f"{name}: found {content!r}; expected a constant or a field")
            base, more = _full_type(name, kind[1]), kind[2]
            value = _value(base, more, found[4]) if found[3] or found[4] else ""
            separator = "=" if found[3] else " "
            parts[-1][0 if found[3] else 1].append(f"{base}{more} {found[2]}{separator}{value}".rstrip())
    return "\n---\n".join("\n".join(constants + fields) for constants, fields in parts)


def _full_type(name: str, base: str) -> str:
    base = _SHORT_NAMES.get(base, base)
    if _BASIC.fullmatch(base) or base.count("/") == 2:
        return base
    package, _, short = base.rpartition("/")
    return f"{package or name.partition('/')[0]}/msg/{short}"


def _value(base: str, more: str, text: str) -> str:
    if more.endswith("]"):
        items = [item for item in text.strip("[] ").split(",") if item.strip()]
        return "[" + ", ".join(_value(base, "", item) for item in items) + "]"
    text = text.strip()
    if base in ("string", "wstring"):
        return repr(text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "'\"" else text)
    if base == "bool":
        return str(text.lower() in ("true", "1"))
    if base.startswith("float"):
        return repr(float(text))
    return str(int(text, 0 if text.lower().startswith("0x") else 10))


def shipped_facts(name: str) -> str:
    """Return the same lines for a type that simkit ships, as simkit reads its definition."""
    return "\n---\n".join("\n".join(_lines(part)) for part in shipped_parts(name) or ())


def _lines(part: MessageDefinition) -> Iterator[str]:
    for name, kind, value in part.constants:
        yield f"{kind} {name}={value!r}"
    for name, node in part.fields:
        value = part.defaults.get(name)
        yield f"{_type_text(node)} {name}" + ("" if value is None else f" {value!r}")


def _type_text(node: FieldNode | tuple[Any, ...]) -> str:
    kind, content = int(node[0]), node[1]
    if kind == BASE:
        return content[0] + (f"<={content[1]}" if content[1] else "")
    if kind == NAME:
        return str(content)
    inner, size = content
    return _type_text(inner) + (f"[{size}]" if kind == ARRAY else f"[<={size}]" if size else "[]")


def digest(lines: str) -> str:
    """Return the digest of the lines of a definition."""
    return hashlib.sha256(lines.encode()).hexdigest()[:16]


def published_table() -> dict[str, tuple[str, str]]:
    """Return version and digest of each published type by its name."""
    packages = tomllib.loads(TABLE.read_text(encoding="utf-8"))["types"]
    return {
        f"{package}/{name}": (value.split()[0], value.split()[1])
        for package, types in packages.items()
        for name, value in types.items()
    }


def _version_of(file: Path) -> str:
    package = next((up / "package.xml" for up in file.parents[:4] if (up / "package.xml").is_file()), None)
    found = re.search(r"<version>\s*([^<\s]+)", package.read_text(encoding="utf-8")) if package else None
    return found[1] if found else "unknown"


def _compare(folders: list[Path]) -> tuple[dict[str, tuple[str, str]], int]:
    """Print each difference between simkit and the folders; return the published entries and the number of types."""
    shipped, found, different = set(shipped_names()), {}, 0
    for name, file in (entry for folder in folders for entry in definitions_in(folder)):
        if name in shipped and name not in found:
            published = facts(name, file.read_text(encoding="utf-8", errors="replace"))
            found[name] = (_version_of(file), digest(published))
            own = shipped_facts(name)
            if own != published:
                different += 1
                lines = difflib.unified_diff(own.split("\n"), published.split("\n"), n=0, lineterm="")
                _say(f"{name} differs from version {found[name][0]} (- simkit, + published)", *list(lines)[2:])
    return found, different


def _say(*lines: str) -> None:
    sys.stdout.write("\n".join(lines) + "\n")


def _write(entries: dict[str, tuple[str, str]]) -> None:
    sources = tomllib.loads(TABLE.read_text(encoding="utf-8"))["repositories"]
    lines = [_HEAD, "[repositories]", *(f'{name} = "{sources[name]}"' for name in sorted(sources))]
    package = ""
    for name in sorted(entries):
        if name.partition("/")[0] != package:
            package = name.partition("/")[0]
            lines += ["", f"[types.{package}]"]
        lines.append(f'"{name.partition("/")[2]}" = "{" ".join(entries[name])}"')
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> int:
    """Compare the types of the folders; return 1 if one differs."""
    parser = argparse.ArgumentParser(description="compare simkit's definitions with those of published packages")
    parser.add_argument("folders", nargs="+", type=Path, help="folders with packages; the first has priority")
    parser.add_argument("--write", action="store_true", help="write the published facts to the table")
    arguments = parser.parse_args()
    found, different = _compare(arguments.folders)
    missing = len(shipped_names()) - len(found)
    _say(f"{different} of {len(found)} types differ; the folders lack {missing} types that simkit ships")
    if arguments.write:
        _write({name: value for name, value in {**published_table(), **found}.items() if name in shipped_names()})
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())

"""Names of ROS 1: global `/a/b`, relative `a/b` and private `~a`, and their remapping on a command line."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Mapping
from typing import Final

__all__ = [
    "ANYTYPE",
    "GLOBALNS",
    "PRIV_NAME",
    "REMAP",
    "SEP",
    "canonicalize_name",
    "get_ros_namespace",
    "is_global",
    "is_legal_base_name",
    "is_legal_name",
    "is_legal_remap",
    "is_private",
    "load_mappings",
    "make_caller_id",
    "make_global_ns",
    "namespace",
    "ns_join",
    "resolve_name",
    "script_resolve_name",
]

SEP: Final = "/"
GLOBALNS: Final = SEP
PRIV_NAME: Final = "~"
REMAP: Final = ":="
ANYTYPE: Final = "*"

_LEGAL_NAME: Final = re.compile(r"[~/A-Za-z][\w/]*")
_LEGAL_BASE_NAME: Final = re.compile(r"[A-Za-z]\w*")
_LEGAL_REMAP: Final = re.compile(r"(?:[~/A-Za-z]|__?)[\w/]*:=.*")


def is_global(name: str) -> bool:
    """Check whether a name begins at the root."""
    return name.startswith(SEP)


def is_private(name: str) -> bool:
    """Check whether a name is relative to the name of the node."""
    return name.startswith(PRIV_NAME)


def is_legal_name(name: str | None) -> bool:
    """Check whether a name has only characters that a name may have; an empty name is legal."""
    return name is not None and (not name or (_LEGAL_NAME.fullmatch(name) is not None and "//" not in name))


def is_legal_base_name(name: str | None) -> bool:
    """Check whether a name is legal and without a namespace."""
    return name is not None and _LEGAL_BASE_NAME.fullmatch(name) is not None


def is_legal_remap(arg: str | None) -> bool:
    """Check whether a word of a command line is a remapping such as `a:=b`, `__name:=n` or `_param:=1`."""
    return arg is not None and _LEGAL_REMAP.fullmatch(arg) is not None


def canonicalize_name(name: str) -> str:
    """Return a name without repeated and trailing slashes."""
    if not name or name == SEP:
        return name
    joined = SEP.join(part for part in name.split(SEP) if part)
    return SEP + joined if name.startswith(SEP) else joined


def namespace(name: str) -> str:
    """Return the namespace of a name, with a slash at the end."""
    if not isinstance(name, str):
        raise (ValueError if name is None else TypeError)("name")
    return name.removesuffix(SEP).rpartition(SEP)[0] + SEP


def ns_join(ns: str, name: str) -> str:
    """Return a name in a namespace; a global or private name stays as it is."""
    if is_private(name) or is_global(name) or not ns:
        return name
    return ns + name if ns == PRIV_NAME or ns.endswith(SEP) else ns + SEP + name


def make_global_ns(name: str) -> str:
    """Return a name as a namespace: with a slash at both ends.

    Raises:
        ValueError: the name is private.
    """
    if is_private(name):
        raise ValueError(f"cannot turn [{name}] into a global name")
    return (name if is_global(name) else SEP + name).removesuffix(SEP) + SEP


def get_ros_namespace(env: Mapping[str, str] | None = None, argv: Iterable[str] | None = None) -> str:
    """Return the namespace of the program: that of `__ns:=`, or of the environment variable ROS_NAMESPACE."""
    for word in sys.argv if argv is None else argv:
        if word.startswith("__ns:="):
            return make_global_ns(word.removeprefix("__ns:="))
    return make_global_ns((os.environ if env is None else env).get("ROS_NAMESPACE", GLOBALNS))


def make_caller_id(name: str) -> str:
    """Return the full name of a node of this program, as a namespace."""
    return make_global_ns(ns_join(get_ros_namespace(), name))


def load_mappings(argv: Iterable[str]) -> dict[str, str]:
    """Return the new names by the old ones of a command line; `_param:=value` is no name."""
    mappings = {}
    for word in argv:
        if is_legal_remap(word):
            old, new = (part.strip() for part in word.split(REMAP, 1))
            if old and new and not is_parameter(old):
                mappings[old] = new
    return mappings


def is_parameter(name: str) -> bool:
    """Check whether the left side of `:=` is a private parameter: it has one leading underscore."""
    return len(name) > 1 and name.startswith("_") and not name.startswith("__")


def resolve_name(name: str, namespace_: str, remappings: Mapping[str, str] | None = None) -> str:
    """Return the global form of a name.

    Args:
        name: global, relative or private name.
        namespace_: full name of the node.
        remappings: new global names by old ones.
    """
    if not name:
        return namespace(namespace_)
    name = canonicalize_name(name)
    if is_private(name):
        name = canonicalize_name(f"{namespace_}/{name[1:]}")
    elif not is_global(name):
        name = namespace(namespace_) + name
    return remappings.get(name, name) if remappings else name


def script_resolve_name(script_name: str, name: str) -> str:
    """Return the global form of a name in a script that is no node."""
    if not name:
        return get_ros_namespace()
    if is_private(name):
        return ns_join(make_caller_id(script_name), name[1:])
    return name if is_global(name) else get_ros_namespace() + name

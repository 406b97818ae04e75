"""Message definitions out of bags, checked before rosbags makes Python classes of them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError, MessageError
from simkit.msgs import own_interfaces
from simkit.msgs.definition_parser import MessageDefinition, parse_interface
from simkit.msgs.message_repr import with_readable_text
from simkit.msgs.message_types import full_name
from simkit.msgs.type_limits import check_size
from simkit.msgs.wide_strings import with_wide_strings
from simkit.number_text import counted

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_LONGEST: Final = 64 << 10  # characters without comments; the longest definition of ROS 2 Jazzy has 4242
_LONGEST_REASON: Final = 300  # characters of the reason in an error message
_NAME: Final = re.compile(r"([A-Za-z]\w*)/(\w+/)?([A-Za-z]\w*)", re.ASCII)
_SEPARATOR: Final = re.compile(r"^={80}\nMSG: *(\S+) *$\n?", re.MULTILINE)


@lru_cache(maxsize=64)
def definition_store(type_name: str, text: str) -> Typestore:
    """Return a type store with a type and the types that it uses; equal definitions share a store.

    Args:
        type_name: name of the type.
        text: definition in the language of ROS 2 (`ros2msg`).

    Raises:
        InputError: SK-CLI-036 the definition is invalid, contains itself or is too large.
    """
    from rosbags.typesys import Stores, get_typestore

    try:
        types = _parsed(type_name, text)

        def fields_of(name: str) -> list[tuple[str, tuple[int, object]]]:
            if name not in types:
                raise ValueError(f"it has no definition of {name}")
            return types[name].fields

        check_size(type_name, fields_of)
        store = get_typestore(Stores.EMPTY)
        definitions: Any = {name: (part.constants, part.fields) for name, part in types.items()}
        store.register(definitions)
        with_readable_text(store.types.values())
        return with_wide_strings(store, store.fielddefs, store.types)
    except Exception as error:  # noqa: BLE001 - rosbags may raise anything on invalid types
        reason = " ".join(str(error).split())[:_LONGEST_REASON]
        raise InputError("SK-CLI-036", f"the definition of {type_name!r} is invalid: {reason}") from None


def define_types(definitions: Mapping[str, str]) -> None:
    """Define message types in this process that it does not know, from the definitions in a bag.

    Args:
        definitions: definition of each type by name, in the language of ROS 2 (`ros2msg`).

    Raises:
        InterfaceError: a definition is invalid.
    """
    texts: dict[str, str] = {}
    for type_name, text in definitions.items():
        try:
            full_name(type_name)
        except MessageError:
            texts |= {name: part.text for name, part in _parsed(type_name, text).items()}
    own_interfaces.add_received(texts)


def _parsed(type_name: str, text: str) -> dict[str, MessageDefinition]:
    """Parse a definition and the definitions that follow it, by the name of the type.

    Raises:
        ValueError: the text is too long or has an error.
    """
    text = "\n".join(line for line in text.split("\n") if line.strip() and not line.lstrip().startswith("#"))
    if len(text) > _LONGEST:
        raise ValueError(f"it has {counted(len(text), 'character')}; the longest allowed has {_LONGEST}")
    first, *rest = _SEPARATOR.split(text)
    parts_by_name = {}
    for name, definition in ((type_name, first), *zip(rest[::2], rest[1::2], strict=True)):
        match = _NAME.fullmatch(name)
        if match is None or (name == type_name and not match[2]):
            raise ValueError(f"the name {name!r:.80} is not that of a message type, such as std_msgs/msg/String")
        as_message = f"{match[1]}/msg/{match[3]}"
        parts, problems = parse_interface(as_message, definition, is_foreign=True)
        if problems:
            raise ValueError(f"{name}: {problems[0].message}")
        parts_by_name[type_name if name == type_name else as_message] = parts[0]
    return parts_by_name

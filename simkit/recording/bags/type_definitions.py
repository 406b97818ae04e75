"""Message definitions out of bags, checked before rosbags makes Python classes of them."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Final

from simkit.errors import InputError
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, FieldNode

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Typesdict
    from rosbags.typesys.store import Typestore

_LONGEST: Final = 64 << 10  # characters without comments; the longest definition of ROS 2 Jazzy has 4242
_MOST_VALUES: Final = 5000  # rosbags writes lines of code for each item of a fixed array of messages
_LONGEST_REASON: Final = 300  # characters; the parser's messages repeat the whole definition
_DEEPEST: Final = 50
_LARGEST_ARRAY: Final = (1 << 31) - 1


@lru_cache(maxsize=64)
def definition_store(type_name: str, text: str) -> Typestore:
    """Return a type store with a type and the types that it uses; equal definitions share a store.

    Args:
        type_name: name of the type.
        text: definition in the language of ROS 2 (`ros2msg`).

    Raises:
        InputError: SK-CLI-036 the definition is invalid, contains itself or is too large.
    """
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    try:
        # the parser needs a time that is quadratic in the number of empty lines
        text = "\n".join(line for line in text.split("\n") if line.strip() and not line.lstrip().startswith("#"))
        if len(text) > _LONGEST:
            raise ValueError(f"it has {len(text)} characters; the longest allowed has {_LONGEST}")
        found = get_types_from_msg(text, type_name)
        if type_name not in found:
            raise ValueError("its name is not that of a message type, such as std_msgs/msg/String")
        _check(type_name, found)
        store = get_typestore(Stores.EMPTY)
        store.register(found)
        return store
    except Exception as error:  # noqa: BLE001 - the parser may raise anything on invalid text
        reason = (
            "it is nested too deeply"
            if isinstance(error, RecursionError)
            else " ".join(str(error).split())[:_LONGEST_REASON]
        )
        raise InputError(f"SK-CLI-036 the definition of {type_name!r} is invalid: {reason}", "SK-CLI-036") from None


def _check(type_name: str, types: Typesdict) -> None:
    """Check that a type has an end and a moderate size.

    Raises:
        ValueError: the type contains itself, is too large, or uses a type that is not defined.
    """
    known: dict[str, int] = {}
    path: list[str] = []

    def count_node(node: FieldNode) -> int:
        kind = int(node[0])
        if kind == BASE:
            return 1
        if kind == NAME:
            return count_type(node[1])
        item, length = node[1]
        if kind == ARRAY and length > _LARGEST_ARRAY:
            raise ValueError(f"an array has {length} items; the largest allowed has {_LARGEST_ARRAY}")
        is_unrolled = kind == ARRAY and (int(item[0]) != BASE or item[1][0] == "string")
        return count_node(item) * max(1, length if is_unrolled else 1)

    def count_type(name: str) -> int:
        if name in path:
            raise ValueError(f"{name} contains itself")
        if name not in known:
            if name not in types:
                raise ValueError(f"it has no definition of {name}")
            if len(path) >= _DEEPEST:
                raise ValueError(f"it is nested more than {_DEEPEST} levels deep")
            path.append(name)
            known[name] = sum(count_node(node) for _, node in types[name][1])
            path.pop()
            if known[name] > _MOST_VALUES:
                raise ValueError(f"{name} has more than {_MOST_VALUES} values")
        return known[name]

    count_type(type_name)

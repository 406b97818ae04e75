"""Messages as users give them: message objects, dicts of fields, or None."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from simkit import msgs
from simkit.argument_checks import shown
from simkit.errors import MessageError, NoMessageError
from simkit.msgs.message_types import FieldValue, Message, interface_type


def typed_message(value: FieldValue, type_: str | type | None, part: str, place: str) -> Message:
    """Return a request or goal of the type that its sender names; the value itself without a type.

    Args:
        value: message, dict of its fields, or None for a message with all fields at their defaults.
        type_: service or action type, or the class of the message; None for no type.
        part: part of the type: "Request" or "Goal".
        place: service or action for the error message.

    Raises:
        MessageError: the type is unknown, or the value does not fit it.
    """
    if type_ is None:
        return value
    return checked_message(value, (f"{interface_type(type_, part)}_{part}",), place, none_is_default=True)


def checked_message(
    value: FieldValue, type_names: Collection[str], place: str, *, none_is_default: bool = False
) -> Message:
    """Return a message of one of the types.

    Args:
        value: message, or dict of the fields of the first type that they match.
        type_names: full names of the accepted types; empty if a message may have any type.
        place: topic, service or action for the error message.
        none_is_default: True if None is a message with all fields at their defaults.

    Raises:
        MessageError: the value does not fit the types; the message begins with `place`.
    """
    type_name = None if isinstance(value, type) else getattr(value, "__msgtype__", None)
    if type_name in type_names:
        return value
    names = list(dict.fromkeys(type_names))
    if value is None and none_is_default:
        value = {}
    if isinstance(value, Mapping):
        try:
            return msgs.from_dict(names, dict(value))
        except MessageError as error:
            raise MessageError(f"{place}: {error}") from None
    if isinstance(type_name, str):
        if not names:
            return value
        raise MessageError(f"{place} needs {' or '.join(names)}, got {type_name}")
    got = f"the class {value.__name__}" if isinstance(value, type) else f"{shown(value)} ({type(value).__name__})"
    wanted = f"{' or '.join(names) or 'a message'}, or a dict of its fields"
    raise NoMessageError(f"{place} needs {wanted}; {got} is not a message")

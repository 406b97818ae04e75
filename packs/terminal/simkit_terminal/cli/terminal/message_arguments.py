"""Parsers for types and YAML values on the command lines for topics, services and actions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from simkit.cli.terminal.output import JsonObject
from simkit.errors import InputError, MessageError
from simkit.yaml_reader import NotYaml, read_yaml

_TYPE_FORM: Final = re.compile(r"[A-Za-z]\w*(/\w+){1,2}")
_SHOWN: Final = 200  # characters of an invalid text in an error message


def parse_fields(text: str, what: str) -> JsonObject:
    """Parse a YAML mapping of fields on the command line; an empty text is an empty mapping.

    Args:
        text: YAML text.
        what: description of the text, for error messages.

    Raises:
        InputError: SK-CLI-031 the text is not YAML, or not a mapping.
    """
    shown = repr(text) if len(text) <= _SHOWN else f"{text[:_SHOWN]!r}…"
    try:
        fields = read_yaml(text)
    except NotYaml as error:
        raise InputError("SK-CLI-031", f"{what}: {shown} is not YAML: {error}") from None
    if fields is None:
        return {}
    if not isinstance(fields, dict) or any(not isinstance(key, str) for key in fields):
        message = f"{what}: found {shown}; expected a mapping of fields such as '{{linear: {{x: 0.2}}}}'"
        raise InputError("SK-CLI-031", message)
    return fields


def split_type_and_values(type_name: str | None, values: str | None) -> tuple[str | None, str | None]:
    """Return the type and the values of a command line; if the first argument is not a type, it is the values."""
    if type_name is not None and values is None and not _TYPE_FORM.fullmatch(type_name):
        return None, type_name
    return type_name, values


def split_type_and_words(type_name: str | None, words: Sequence[str] | None) -> tuple[str | None, list[str]]:
    """Return the type and the words after it; if the first word is not a type, it belongs to the words."""
    if type_name is not None and not _TYPE_FORM.fullmatch(type_name):
        return None, [type_name, *(words or ())]
    return type_name, list(words or ())


def is_same_type(short_or_full: str, type_name: str) -> bool:
    """Check whether a name is the full or the short name of a type, such as `geometry_msgs/Twist`."""
    package, _, rest = type_name.partition("/")
    return short_or_full in (type_name, f"{package}/{rest.rpartition('/')[2]}")


def check_type(expected: str | None, types: Iterable[str], name: str) -> None:
    """Check that a topic, service or action has the expected type, if a type was given.

    Raises:
        InputError: SK-CLI-032 the type differs.
    """
    types = list(types)
    if expected is not None and not any(is_same_type(expected, known) for known in types):
        raise InputError("SK-CLI-032", f"{name} has type {', '.join(types)}, found {expected!r}")


def make_message(type_name: str, fields: JsonObject) -> object:
    """Build a message from its fields.

    Raises:
        InputError: SK-CLI-031 the fields do not match the type.
    """
    from simkit import msgs

    try:
        return msgs.make(type_name, **fields)
    except MessageError as error:
        raise InputError("SK-CLI-031", str(error)) from None

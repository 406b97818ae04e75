"""Parse the types, YAML values and patterns that commands for topics and services are given."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from simkit.cli.terminal.output import JsonObject
from simkit.errors import InputError, MessageError
from simkit.yaml_reader import NotYaml, read_yaml

_TYPE_FORM: Final = re.compile(r"[A-Za-z]\w*(/\w+){1,2}")
_SHOWN: Final = 200  # letters of a text that are shown where it is wrong


def parse_fields(text: str, what: str) -> JsonObject:
    """The mapping that a YAML text on the command line stands for; an empty text for none of its fields.

    Raises:
        InputError: SK-CLI-031 it is no YAML, or no mapping.
    """
    shown = repr(text) if len(text) <= _SHOWN else f"{text[:_SHOWN]!r}…"
    try:
        found = read_yaml(text)
    except NotYaml as error:
        raise InputError(f"SK-CLI-031 {what}: {shown} is not YAML: {error}", "SK-CLI-031") from None
    if found is None:
        return {}
    if not isinstance(found, dict) or any(not isinstance(key, str) for key in found):
        told = f"{what}: found {shown}, allowed is a mapping of fields such as '{{linear: {{x: 0.2}}}}'"
        raise InputError(f"SK-CLI-031 {told}", "SK-CLI-031")
    return found


def split_type_and_values(type_name: str | None, values: str | None) -> tuple[str | None, str | None]:
    """The two arguments; values alone stand in the place of the type."""
    if type_name is not None and values is None and not _TYPE_FORM.fullmatch(type_name):
        return None, type_name
    return type_name, values


def is_same_type(said: str, type_name: str) -> bool:
    """Check whether a type name means a full name: `geometry_msgs/msg/Twist`, or `geometry_msgs/Twist` for it."""
    package, _, rest = type_name.partition("/")
    return said in (type_name, f"{package}/{rest.rpartition('/')[2]}")


def check_type(said: str | None, types: Iterable[str], name: str) -> None:
    """Sees to it that a topic, service or action is of the type that was said, where one was.

    Raises:
        InputError: SK-CLI-032 it is of another.
    """
    types = list(types)
    if said is not None and not any(is_same_type(said, one) for one in types):
        raise InputError(f"SK-CLI-032 {name} is of type {', '.join(types)}, found {said!r}", "SK-CLI-032")


def make_message(type_name: str, fields: JsonObject) -> object:
    """A message of the fields that were given.

    Raises:
        InputError: SK-CLI-031 they do not fit the type.
    """
    from simkit import msgs

    try:
        return msgs.make(type_name, **fields)
    except MessageError as error:
        raise InputError(f"SK-CLI-031 {error}", "SK-CLI-031") from None


def compile_pattern(text: str | None, option: str) -> re.Pattern[str] | None:
    """The regular expression that was given with an option, where one was.

    Raises:
        InputError: SK-CLI-031 it is none.
    """
    try:
        return None if text is None else re.compile(text)
    except re.error as error:
        raise InputError(f"SK-CLI-031 {option}: {text!r} is no regular expression: {error}", "SK-CLI-031") from None

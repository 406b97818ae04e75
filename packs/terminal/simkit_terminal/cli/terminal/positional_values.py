"""Values of a message on the command line: a YAML mapping, or one value for each field as in `rostopic pub`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from simkit.cli.terminal.output import JsonObject, JsonValue
from simkit.errors import InputError, MessageError
from simkit.extend import counted
from simkit.yaml_reader import NotYaml, read_yaml
from simkit_terminal.cli.terminal.message_arguments import parse_fields


def read_fields(type_name: str, words: Sequence[str], what: str) -> JsonObject:
    """Return the fields of a message from the words of a command line.

    One word may be a mapping of fields. Other words are the values of the fields in the order of the definition, as
    in `rostopic pub` and `rosservice call`; a list such as `[2.0, 0.0, 0.0]` has the fields of a nested message.

    Args:
        type_name: full name of the message type.
        words: words after the type; none for the default values.
        what: description of the message, for error messages.

    Raises:
        InputError: SK-CLI-031 the words do not match the fields.
    """
    from simkit.msgs.interface_definitions import prototype

    if not words or (len(words) == 1 and _is_mapping(words[0])):
        return parse_fields(words[0] if words else "{}", what)
    try:
        template = prototype(type_name)
    except MessageError as error:
        raise InputError("SK-CLI-032", str(error)) from None
    if len(words) == 1 and len(template) != 1:
        return parse_fields(words[0], what)  # which reports that a mapping is expected
    return _assign(template, [_value(word, what) for word in words], type_name, what, words)


def _is_mapping(text: str) -> bool:
    try:
        found = read_yaml(text)
    except NotYaml:
        return True  # `parse_fields` reports the problem
    return isinstance(found, dict) or (found is None and not text.strip())


def _value(word: str, what: str) -> JsonValue:
    try:
        return read_yaml(word)
    except NotYaml as error:
        raise InputError("SK-CLI-031", f"{what}: {word!r:.200} is not YAML: {error}") from None


def _assign(
    template: Mapping[str, JsonValue],
    values: Sequence[JsonValue],
    type_name: str,
    what: str,
    words: Sequence[str] | None = None,
) -> JsonObject:
    """Give the fields of a template their values in order; a text field has the word as it was typed."""
    if len(values) != len(template):
        names = ", ".join(template) or "none"
        text = (
            f"{what}: found {counted(len(values), 'value')}; {type_name} has {counted(len(template), 'field')}: {names}"
        )
        raise InputError("SK-CLI-031", text, help="give one value for each field, or a mapping '{field: value}'")
    fields: JsonObject = {}
    for number, ((name, default), value) in enumerate(zip(template.items(), values, strict=True)):
        if isinstance(default, Mapping) and isinstance(value, list):
            fields[name] = _assign(default, value, f"its field {name}", what)
        elif isinstance(default, str) and not isinstance(value, str):
            fields[name] = words[number] if words is not None else str(value)
        else:
            fields[name] = value
    return fields

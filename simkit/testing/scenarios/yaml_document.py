"""YAML documents with the line number of each value, and a reader that validates the types of values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from simkit.diagnostics import Diagnostics, Where, did_you_mean, shorten
from simkit.input_file import read_failure, read_input_text
from simkit.run_spec import FilePath
from simkit.testing.scenarios.readable_files import OUTSIDE, ReadableFiles, Refusal, label
from simkit.yaml_reader import NotYaml, compose_nodes, finite_number, node_value

MAX_BYTES = 1 << 20  # size limit of a scenario file [bytes]; people write these files by hand
_MAX_DEPTH = 6  # number of nested levels whose line numbers are stored
_BOOLEAN_WORDS = {"on": True, "yes": True, "true": True, "off": False, "no": False, "false": False}


class Document:
    """Values of a YAML file.

    Args:
        path: File.
        diagnostics: Diagnostics for problems in the file.
        folders: Folders of the user in which the file may name files, beside its own folders.

    Attributes:
        values: Plain values; None if the file is not YAML.
        files: Check of the files that the document names.
    """

    def __init__(self, path: Path, diagnostics: Diagnostics, folders: Sequence[FilePath] = ()) -> None:
        self.path, self.diagnostics = path, diagnostics
        self.files = ReadableFiles(path, folders)
        self.values: object = None
        self._lines: dict[tuple[object, ...], int] = {}
        text = self.text()
        if text is not None:
            self._read(text)

    def where(self, *keys: object) -> Where:
        """Return the file and line of a value; if its line is unknown, the line of the value that contains it."""
        while keys and keys not in self._lines:
            keys = keys[:-1]
        return Where(str(self.path), self._lines.get(keys, 1))

    def error(self, code: str, message: str, *keys: object, hint: str = "") -> None:
        """Report an error of a value."""
        self.diagnostics.error(code, message, self.where(*keys), hint)

    def refuses(self, refusal: Refusal | None, *keys: object) -> bool:
        """Report the refusal of a file that the document names; return False for a file that it may name."""
        if refusal is not None:
            self.error(OUTSIDE, f"{label(keys)}: {refusal[0]}", *keys, hint=refusal[1])
        return refusal is not None

    def only(self, value: object, allowed: tuple[str, ...], what: str, *keys: object) -> dict[str, object]:
        """Return the allowed keys of a mapping; report other keys and suggest the closest name."""
        if not isinstance(value, dict):
            self.error("SK-SCEN-003", f"{what}: found {short_repr(value)}, expected a mapping", *keys)
            return {}
        for key in value:
            if key not in allowed:
                hint = did_you_mean(str(key), allowed) or f"allowed keys: {', '.join(allowed)}"
                if isinstance(key, bool):
                    hint = f"YAML reads an unquoted on, off, yes or no as true or false; {hint}"
                self.error("SK-SCEN-002", f"{what} has no key {str(key)!r}", *keys, key, hint=hint)
        return {key: item for key, item in value.items() if key in allowed}

    def text(self) -> str | None:
        try:
            return read_input_text(self.path, MAX_BYTES)
        except (OSError, ValueError) as error:
            self.diagnostics.error("SK-SCEN-001", f"cannot be read: {read_failure(error)}", Where(str(self.path)))
            return None

    def _read(self, text: str) -> None:
        try:
            root = compose_nodes(text)
            if root is not None:
                self._note_lines(root)  # call this first, because node_value replaces merge keys
                self.values = node_value(root)
        except NotYaml as error:
            where = Where(str(self.path), error.line)
            self.diagnostics.error("SK-SCEN-001", f"is not YAML: {error!s:.200}", where)

    def _note_lines(self, root: object) -> None:
        for keys, line in _lines_by_path(root, ()):
            if keys in self._lines and keys and not isinstance(keys[-1], int):
                message = f"duplicate key {keys[-1]!r}, also at line {self._lines[keys]}"
                self.diagnostics.error("SK-SCEN-003", message, Where(str(self.path), line))
            self._lines[keys] = line


def _lines_by_path(node: Any, keys: tuple[object, ...]) -> Iterator[tuple[tuple[object, ...], int]]:
    """Iterate over the keys and lines of all values; a value of a mapping has the line of its key."""
    import yaml

    if not keys:
        yield (), node.start_mark.line + 1
    if len(keys) >= _MAX_DEPTH:
        return
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                name = _BOOLEAN_WORDS.get(key.value.lower(), key.value) if key.tag.endswith(":bool") else key.value
                yield (*keys, name), key.start_mark.line + 1
                yield from _lines_by_path(value, (*keys, name))
    elif isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield (*keys, number), item.start_mark.line + 1
            yield from _lines_by_path(item, (*keys, number))


def is_scalar_text(value: object) -> bool:
    """Check whether `yaml_value_text` can convert a YAML value."""
    if isinstance(value, list):
        return all(is_scalar_text(item) and not isinstance(item, list) for item in value)
    return isinstance(value, (str, int, float))


def yaml_value_text(value: object) -> str:
    """Convert a YAML value to text: `true` or `false` for a bool, numbers of a list separated by spaces."""
    if isinstance(value, bool):
        return str(value).lower()
    return " ".join(map(yaml_value_text, value)) if isinstance(value, list) else str(value)


def short_repr(value: object) -> str:
    """Return a shortened representation of a value for messages."""
    return shorten(repr(value), 60)


class ValueReader:
    """Reader of the values of a document.

    Args:
        document: Document, which reports the errors of the values.
        fields: Values by key.
        at: Keys of the mapping that contains the values; empty for the top level.
    """

    def __init__(self, document: Document, fields: Mapping[str, object], at: tuple[object, ...] = ()) -> None:
        self._document, self._fields, self._at = document, fields, at

    def _wrong(self, value: object, allowed: str, *keys: object) -> None:
        label, message = ".".join(map(str, (*self._at, *keys))), f"found {short_repr(value)}, expected {allowed}"
        self._document.error("SK-SCEN-003", f"{label}: {message}", *self._at, *keys)

    def text(self, key: str, default: str) -> str:
        value = self._fields.get(key, default)
        if isinstance(value, str) and (value.strip() or value == default):
            return value
        self._wrong(value, "a string", key)
        return default

    def word(self, key: str, default: str, allowed: Sequence[str]) -> str:
        """Return a text that is one of several words."""
        word = self.text(key, default)
        if word not in allowed:
            self._wrong(word, f"{', '.join(allowed[:-1])} or {allowed[-1]}", key)
            return default
        return word

    def named(self, key: str) -> dict[str, str] | tuple[str, ...]:
        """Return the texts of a mapping, or of a list."""
        return self._strings(key) if isinstance(self._fields.get(key), dict) else self.texts(key)

    def mapping(self, key: str) -> dict[str, Any]:
        """Return a mapping."""
        return self._mapping(key)

    def entries(self, key: str) -> tuple[str | Mapping[str, Any], ...]:
        """Return the texts and mappings of a list; one of them may stand alone."""
        value = self._fields.get(key, ())
        listed = [value] if isinstance(value, (str, dict)) else value
        if isinstance(listed, (list, tuple)) and all(
            item.strip() if isinstance(item, str) else isinstance(item, dict) for item in listed
        ):
            return tuple(listed)
        self._wrong(value, "a list of strings and mappings", key)
        return ()

    def _strings(self, key: str) -> dict[str, str]:
        """Return the values of a mapping as strings; report an error for values that cannot be converted."""
        texts = {}
        for name, value in self._mapping(key).items():
            if is_scalar_text(value):
                texts[name] = yaml_value_text(value)
            else:
                self._wrong(value, "a number, a string, true or false, or a list of these", key, name)
        return texts

    def flag(self, key: str, default: bool) -> bool:
        value = self._fields.get(key, default)
        if isinstance(value, bool):
            return value
        self._wrong(value, "true or false", key)
        return default

    def number(
        self, key: str, default: float | None, *, least: float = -math.inf, above: float = -math.inf
    ) -> float | None:
        return self._number_of(self._fields.get(key, default), default, (key,), least=least, above=above)

    def _number_of(
        self,
        value: object,
        default: float | None,
        keys: tuple[object, ...],
        *,
        least: float = -math.inf,
        above: float = -math.inf,
    ) -> float | None:
        if value is default:  # the key is missing
            return None if value is None else float(value)
        number = finite_number(value)
        if number is not None and number >= least and number > above:
            return number
        bound = f" >= {least:g}" if least > -math.inf else f" > {above:g}" if above > -math.inf else ""
        self._wrong(value, f"a number{bound}", *keys)
        return default

    def whole(self, key: str, default: int, least: int) -> int:
        value = self._fields.get(key, default)
        if isinstance(value, int) and not isinstance(value, bool) and value >= least:
            return value
        self._wrong(value, f"an integer >= {least}", key)
        return default

    def texts(self, key: str) -> tuple[str, ...]:
        value = self._fields.get(key, ())
        listed = [value] if isinstance(value, str) else value
        if isinstance(listed, (list, tuple)) and all(isinstance(text, str) and text.strip() for text in listed):
            return tuple(listed)
        self._wrong(value, "a string or a list of strings", key)
        return ()

    def _mapping(self, key: str) -> dict[str, object]:
        value = self._fields.get(key, {})
        if isinstance(value, dict) and all(isinstance(name, str) for name in value):
            return value
        self._wrong(value, "a mapping with string keys", key)
        return {}

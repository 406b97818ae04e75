"""A YAML file as values that know their lines, so that every problem of it can be told with its place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from simkit.diagnostics import Diagnostics, Where, did_you_mean, shortened

LARGEST = 1 << 20  # bytes of a file that people write by hand
_DEEPEST = 6  # levels whose lines are known
_TRUTHS = {"on": True, "yes": True, "true": True, "off": False, "no": False, "false": False}


class Document:
    """The values of a YAML file.

    Args:
        path: of the file.
        diagnostics: gets what is wrong with it.

    Attributes:
        values: plain ones; None where the file is no YAML.
    """

    def __init__(self, path: Path, diagnostics: Diagnostics) -> None:
        self.path, self.diagnostics = path, diagnostics
        self.values: Any = None
        self._lines: dict[tuple[Any, ...], int] = {}
        text = self._text()
        if text is not None:
            self._read(text)

    def where(self, *keys: Any) -> Where:
        """The place of a value, or of the nearest one around it whose line is known."""
        while keys and keys not in self._lines:
            keys = keys[:-1]
        return Where(str(self.path), self._lines.get(keys, 1))

    def error(self, code: str, message: str, *keys: Any, hint: str = "") -> None:
        """Reports what is wrong with a value."""
        self.diagnostics.error(code, message, self.where(*keys), hint)

    def only(self, value: Any, allowed: tuple[str, ...], what: str, *keys: Any) -> dict[str, Any]:
        """A mapping with nothing but allowed keys; what else it has is reported, with the closest name."""
        if not isinstance(value, dict):
            self.error("SK-SCEN-003", f"{what}: found {shown(value)}, allowed is a mapping", *keys)
            return {}
        for key in value:
            if key not in allowed:
                hint = did_you_mean(str(key), allowed) or f"there is {', '.join(allowed)}"
                if isinstance(key, bool):
                    hint = f"YAML takes a bare on, off, yes and no for true or false; {hint}"
                self.error("SK-SCEN-002", f"{what} has no {str(key)!r}", *keys, key, hint=hint)
        return {key: one for key, one in value.items() if key in allowed}

    def _text(self) -> str | None:
        try:
            if self.path.stat().st_size > LARGEST:
                message = f"the file has more than {LARGEST >> 20} MB"
                self.diagnostics.error("SK-SCEN-001", message, Where(str(self.path)))
                return None
            return self.path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or "it is no text in UTF-8"
            self.diagnostics.error("SK-SCEN-001", f"cannot be read: {why}", Where(str(self.path)))
            return None

    def _read(self, text: str) -> None:
        from simkit.sinks.yaml_text import NotYaml, composed, value_of

        try:
            root = composed(text)
            if root is not None:
                self._note_lines(root)  # before values are made, which resolves merges
                self.values = value_of(root)
        except NotYaml as error:
            where = Where(str(self.path), error.line)
            self.diagnostics.error("SK-SCEN-001", f"is not YAML: {error!s:.200}", where)

    def _note_lines(self, root: Any) -> None:
        for keys, line in _lines(root, ()):
            if keys in self._lines and keys and not isinstance(keys[-1], int):
                message = f"{keys[-1]!r} is said twice, at line {self._lines[keys]} too"
                self.diagnostics.error("SK-SCEN-003", message, Where(str(self.path), line))
            self._lines[keys] = line


def _lines(node: Any, keys: tuple[Any, ...]) -> Iterator[tuple[tuple[Any, ...], int]]:
    """Of every value down to some depth, by its keys; that of a mapping's value is the line of its key."""
    import yaml

    if not keys:
        yield (), node.start_mark.line + 1
    if len(keys) >= _DEEPEST:
        return
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                name = _TRUTHS.get(key.value.lower(), key.value) if key.tag.endswith(":bool") else key.value
                yield (*keys, name), key.start_mark.line + 1
                yield from _lines(value, (*keys, name))
    elif isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield (*keys, number), item.start_mark.line + 1
            yield from _lines(item, (*keys, number))


def beside(folder: Path, spawn: str) -> str:
    """`MODEL:x,y,yaw[:name]` with the file in a folder, where there is such a one; else as it is."""
    model, colon, rest = spawn.partition(":")
    return f"{folder / model}{colon}{rest}" if model and (folder / model).exists() else spawn


def shown(value: Any) -> str:
    """A value for a message, short."""
    return shortened(repr(value), 60)

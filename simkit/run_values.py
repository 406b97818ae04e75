"""Kinds of values of a run's fields: how a value is read, written, moved to other folders and taken from an option."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Final, Protocol, cast

from simkit.errors import InputError
from simkit.home_folder import expand_home
from simkit.run_files import (
    ChangeFile,
    FileName,
    PackagePaths,
    model_and_file,
    split_package_paths,
    split_spawn,
)
from simkit.run_nodes import Node, moved_node, node_arguments

NamedValues = Mapping[str, str] | Sequence[str]
"""Values by name, or texts `NAME:=VALUE` or `NAME=VALUE`."""
_INVALID: Final = "SK-CLI-018"


def named_values(values: NamedValues | None, option: str) -> dict[str, str]:
    """Return values by name; `NAME:=VALUE` is the form of ROS.

    Args:
        values: mapping, texts, or None for no values.
        option: name of the option for an error message.

    Raises:
        InputError: SK-CLI-018 a text has another form.
    """
    if values is None or isinstance(values, Mapping):
        return dict(values or {})
    value_by_name: dict[str, str] = {}
    for text in (values,) if isinstance(values, str) else values:
        name, equals, value = str(text).partition("=")
        name = name.strip().removesuffix(":").strip()
        if not equals or not name:
            raise InputError(_INVALID, f"{option}: found {text!r}; expected NAME:=VALUE or NAME=VALUE")
        value_by_name[name] = value
    return value_by_name


class ValueSource(Protocol):
    """Reader of one kind of file, which reports a value of a wrong type in its own way."""

    def text(self, key: str, default: str) -> str: ...
    def flag(self, key: str, default: bool) -> bool: ...
    def whole(self, key: str, default: int, least: int) -> int: ...
    def number(self, key: str, default: float | None, *, least: float, above: float) -> float | None: ...
    def texts(self, key: str) -> tuple[str, ...]: ...
    def word(self, key: str, default: str, allowed: Sequence[str]) -> str: ...
    def named(self, key: str) -> dict[str, str] | tuple[str, ...]: ...
    def mapping(self, key: str) -> dict[str, Any]: ...
    def entries(self, key: str) -> tuple[str | Mapping[str, Any], ...]: ...


class ValueKind:
    """Kind of a value that is read and written by its own code: objects, functions and what is never in a file.

    Attributes:
        option_type: type of the value on the command line.
        has_files: True if the value can contain names of files.
    """

    option_type: ClassVar[Any] = None
    has_files: ClassVar[bool] = False

    def read(self, source: ValueSource, key: str, default: Any) -> Any:
        """Return the value of a key of a file."""
        raise NotImplementedError(f"{type(self).__name__} has no form in a file")

    def from_option(self, value: Any, option: str) -> Any:
        """Return the field's value for the value of an option.

        Raises:
            InputError: SK-CLI-018 the value is not allowed.
        """
        return tuple(value) if isinstance(value, list) else value

    def plain(self, value: Any) -> Any:
        """Return a value as it is written to a file; the writer converts tuples and paths."""
        return value

    def move(self, value: Any, name: str, change: ChangeFile) -> Any:
        """Return a value in which each name of a file is changed.

        Args:
            value: value of the field.
            name: name of the field.
            change: function that returns the new name of a file.
        """
        return value


class Text(ValueKind):
    """Text."""

    option_type = str | None

    def read(self, source: ValueSource, key: str, default: str) -> str:
        return source.text(key, default)


class Expression(Text):
    """Expression in the language of conditions."""

    def from_option(self, value: str, option: str) -> str:
        if not value.strip():  # its usual cause is an unset variable of a shell script
            raise InputError(_INVALID, f"{option}: the expression is empty")
        return value


class Flag(ValueKind):
    """Truth value."""

    option_type = bool

    def read(self, source: ValueSource, key: str, default: bool) -> bool:
        return source.flag(key, default)


class Whole(ValueKind):
    """Whole number.

    Args:
        least: lowest allowed number.
    """

    option_type = int | None

    def __init__(self, least: int = 0) -> None:
        self._least = least

    def read(self, source: ValueSource, key: str, default: int) -> int:
        return source.whole(key, default, self._least)


class Number(ValueKind):
    """Number, or None.

    Args:
        least: lowest allowed number.
        above: number that the value must exceed.
    """

    option_type = float | None

    def __init__(self, least: float = -math.inf, above: float = -math.inf) -> None:
        self._least, self._above = least, above

    def read(self, source: ValueSource, key: str, default: float | None) -> float | None:
        return source.number(key, default, least=self._least, above=self._above)


class Choice(ValueKind):
    """One word of several.

    Args:
        words: allowed words.

    Attributes:
        words: allowed words.
    """

    option_type = str | None

    def __init__(self, words: Sequence[str]) -> None:
        self.words = words

    def read(self, source: ValueSource, key: str, default: str) -> str:
        return source.word(key, default, self.words)


class Texts(ValueKind):
    """Texts."""

    option_type = list[str]

    def read(self, source: ValueSource, key: str, default: object) -> tuple[str, ...]:
        return source.texts(key)


class NamedTexts(ValueKind):
    """Texts by name, as in `NAME:=VALUE`."""

    option_type = list[str]

    def read(self, source: ValueSource, key: str, default: object) -> dict[str, str] | tuple[str, ...]:
        return source.named(key)

    def from_option(self, value: Any, option: str) -> Any:
        return named_values(value, option)


class PlainValues(ValueKind):
    """Values by name: truth values, numbers, texts, and lists and mappings of these."""

    def read(self, source: ValueSource, key: str, default: object) -> dict[str, Any]:
        return source.mapping(key)


class WorldName(Text):
    """World: a file, a bare name, XML text, or a word with a meaning of its own.

    Args:
        words: these words.
    """

    has_files = True

    def __init__(self, words: Sequence[str] = ()) -> None:
        self._words = words

    def move(self, value: str, name: str, change: ChangeFile) -> Any:
        return value if value in self._words or "<" in value else change(FileName(value, "world", (name,)))


class WordOrFile(Text):
    """Word, or path of a YAML file, which its suffix marks; None for neither."""

    has_files = True

    def plain(self, value: str | os.PathLike[str] | None) -> str | None:
        return None if value is None else os.fspath(value)

    def move(self, value: str | os.PathLike[str] | None, name: str, change: ChangeFile) -> str | None:
        text = self.plain(value)
        is_file = text is not None and text.endswith((".yaml", ".yml"))
        return str(change(FileName(text, "file", (name,)))) if is_file and text is not None else text


class BagText(Text):
    """Path of a bag as text, relative to the folder of the run; empty for none."""

    option_type = Path | None
    has_files = True

    def from_option(self, value: str | os.PathLike[str], option: str) -> str:
        return os.fspath(value)

    def move(self, value: str, name: str, change: ChangeFile) -> Any:
        return change(FileName(value, "bag", (name,))) if value else value


class ProgramName(Text):
    """Path of a file that is code, or names in its place, such as `PACKAGE FILE`; empty for none."""

    has_files = True

    def move(self, value: str, name: str, change: ChangeFile) -> Any:
        return str(change(FileName(value, "program", (name,)))) if value else value


class OneFile(ValueKind):
    """Path of a file, or None."""

    option_type = Path | None
    has_files = True

    def move(self, value: str | os.PathLike[str] | None, name: str, change: ChangeFile) -> Path | None:
        return None if value is None else Path(change(FileName(os.fspath(value), "file", (name,))))


class Spawns(Texts):
    """Models to spawn: texts `MODEL:x,y,yaw[:name[:namespace]]`, mappings, or objects with the attribute `source`."""

    has_files = True

    def read(self, source: ValueSource, key: str, default: object) -> tuple[Any, ...]:
        return source.entries(key)

    def plain(self, value: Any) -> list[Any]:
        return [entry if isinstance(entry, (str, Mapping)) else self._plain_entry(entry) for entry in value]

    def _plain_entry(self, entry: Any) -> dict[str, Any]:
        keys = {"model": os.fspath(entry.source), "place": entry.place, "name": entry.name}
        return keys | ({"namespace": entry.namespace} if entry.namespace else {})

    def move(self, value: Any, name: str, change: ChangeFile) -> Any:
        moved_entries: list[Any] = []
        for number, entry in enumerate(value):
            keys = (name, number)
            if isinstance(entry, str):
                model, rest = split_spawn(entry)
                moved_entries.append(f"{change(FileName(model, 'model', keys))}{rest}")
            elif isinstance(entry, Mapping):
                model = change(FileName(os.fspath(entry.get("model", "")), "model", keys))
                moved_entries.append({**entry, "model": str(model)})
            else:
                moved_entries.append(replace(entry, source=change(FileName(os.fspath(entry.source), "model", keys))))
        return tuple(moved_entries)


def spawns_in(folder: Path, spawn: Sequence[Any]) -> tuple[Any, ...]:
    """Return models to spawn with the path of each model that is in a folder."""
    return cast("tuple[Any, ...]", Spawns().move(spawn, "spawn", lambda name: name.path_in(folder) or name.text))


class Nodes(ValueKind):
    """Programs that run in lock-step: texts with the words of a command line, or mappings."""

    option_type = list[str]
    has_files = True

    def read(self, source: ValueSource, key: str, default: object) -> tuple[Node, ...]:
        return source.entries(key)

    def from_option(self, value: Sequence[str], option: str) -> tuple[str, ...]:
        for node in value:
            node_arguments(node)
        return tuple(value)

    def move(self, value: Sequence[Node], name: str, change: ChangeFile) -> tuple[Node, ...]:
        return tuple(moved_node(node, (name, number), change) for number, node in enumerate(value))


class Folders(Texts):
    """Folders.

    Args:
        must_exist: True to reject the option for a folder that does not exist.
    """

    option_type = list[Path]
    has_files = True

    def __init__(self, must_exist: bool = False) -> None:
        self._must_exist = must_exist

    def from_option(self, value: Sequence[Path], option: str) -> tuple[Path, ...]:
        for folder in value:
            if self._must_exist and not expand_home(folder).is_dir():
                raise InputError(_INVALID, f"{option}: there is no folder {str(folder)!r}")
        return tuple(value)

    def move(self, value: Sequence[str | os.PathLike[str]], name: str, change: ChangeFile) -> tuple[object, ...]:
        return tuple(change(FileName(os.fspath(entry), "folder", (name, number))) for number, entry in enumerate(value))


class ParameterFiles(Texts):
    """Files, each for all models or for one: `[MODEL=]FILE`, or pairs of the model's name and the file."""

    has_files = True

    def plain(self, value: Any) -> list[str]:
        pairs = map(model_and_file, [value] if isinstance(value, (str, os.PathLike)) else value)
        return [f"{model}={file}" if model else file for model, file in pairs]

    def move(self, value: Any, name: str, change: ChangeFile) -> tuple[object, ...]:
        moved_entries = []
        for number, entry in enumerate([value] if isinstance(value, (str, os.PathLike)) else value):
            model, file = model_and_file(entry)
            moved = change(FileName(file, "file", (name, number)))
            moved_entries.append((model, moved) if isinstance(entry, tuple) else f"{model}={moved}" if model else moved)
        return tuple(moved_entries)


class Packages(NamedTexts):
    """Folders of ROS packages by name, and workspaces."""

    has_files = True

    def from_option(self, value: Sequence[str], option: str) -> tuple[str, ...]:
        return tuple(value)

    def move(self, value: PackagePaths, name: str, change: ChangeFile) -> object:
        def moved(path: Path, key: str | int) -> object:
            return change(FileName(str(path), "folder", (name, key)))

        named, workspaces = split_package_paths(value)
        if isinstance(value, Mapping):
            return {key: moved(path, key) for key, path in named.items()}
        listed = [f"{key}={moved(path, key)}" for key, path in named.items()]
        return [*listed, *(moved(path, number) for number, path in enumerate(workspaces))]

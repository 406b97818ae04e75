"""Registries computed from a package's modules and from entry points: one file per addition, no duplicates."""

from __future__ import annotations

import importlib
import inspect
import logging
import pkgutil
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any, Generic, TypeVar

T = TypeVar("T")

_TEXTS = re.compile(r"""[ ]*\((?:\s|,|"[^"\\\n]*"|'[^'\\\n]*'|#[^\n]*\n)*\)[ ]*(?:#[^\n]*)?\n""")
_TEXT = re.compile(r"""#[^\n]*|"(?P<one>[^"\\\n]+)"|'(?P<two>[^'\\\n]+)'""")
_OUTER = "\nclass ", "\ndef ", "\nasync def "


def entry_points_of(group: str) -> list[EntryPoint]:
    """The entry points of a group. To read them all takes 20 ms: they are kept until a folder of `sys.path` changes."""
    state = tuple((folder, _folder_time(Path(folder))) for folder in sys.path)
    return list(_all_entry_points(state).select(group=group))


@lru_cache(maxsize=1)
def _all_entry_points(_state: tuple[tuple[str, int], ...]) -> Any:  # its type differs between Python 3.11 and 3.12
    return entry_points()


def _folder_time(folder: Path) -> int:
    """When something was last put into a folder or taken out [ns]; 0 where there is none."""
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return 0


class Kinds(Mapping[str, type[T]], Generic[T]):
    """Every class under `packages` and in the entry points `group` that is a `base`, by each name it answers to.

    A class that is asked for by name is all that is imported: the names are read from the text of the modules. To go
    through all of them, or to ask for their number, imports every module.

    Args:
        packages: dotted names of the packages whose modules (and sub-packages' modules) are read.
        group: entry-point group.
        base: classes must derive from it; abstract and nameless ones are passed over.
        names: gives the names that a class answers to.
        attributes: the class attributes that `names` reads: tuples of texts.
        spell: what `names` makes of each of them.

    Raises:
        RuntimeError: two classes answer to one name; said when all are gone through.
    """

    def __init__(
        self,
        packages: str | Sequence[str],
        group: str,
        base: type[T],
        names: Callable[[type[T]], Iterable[str]],
        attributes: Sequence[str] = ("types",),
        spell: Callable[[str], str] = str,
    ) -> None:
        self._packages = (packages,) if isinstance(packages, str) else packages
        self._group, self._base, self._names = group, base, names
        self._attributes, self._spell = attributes, spell
        self._found: dict[str, type[T] | None] = {}

    def __getitem__(self, name: str) -> type[T]:
        cls = self._find(name)
        if cls is None:
            raise KeyError(name)
        return cls

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self._find(name) is not None

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    @cached_property
    def written(self) -> Mapping[str, str]:
        """Each name that a class answers to, as it is written in the class; imports only what computes its names."""
        literal, computed = self._written
        modules = (importlib.import_module(module) for module in computed)
        classes = [*self._foreign, *(cls for module in modules for cls in self._classes(module))]
        texts = [text for cls in classes for attribute in self._attributes for text in getattr(cls, attribute, ())]
        found = {name: text for name, (text, _) in literal.items()} | {self._spell(text): text for text in texts}
        return MappingProxyType(dict(sorted(found.items())))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({dict(self._all)!r})"

    @cached_property
    def _all(self) -> Mapping[str, type[T]]:
        """Every class by name, sorted."""
        classes: dict[type[T], None] = {}
        for module, _ in self._modules:
            classes.update(dict.fromkeys(self._classes(importlib.import_module(module))))
        classes.update(dict.fromkeys(self._foreign))
        table: dict[str, type[T]] = {}
        for cls in classes:
            for name in self._names(cls):
                if name in table and table[name] is not cls:
                    raise RuntimeError(f"{name!r} is claimed by {table[name].__module__} and by {cls.__module__}")
                table[name] = cls
        return MappingProxyType(dict(sorted(table.items())))

    def _find(self, name: str) -> type[T] | None:
        if "_all" in self.__dict__:
            return self._all.get(name)
        if name not in self._found:
            literal, computed = self._written
            modules = [*literal.get(name, ("", ()))[1], *computed]
            own = (cls for module in modules for cls in self._classes(importlib.import_module(module)))
            classes = (cls for source in (own, self._foreign) for cls in source)
            self._found[name] = next((cls for cls in classes if name in self._names(cls)), None)
        return self._found[name]

    @cached_property
    def _modules(self) -> tuple[tuple[str, Path], ...]:
        """The names of all modules of the packages, and their files."""
        roots = [importlib.import_module(package) for package in self._packages]
        return tuple(found for root in roots for found in _modules_below(root.__path__, root.__name__))

    @cached_property
    def _written(self) -> tuple[Mapping[str, tuple[str, Sequence[str]]], Sequence[str]]:
        """By each name that classes write down what they write and the modules; and those that compute their names."""
        literal: dict[str, tuple[str, list[str]]] = {}
        computed = []
        for module, file in self._modules:
            written = self._texts(file)
            if written is None:
                computed.append(module)
            for text in dict.fromkeys(written or ()):
                literal.setdefault(self._spell(text), (text, []))[1].append(module)
        return literal, computed

    def _texts(self, file: Path) -> list[str] | None:
        """What the classes of a file give to the attributes; None where that is more than texts."""
        try:
            content = file.read_bytes()
            if not any(name in content for name in map(str.encode, self._attributes)):
                return []
            source = content.decode().replace("\r\n", "\n")
        except (OSError, ValueError):
            return None
        found: list[str] = []
        for start in (at for name in self._attributes for at in _assigned_name_pattern(source, name)):
            value = _TEXTS.match(source, start)
            if value is None:
                return None
            found += (text["one"] or text["two"] for text in _TEXT.finditer(value[0]) if text.lastgroup)
        return found

    @cached_property
    def _foreign(self) -> tuple[type[T], ...]:
        """The classes of the entry points."""
        found = []
        for point in sorted(entry_points_of(self._group), key=lambda p: (p.name, p.value)):
            try:
                loaded = point.load()
            except Exception as error:  # noqa: BLE001 - one broken package must not keep the others from working
                said = (point.name, point.value, self._group, error)
                logging.getLogger("simkit").warning("entry point %s (%s) of %s: %r", *said)
                continue
            if inspect.isclass(loaded) and issubclass(loaded, self._base):
                found.append(loaded)
        return tuple(found)

    def _classes(self, module: ModuleType) -> list[type[T]]:
        """The classes that a module defines."""
        own = (cls for cls in vars(module).values() if inspect.isclass(cls) and cls.__module__ == module.__name__)
        return [cls for cls in own if issubclass(cls, self._base) and not inspect.isabstract(cls)]


def _modules_below(folders: Iterable[str], package: str) -> Iterator[tuple[str, Path]]:
    """The modules in a package's folders and in those below, by full name, with their files; imports nothing."""
    for folder in folders:
        for info in pkgutil.iter_modules([folder]):
            name, place = f"{package}.{info.name}", Path(folder, info.name)
            yield name, place / "__init__.py" if info.ispkg else place.with_name(f"{info.name}.py")
            if info.ispkg:
                yield from _modules_below([str(place)], name)


def _assigned_name_pattern(source: str, name: str) -> Iterator[int]:
    """Where in a module's text, behind the equals sign, a class attribute of this name is given its value."""
    at = source.find(f"\n    {name}")
    while at >= 0:
        line = source[at + 5 + len(name) : source.find("\n", at + 1)]
        last = max(_OUTER, key=lambda word: source.rfind(word, 0, at))
        if line[:1] in " :=" and "=" in line and last == _OUTER[0]:
            yield at + 5 + len(name) + line.index("=") + 1
        at = source.find(f"\n    {name}", at + 1)

"""Registries of classes from the modules of a package and from entry points.

A new class needs only a new file, because there is no list of classes to edit.
"""

from __future__ import annotations

import importlib
import inspect
import logging
import os
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
_FUNCTIONS = "\ndef ", "\nasync def "


def entry_points_of(group: str) -> list[EntryPoint]:
    """Return the entry points of a group.

    Reading all entry points takes 20 ms, so they are cached until a folder of `sys.path` changes.
    """
    state = tuple((folder, _folder_time(Path(folder))) for folder in sys.path)
    return list(_all_entry_points(state).select(group=group))


@lru_cache(maxsize=1)
def _all_entry_points(_state: tuple[tuple[str, int], ...]) -> Any:  # its type differs between Python 3.11 and 3.12
    return entry_points()


def _folder_time(folder: Path) -> int:
    """Return the time at which an entry of a folder was last added or removed [ns]; 0 if there is no folder."""
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return 0


class Kinds(Mapping[str, type[T]], Generic[T]):
    """Mapping from names to classes: subclasses of `base` in the packages and in the entry points of a group.

    A lookup imports only the module of the class with that name, because the names are read from the text of the
    modules. Iteration and `len` import every module.

    Args:
        packages: dotted names of the packages whose modules are read, including modules of sub-packages.
        group: entry-point group.
        base: required base class; abstract and nameless classes are skipped.
        names: function that returns the names of a class.
        attributes: class attributes that `names` reads: tuples of texts.
        spell: function that converts a text of these attributes to a name, as `names` does.

    Raises:
        RuntimeError: two classes have the same name; raised when all classes are listed.
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
        self._assignment = re.compile(rb"\n    (?:%b)[ :=]" % "|".join(attributes).encode())
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
        """Text of each name as written in the source code of its class; imports only modules that compute names."""
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
        """All classes by name, sorted by name."""
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
            classes = self._possible_classes([*literal.get(name, ("", ()))[1], *computed])
            self._found[name] = next((cls for cls in classes if name in self._names(cls)), None)
        return self._found[name]

    def _possible_classes(self, modules: Iterable[str]) -> Iterator[type[T]]:
        """Yield the classes of some modules, then those of the entry points, which take 10 ms to read."""
        for module in modules:
            yield from self._classes(importlib.import_module(module))
        yield from self._foreign

    @cached_property
    def _modules(self) -> tuple[tuple[str, str], ...]:
        """Names of all modules of the packages, and their files."""
        roots = [importlib.import_module(package) for package in self._packages]
        return tuple(found for root in roots for found in _modules_below(root.__path__, root.__name__))

    @cached_property
    def _written(self) -> tuple[Mapping[str, tuple[str, Sequence[str]]], Sequence[str]]:
        """Names that are literal texts in the source code, with text and modules; and modules that compute names."""
        literal: dict[str, tuple[str, list[str]]] = {}
        computed = []
        for module, file in self._modules:
            written = self._texts(file)
            if written is None:
                computed.append(module)
            for text in dict.fromkeys(written or ()):
                literal.setdefault(self._spell(text), (text, []))[1].append(module)
        return literal, computed

    def _texts(self, file: str) -> list[str] | None:
        """Return the texts that a file's classes assign to the attributes; None if one is not a literal text."""
        try:
            with open(file, "rb", buffering=0) as stream:  # 340 files of plugins: 7 ms, with `Path` 11
                content = stream.read()
            if not self._assignment.search(content):
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
        """Classes of the entry points."""
        found: list[type[T]] = []
        log = logging.getLogger("simkit")
        for point in sorted(entry_points_of(self._group), key=lambda p: (p.name, p.value)):
            try:
                loaded = point.load()
            except Exception as error:  # noqa: BLE001 - one broken package must not keep the others from working
                log.warning("entry point %s (%s) of %s: %r", point.name, point.value, self._group, error)
                continue
            if inspect.isclass(loaded) and issubclass(loaded, self._base):
                found.append(loaded)
            else:
                log.warning(
                    "entry point %s (%s) of %s: %r is not a subclass of %s",
                    *(point.name, point.value, self._group, loaded, self._base.__name__),
                )
        return tuple(found)

    def _classes(self, module: ModuleType) -> list[type[T]]:
        """Return the concrete classes that a module defines."""
        own = (cls for cls in vars(module).values() if inspect.isclass(cls) and cls.__module__ == module.__name__)
        return [cls for cls in own if issubclass(cls, self._base) and not inspect.isabstract(cls)]


def _modules_below(folders: Iterable[str], package: str) -> Iterator[tuple[str, str]]:
    """Yield name and file of each module in a package and its sub-packages, without importing the modules.

    `pkgutil.iter_modules` would take 7 ms instead of 1 ms for the plugins.
    """
    for folder in filter(os.path.isdir, folders):
        with os.scandir(folder) as entries:
            found = sorted((entry.name, entry.is_dir()) for entry in entries)
        for name, is_folder in found:
            path, stem = os.path.join(folder, name), name.removesuffix(".py")  # noqa: PTH118 - as above
            if not stem.isidentifier():  # not a module, for example `.#lidar.py`, the lock file of an editor
                continue
            module = f"{package}.{stem}"
            if is_folder and os.path.isfile(init := os.path.join(path, "__init__.py")):  # noqa: PTH113, PTH118
                yield module, init
                yield from _modules_below([path], module)
            elif name.endswith(".py") and name != "__init__.py":
                yield module, path


def _assigned_name_pattern(source: str, name: str) -> Iterator[int]:
    """Yield the offset after each `=` in a module's text that assigns a class attribute of this name."""
    at = source.find(f"\n    {name}")
    while at >= 0:
        line = source[at + 5 + len(name) : source.find("\n", at + 1)]
        begin = max(0, source.rfind("\nclass ", 0, at))
        is_in_function = any(source.find(word, begin, at) >= 0 for word in _FUNCTIONS)
        if line[:1] in " :=" and "=" in line and not is_in_function:
            yield at + 5 + len(name) + line.index("=") + 1
        at = source.find(f"\n    {name}", at + 1)

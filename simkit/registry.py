"""Registries of classes from the modules of a package, from packs and from entry points.

A new class needs only a new file, because there is no list of classes to edit.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import EntryPoint
from types import MappingProxyType
from typing import Generic, TypeVar

from simkit.entry_points import entry_points_of
from simkit.packs import Pack, fault_text, foreign_packs, is_shipped_module, shipped_packs, warn_of_pack

T = TypeVar("T")

_TEXTS = re.compile(r"""[ ]*\((?:\s|,|"[^"\\\n]*"|'[^'\\\n]*'|#[^\n]*\n)*\)[ ]*(?:#[^\n]*)?\n""")
_TEXT = re.compile(r"""#[^\n]*|"(?P<one>[^"\\\n]+)"|'(?P<two>[^'\\\n]+)'""")
_FUNCTIONS = "\ndef ", "\nasync def "


class _UnusableClass(Exception):
    """Class, or other object, of another distribution that cannot be used; its text is for the user."""


@dataclass(frozen=True, slots=True)
class _Source:
    """Place of classes: a module of a package, or an entry point.

    Attributes:
        module: name of the module.
        file: file of the module; empty if it is unknown.
        point: the entry point; None for a module of a package.
    """

    module: str
    file: str
    point: EntryPoint | None = None

    @property
    def package(self) -> str:
        """Name of the package."""
        return self.module.partition(".")[0]

    def describe(self, error: BaseException) -> str:
        """Return place and text of an exception at the import; for an entry point, with its name."""
        folder = os.path.dirname(self.file) or "\0"  # noqa: PTH120 - see `_modules_below`
        text = str(error) if isinstance(error, _UnusableClass) else fault_text(error, folder)
        return text if self.point is None else f"entry point {self.point.name} ({self.point.value}): {text}"


@dataclass(frozen=True, slots=True)
class _Names:
    """Names of classes in some sources.

    Attributes:
        literal: text and sources of each name that is a literal text in the source code.
        computed: sources that compute names.
    """

    literal: Mapping[str, tuple[str, Sequence[_Source]]]
    computed: Sequence[_Source]


class Kinds(Mapping[str, type[T]], Generic[T]):
    """Mapping from names to classes: subclasses of `base` in a package, in packs and in the entry points of a group.

    A lookup imports only the module of the class with that name, because the names are read from the text of the
    modules. Modules of other distributions are searched only for names that simkit does not have. Iteration and `len`
    import every module.

    Args:
        package: dotted name of the package whose modules are read, including modules of sub-packages. In packs, the
            folder with its last name is read.
        group: entry-point group.
        base: required base class; abstract and nameless classes are skipped.
        names: function that returns the names of a class.
        attributes: class attributes that `names` reads: tuples of texts.
        spell: function that converts a text of these attributes to a name, as `names` does.

    When all classes are listed, a class of another distribution does not get a name that another class has already.

    Raises:
        RuntimeError: two classes of simkit have the same name; raised when all classes are listed.
    """

    def __init__(
        self,
        package: str,
        group: str,
        base: type[T],
        names: Callable[[type[T]], Iterable[str]],
        attributes: Sequence[str] = ("types",),
        spell: Callable[[str], str] = str,
    ) -> None:
        self._package = package
        self._group, self._base, self._names = group, base, names
        self._attributes, self._spell = attributes, spell
        self._assignment = re.compile(rb"\n    (?:%b)[ :=]" % "|".join(attributes).encode())
        self._found: dict[str, type[T] | None] = {}
        self._faults: dict[_Source, str] = {}

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
        tiers = self._shipped_names, self._foreign_names
        classes = (cls for tier in tiers for source in tier.computed for cls in self._classes(source))
        texts = [text for cls in classes for attribute in self._attributes for text in getattr(cls, attribute, ())]
        literals = {name: text for tier in reversed(tiers) for name, (text, _) in tier.literal.items()}
        return MappingProxyType(dict(sorted((literals | {self._spell(text): text for text in texts}).items())))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({dict(self._all)!r})"

    @cached_property
    def _all(self) -> Mapping[str, type[T]]:
        """All classes by name, sorted by name."""
        table: dict[str, type[T]] = {}
        for cls in dict.fromkeys(cls for source in self._shipped for cls in self._classes(source)):
            for name, other in self._taken_names(cls, table).items():
                raise RuntimeError(f"{name!r} is claimed by {other.__module__} and by {cls.__module__}")
            table |= dict.fromkeys(self._names(cls), cls)
        for source in self._foreign:
            for cls in self._classes(source):
                taken = self._taken_names(cls, table)
                for other in dict.fromkeys(taken.values()):
                    names = ", ".join(repr(name) for name in taken if taken[name] is other)
                    text = f"class {cls.__name__} cannot have the name {names} of {other.__module__}.{other.__name__}"
                    warn_of_pack(source.package, f"{_place_of(cls)}: {text}")
                table |= {name: cls for name in self._names(cls) if name not in taken}
        return MappingProxyType(dict(sorted(table.items())))

    def _taken_names(self, cls: type[T], table: Mapping[str, type[T]]) -> dict[str, type[T]]:
        """Return those names of a class that other classes have, with these classes."""
        return {name: table[name] for name in self._names(cls) if table.get(name, cls) is not cls}

    def fault(self, name: str) -> str:
        """Return the package, file, line and fault of a broken module that has a class of this name; else ""."""
        sources = self._foreign_names.literal.get(name, ("", ()))[1]
        return next((f"{s.package}: {self._faults[s]}" for s in sources if s in self._faults), "")

    def _find(self, name: str) -> type[T] | None:
        if "_all" in self.__dict__:
            return self._all.get(name)
        if name not in self._found:
            self._found[name] = next((cls for cls in self._possible_classes(name) if name in self._names(cls)), None)
        return self._found[name]

    def _possible_classes(self, name: str) -> Iterator[type[T]]:
        """Yield the classes that can have a name: those of simkit, then those of other distributions."""
        for tier in ("_shipped_names", "_foreign_names"):
            names: _Names = getattr(self, tier)  # entry points take 10 ms to read; most names need none
            for source in (*names.literal.get(name, ("", ()))[1], *names.computed):
                yield from self._classes(source)

    @cached_property
    def _shipped(self) -> tuple[_Source, ...]:
        """Modules of the package, and of the packs that simkit ships."""
        root = importlib.import_module(self._package)
        core = (_Source(*module) for module in _modules_below(root.__path__, root.__name__))
        return *core, *self._of_packs(shipped_packs())

    @cached_property
    def _foreign(self) -> tuple[_Source, ...]:
        """Modules of the packs of others, and entry points."""
        points = sorted(entry_points_of(self._group), key=lambda p: (p.name, p.value))
        return *self._of_packs(foreign_packs()), *(_Source(p.module, _file_of(p.module), p) for p in points)

    def _of_packs(self, packs: Iterable[Pack]) -> Iterator[_Source]:
        folder = self._package.rpartition(".")[2]
        for pack in (pack for pack in packs if pack.package != self._package.partition(".")[0]):
            place, name = os.path.join(pack.folder, folder), f"{pack.package}.{folder}"  # noqa: PTH118 - see below
            if os.path.isfile(file := os.path.join(place, "__init__.py")):  # noqa: PTH113, PTH118
                yield _Source(name, file)
            yield from (_Source(*module) for module in _modules_below([place], name))

    @cached_property
    def _shipped_names(self) -> _Names:
        return self._names_in(self._shipped)

    @cached_property
    def _foreign_names(self) -> _Names:
        return self._names_in(self._foreign)

    def _names_in(self, sources: Iterable[_Source]) -> _Names:
        """Read the names in the text of some sources."""
        literal: dict[str, tuple[str, list[_Source]]] = {}
        computed = []
        for source in sources:
            written = self._texts(source.file)
            if written is None or (not written and source.point is not None):  # its class can be another module's
                computed.append(source)
            for text in dict.fromkeys(written or ()):
                literal.setdefault(self._spell(text), (text, []))[1].append(source)
        return _Names(literal, computed)

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
        literals: list[str] = []
        for start in (at for name in self._attributes for at in _assigned_name_pattern(source, name)):
            value = _TEXTS.match(source, start)
            if value is None:
                return None
            literals += (text["one"] or text["two"] for text in _TEXT.finditer(value[0]) if text.lastgroup)
        return literals

    def _classes(self, source: _Source) -> list[type[T]]:
        """Return the concrete classes of a source; none, with a warning, for a package of others that is broken."""
        if source in self._faults:
            return []
        try:
            loaded = importlib.import_module(source.module) if source.point is None else source.point.load()
            if source.point is not None:
                if inspect.isclass(loaded) and issubclass(loaded, self._base):
                    return [loaded]
                raise _UnusableClass(f"{loaded!r} is not a subclass of {self._base.__name__}")
            own = (cls for cls in vars(loaded).values() if inspect.isclass(cls) and cls.__module__ == loaded.__name__)
            classes = [cls for cls in own if issubclass(cls, self._base) and not inspect.isabstract(cls)]
            if not is_shipped_module(source.module):
                for cls in classes:
                    self._check_names(cls)
        except (Exception, SystemExit) as error:
            if is_shipped_module(source.module):
                raise
            self._faults[source] = source.describe(error)  # one broken package must not keep the others from working
            warn_of_pack(source.package, self._faults[source])
            return []
        return classes

    def _check_names(self, cls: type[T]) -> None:
        """Check the names of a class of another distribution.

        Raises:
            _UnusableClass: the names are not a tuple of texts.
        """
        for attribute in self._attributes:
            names = getattr(cls, attribute, ())
            if not isinstance(names, (tuple, list)) or not all(isinstance(name, str) for name in names):
                text = f"{cls.__name__}.{attribute}: found {names!r:.80}; expected a tuple of texts"
                raise _UnusableClass(f"{_place_of(cls)}: {text}")


def _place_of(cls: type) -> str:
    """Return file and line of a class."""
    try:
        return f"{inspect.getsourcefile(cls)}:{inspect.getsourcelines(cls)[1]}"
    except (OSError, TypeError):
        return cls.__module__


def _file_of(module: str) -> str:
    """Return the file of a module without importing it; an empty text if it is not found in a folder."""
    package, *names = module.split(".")
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        return ""
    if spec is None:
        return ""
    if not names:
        return spec.origin or ""
    for folder in spec.submodule_search_locations or ():
        path = os.path.join(folder, *names)  # noqa: PTH118 - as below
        for file in (f"{path}.py", os.path.join(path, "__init__.py")):  # noqa: PTH118
            if os.path.isfile(file):  # noqa: PTH113
                return file
    return ""


def _modules_below(folders: Iterable[str], package: str) -> Iterator[tuple[str, str]]:
    """Yield name and file of each module in a package and its sub-packages, without importing the modules.

    `pkgutil.iter_modules` would take 7 ms instead of 1 ms for the plugins.
    """
    for folder in filter(os.path.isdir, folders):
        with os.scandir(folder) as entries:
            listing = sorted((entry.name, entry.is_dir()) for entry in entries)
        for name, is_folder in listing:
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

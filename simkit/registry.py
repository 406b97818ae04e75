"""Registries computed from a package's modules and from entry points: one file per addition, no duplicates."""

from __future__ import annotations

import importlib
import inspect
import logging
import pkgutil
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

T = TypeVar("T")


_read: dict[tuple[tuple[str, int], ...], Any] = {}


def points_of(group: str) -> list[EntryPoint]:
    """The entry points of a group. To read them all takes 20 ms: they are kept until a folder of `sys.path` changes."""
    state = tuple((folder, _changed(Path(folder))) for folder in sys.path)
    if state not in _read:
        _read.clear()
        _read[state] = entry_points()
    return list(_read[state].select(group=group))


def _changed(folder: Path) -> int:
    """When something was last put into a folder or taken out [ns]; 0 where there is none."""
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return 0


def discover(
    packages: str | Sequence[str], group: str, base: type[T], names: Callable[[type[T]], Iterable[str]]
) -> Mapping[str, type[T]]:
    """Every class under `packages` and in the entry points `group` that is a `base`, by each name it answers to.

    Args:
        packages: dotted names of the packages whose modules (and sub-packages' modules) are read.
        group: entry-point group.
        base: classes must derive from it; abstract and nameless ones are passed over.
        names: gives the names that a class answers to.

    Raises:
        RuntimeError: two classes answer to one name.
    """
    classes: dict[type[T], None] = {}
    roots = [importlib.import_module(p) for p in ((packages,) if isinstance(packages, str) else packages)]
    for info in (i for root in roots for i in pkgutil.walk_packages(root.__path__, root.__name__ + ".")):
        module = importlib.import_module(info.name)
        for cls in vars(module).values():
            own = inspect.isclass(cls) and cls.__module__ == module.__name__
            if own and issubclass(cls, base) and not inspect.isabstract(cls):
                classes[cls] = None
    for point in sorted(points_of(group), key=lambda p: (p.name, p.value)):
        try:
            loaded = point.load()
        except Exception as error:  # noqa: BLE001 - one broken package must not keep the others from working
            logging.getLogger("simkit").warning("entry point %s (%s) of %s: %r", point.name, point.value, group, error)
            continue
        if inspect.isclass(loaded) and issubclass(loaded, base):
            classes[loaded] = None
    table: dict[str, type[T]] = {}
    for cls in classes:
        for name in names(cls):
            if name in table and table[name] is not cls:
                raise RuntimeError(f"{name!r} is claimed by {table[name].__module__} and by {cls.__module__}")
            table[name] = cls
    return MappingProxyType(dict(sorted(table.items())))

"""Modules that moved from the core to a pack: an import by the old name works for two minor versions, with a warning.

The file `moved_modules.txt` in the package of a shipped pack has a line for each old name that the documents named: the
old name, the new one, and the version of the move. The finder is asked only for modules that Python does not find.
"""

from __future__ import annotations

import importlib
import sys
from functools import cache
from importlib.machinery import ModuleSpec
from types import CodeType, ModuleType

from simkit.deprecation import warn_deprecated

_FILE = "moved_modules.txt"
_PROGRAM = ".__main__"  # module of a package that `python -m` runs


@cache
def _moves() -> dict[str, tuple[str, str]]:
    """Return the new name of each moved module, and the version of its move, by the old name."""
    from simkit.packs import shipped_packs

    moves: dict[str, tuple[str, str]] = {}
    for pack in shipped_packs():
        try:
            with open(f"{pack.folder}/{_FILE}", encoding="utf-8") as file:
                moves.update((old, (new, since)) for old, new, since in map(str.split, file))
        except FileNotFoundError:
            continue
    return moves


def first_name(module: str) -> str:
    """Return the name that a module had before it moved to a pack; the same name for all other modules."""
    return next((old for old, (new, _) in _moves().items() if new == module), module)


class _Loader:
    """Loader of a module with the names of the moved one."""

    def __init__(self, new: str, since: str) -> None:
        self._new, self._since = new, since

    def create_module(self, spec: ModuleSpec) -> None:
        """Leave the creation of an empty module to Python."""

    def exec_module(self, module: ModuleType) -> None:
        """Import the module by its new name, and copy its names."""
        warn_deprecated(module.__name__, self._new, since=self._since)
        moved = vars(importlib.import_module(self._new))
        vars(module).update({name: value for name, value in moved.items() if not name.startswith("__")})

    def get_code(self, _: str) -> CodeType | None:
        """Return the code of the moved module, for `python -m`."""
        moved = importlib.import_module(self._new)
        code: CodeType | None = moved.__spec__.loader.get_code(self._new)  # type: ignore[union-attr]  # a file has a loader
        return code


class _Finder:
    """Finder of moved modules."""

    @staticmethod
    def find_spec(name: str, *_: object) -> ModuleSpec | None:
        """Return how to load a module by its old name, or the package of one; None for all others."""
        package = name.removesuffix(_PROGRAM)
        if not name.startswith("simkit.") or not any(f"{old}.".startswith(f"{package}.") for old in _moves()):
            return None
        is_package = package == name
        if package not in _moves():
            return ModuleSpec(name, None, is_package=True) if is_package else None
        new, since = _moves()[package]
        loader = _Loader(new + ("" if is_package else _PROGRAM), since)
        return ModuleSpec(name, loader, is_package=is_package)  # type: ignore[arg-type]  # a loader has no base class


def install() -> None:
    """Let Python find moved modules, after all others."""
    if _Finder not in sys.meta_path:
        sys.meta_path.append(_Finder)

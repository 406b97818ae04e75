"""Import hook that maps Gazebo's module names, in every version and spelling, to modules of simkit.

All versions and both spellings have one implementation: `gz.sim8`, `gz.sim` and `ignition.gazebo6` all import
`simkit_gz_python.sim`. Gazebo's names can be imported only between `enter` and `leave`, or after `install`. If
the real Gazebo module is installed, it is imported instead, except with `shadow`.
"""

from __future__ import annotations

import importlib
import importlib.util
import re
import sys
import types
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from typing import Final

_FAMILIES: Final = {
    "sim": "sim",
    "gazebo": "sim",
    "math": "math",
    "common": "common",
    "transport": "transport",
    "msgs": "msgs",
    "sdformat": "sdformat",
}
"""Name of simkit's module for each module of Gazebo; the version number is removed from Gazebo's name."""

_PACKAGE: Final = __name__.rpartition(".")[0]
_UNSUPPORTED_MODULES: Final = frozenset(
    ("gui", "rendering", "sensors", "physics", "launch", "plugin", "utils", "fuel_tools", "common_av")
)
_GAZEBO_NAME: Final = re.compile(
    r"^(?:(?P<root>gz|ignition)(?:\.(?P<module>[a-z_]+?)\d*)?|(?P<sdf>sdformat)\d*)(?:\.(?P<rest>.+))?$"
)
_OURS: Final = "__simkit_shim__"


def module_behind(name: str) -> str | None:
    """Return the name of simkit's module for a module name of Gazebo.

    The result is empty for the packages `gz` and `ignition`, which have no content, and None for any unknown name.
    """
    match = _GAZEBO_NAME.match(name)
    if match is None:
        return None
    if match["root"] and not match["module"]:
        return ""
    family = _FAMILIES.get(match["sdf"] or match["module"])
    if family is None:
        return None
    target = f"{_PACKAGE}.{family}"
    if not match["rest"]:
        return target
    if family == "msgs":
        return f"{target}.{match['rest']}"
    inner = f"{target}.{match['rest']}"
    return inner if match["rest"] in ("components",) else None


class ShimFinder(MetaPathFinder):
    """Import finder for Gazebo's modules in this package.

    Attributes:
        modules: modules that were imported, by Gazebo's name; kept after `leave` for the next import.
        imported_names: Gazebo's names of the modules that are in `sys.modules` now.
        depth: number of calls of `enter` that no call of `leave` has ended yet.
    """

    def __init__(self) -> None:
        self.modules: dict[str, types.ModuleType] = {}
        self.imported_names: list[str] = []
        self.depth = 0

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> ModuleSpec | None:
        module_name = module_behind(name)
        if module_name is None:
            self._raise_if_unsupported(name)
            return None
        return ModuleSpec(name, _ShimLoader(module_name, self), is_package=True)

    @staticmethod
    def _raise_if_unsupported(name: str) -> None:
        """Raise an ImportError with advice for a module or name of Gazebo that simkit does not support."""
        parent, _, leaf = name.rpartition(".")
        known = module_behind(parent) if parent else None
        # for `from gz.sim import leaf`, Python's own message would have no advice
        if known and not leaf.startswith("_"):
            try:
                getattr(sys.modules.get(parent) or importlib.import_module(known), leaf)
            except AttributeError as error:
                raise ImportError(str(error), name=parent) from None
        root, _, rest = name.partition(".")
        if root in ("gz", "ignition") and rest.rstrip("0123456789") in _UNSUPPORTED_MODULES:
            families = sorted(set(_FAMILIES) - {"gazebo"})
            message = f"simkit has no {name}; supported modules of Gazebo: {', '.join(families)}"
            raise ModuleNotFoundError(message, name=name)


class _ShimLoader(Loader):
    """Loader that copies the names of simkit's module into a new module with Gazebo's name, once per program."""

    def __init__(self, target: str, finder: ShimFinder) -> None:
        self._target, self._finder = target, finder

    def create_module(self, spec: ModuleSpec) -> types.ModuleType | None:
        return self._finder.modules.get(spec.name)

    def exec_module(self, module: types.ModuleType) -> None:
        namespace = vars(module)
        self._finder.imported_names.append(module.__name__)
        if _OURS not in namespace:
            namespace[_OURS] = self._target
            self._fill(namespace)
        self._finder.modules[module.__name__] = module

    def _fill(self, namespace: dict[str, object]) -> None:
        if not self._target:
            return
        messages = f"{_PACKAGE}.msgs"
        if self._target.startswith(f"{messages}."):
            contents = importlib.import_module(messages).contents_of(self._target.removeprefix(f"{messages}."))
            namespace.update(contents)
            return
        real = importlib.import_module(self._target)
        namespace.update({name: value for name, value in vars(real).items() if not name.startswith("__")})
        namespace.update(
            {name: vars(real)[name] for name in ("__doc__", "__all__", "__getattr__") if name in vars(real)}
        )


_finder: Final = ShimFinder()


def is_shim(module: types.ModuleType) -> bool:
    """Check whether a module with Gazebo's name comes from simkit."""
    return _OURS in getattr(module, "__dict__", {})


def enter(shadow: bool = False) -> None:
    """Make Gazebo's modules importable from simkit; every call needs a matching `leave`.

    Args:
        shadow: import simkit's modules even if the real ones are installed.
    """
    _finder.depth += 1
    if _finder.depth == 1:
        sys.meta_path.append(_finder)
    if shadow and sys.meta_path[0] is not _finder:
        sys.meta_path.remove(_finder)
        sys.meta_path.insert(0, _finder)


def leave() -> None:
    """End one `enter`; the last one stops the imports. Modules that a program has already imported keep working."""
    _finder.depth -= 1
    if _finder.depth:
        return
    sys.meta_path.remove(_finder)
    if _finder.imported_names:
        for name in _finder.imported_names:
            sys.modules.pop(name, None)
        _finder.imported_names.clear()


@contextmanager
def importable(shadow: bool = False) -> Iterator[None]:
    """Make Gazebo's modules importable within a `with` block, after a new search for real, installed modules."""
    if not _finder.depth and not shadow:
        _forget_shims_of_installed()
    enter(shadow)
    try:
        yield
    finally:
        leave()


def _forget_shims_of_installed() -> None:
    """Remove simkit's modules for which the real modules have been installed in the meantime."""
    modules = _finder.modules
    for root in {name.partition(".")[0] for name in modules}:
        if _real_location(root):
            for name in [n for n in modules if n.partition(".")[0] == root]:
                del modules[name]


def installed() -> dict[str, str]:
    """Return the file of each installed module of the real Gazebo, by module name."""
    sims, maths = (f"gz.sim{v}" for v in range(7, 12)), (f"gz.math{v}" for v in range(6, 11))
    older = "ignition.gazebo", "ignition.math", "sdformat", *(f"sdformat{v}" for v in range(12, 18))
    names = "gz.sim", *sims, "gz.math", *maths, *older
    return {name: location for name in names if (location := _real_location(name))}


def _real_location(name: str) -> str:
    """Return the file of a module of the real Gazebo; empty if only simkit has a module of this name, or nobody."""
    module = sys.modules.get(name)
    if module is not None:
        return "" if is_shim(module) else str(getattr(module, "__file__", None) or "a package")
    others = [finder for finder in sys.meta_path if finder is not _finder]
    parent, _, _ = name.rpartition(".")
    path = None
    if parent:
        outer = sys.modules.get(parent)
        if outer is not None and is_shim(outer):
            return ""
        spec = _find_spec(others, parent, None)
        if spec is None or spec.submodule_search_locations is None:
            return ""
        path = list(spec.submodule_search_locations)
    spec = _find_spec(others, name, path)
    return str(spec.origin or "a package") if spec is not None else ""


def _find_spec(finders: Sequence[object], name: str, path: Sequence[str] | None) -> ModuleSpec | None:
    for finder in finders:
        find = getattr(finder, "find_spec", None)
        spec: ModuleSpec | None = find(name, path, None) if find is not None else None
        if spec is not None:
            return spec
    return None

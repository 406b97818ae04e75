"""Import hook that finds Gazebo's modules in simkit, by every version and spelling of their names.

Every version and both spellings mean one implementation: `gz.sim8`, `gz.sim`, `ignition.gazebo6` are
`simkit.plugins.gz_python.sim`. They can be imported only between `enter` and `leave`, or after `install`, and
what is really installed under such a name goes first unless it is to be shadowed.
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
from typing import Any, Final

_FAMILIES: Final = {
    "sim": "sim",
    "gazebo": "sim",
    "math": "math",
    "common": "common",
    "transport": "transport",
    "msgs": "msgs",
    "sdformat": "sdformat",
}
"""Module of Gazebo, without its version -> ours."""

_PACKAGE: Final = __name__.rpartition(".")[0]
_BESIDE: Final = {f"{_PACKAGE}.sim": "simkit.testing.gz_fixture"}
"""Our module -> a module of a higher room whose names are offered with it: `TestFixture` loads worlds."""

_UNSUPPORTED_MODULES: Final = frozenset(
    ("gui", "rendering", "sensors", "physics", "launch", "plugin", "utils", "fuel_tools", "common_av")
)
_GAZEBO_NAME: Final = re.compile(
    r"^(?:(?P<root>gz|ignition)(?:\.(?P<module>[a-z_]+?)\d*)?|(?P<sdf>sdformat)\d*)(?:\.(?P<rest>.+))?$"
)
_OURS: Final = "__simkit_shim__"


def module_behind(name: str) -> str | None:
    """The module of ours behind a name of Gazebo's: empty for a bare `gz` or `ignition`; None for other names."""
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
    """Finds Gazebo's modules in this package.

    Attributes:
        modules: modules of simkit under Gazebo's names, whether they can be imported now or not.
        imported_names: the names of those that Python knows now.
        depth: how many times `enter` was called without its `leave`.
    """

    def __init__(self) -> None:
        self.modules: dict[str, types.ModuleType] = {}
        self.imported_names: list[str] = []
        self.depth = 0

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> ModuleSpec | None:
        found = module_behind(name)
        if found is None:
            self._refuse(name)
            return None
        return ModuleSpec(name, _ShimLoader(found, self), is_package=True)

    @staticmethod
    def _refuse(name: str) -> None:
        """Says of a module of Gazebo that simkit has none, where Python would only say that it is not there."""
        parent, _, leaf = name.rpartition(".")
        known = module_behind(parent) if parent else None
        if known and not leaf.startswith("_"):  # `from gz.sim import leaf`: Python's own words would not say more
            try:
                getattr(sys.modules.get(parent) or importlib.import_module(known), leaf)
            except AttributeError as error:
                raise ImportError(str(error), name=parent) from None
        root, _, rest = name.partition(".")
        if root in ("gz", "ignition") and rest.rstrip("0123456789") in _UNSUPPORTED_MODULES:
            families = sorted(set(_FAMILIES) - {"gazebo"})
            message = f"simkit has no {name}; of Gazebo's Python it has {', '.join(families)}"
            raise ModuleNotFoundError(message, name=name)


class _ShimLoader(Loader):
    """Fills a module under Gazebo's name with what ours offers; once made it is the same for good."""

    def __init__(self, target: str, finder: ShimFinder) -> None:
        self._target, self._finder = target, finder

    def create_module(self, spec: ModuleSpec) -> types.ModuleType | None:
        return self._finder.modules.get(spec.name)

    def exec_module(self, module: types.ModuleType) -> None:
        own = vars(module)
        self._finder.imported_names.append(module.__name__)
        if _OURS not in own:
            own[_OURS] = self._target
            self._fill(own)
        self._finder.modules[module.__name__] = module

    def _fill(self, own: dict[str, Any]) -> None:
        if not self._target:
            return
        messages = f"{_PACKAGE}.msgs"
        if self._target.startswith(f"{messages}."):
            contents = importlib.import_module(messages).contents_of(self._target.removeprefix(f"{messages}."))
            own.update(contents)
            return
        real = importlib.import_module(self._target)
        own.update({name: value for name, value in vars(real).items() if not name.startswith("__")})
        own.update({name: vars(real)[name] for name in ("__doc__", "__all__", "__getattr__") if name in vars(real)})
        if self._target in _BESIDE:
            other = importlib.import_module(_BESIDE[self._target])
            own.update({name: vars(other)[name] for name in other.__all__})
            own["__all__"] = sorted([*own["__all__"], *other.__all__])


_finder: Final = ShimFinder()


def is_shim(module: types.ModuleType) -> bool:
    """Check whether a module is one of ours under Gazebo's name."""
    return _OURS in getattr(module, "__dict__", {})


def enter(shadow: bool = False) -> None:
    """Lets Gazebo's modules be imported from now on; to be matched by `leave`.

    Args:
        shadow: ours go before installed ones.
    """
    _finder.depth += 1
    if _finder.depth == 1:
        sys.meta_path.append(_finder)
    if shadow and sys.meta_path[0] is not _finder:
        sys.meta_path.remove(_finder)
        sys.meta_path.insert(0, _finder)


def leave() -> None:
    """Takes Gazebo's names away again, once as often as `enter`; what was imported stays with whoever has it."""
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
    """Gazebo's modules can be imported within; looks anew for what is really installed."""
    if not _finder.depth and not shadow:
        _forget_shims_of_installed()
    enter(shadow)
    try:
        yield
    finally:
        leave()


def _forget_shims_of_installed() -> None:
    """Lets go of our modules where the real ones have been installed, or found, since."""
    modules = _finder.modules
    for root in {name.partition(".")[0] for name in modules}:
        if _real_location(root):
            for name in [n for n in modules if n.partition(".")[0] == root]:
                del modules[name]


def installed() -> dict[str, str]:
    """Find what is really installed under Gazebo's names and would be imported: name -> location."""
    sims, maths = (f"gz.sim{v}" for v in range(7, 12)), (f"gz.math{v}" for v in range(6, 11))
    older = "ignition.gazebo", "ignition.math", "sdformat", *(f"sdformat{v}" for v in range(12, 18))
    names = "gz.sim", *sims, "gz.math", *maths, *older
    return {name: location for name in names if (location := _real_location(name))}


def _real_location(name: str) -> str:
    """Return the location of a module; empty where there is none, or only simkit's."""
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


def _find_spec(finders: Sequence[Any], name: str, path: Sequence[str] | None) -> ModuleSpec | None:
    for finder in finders:
        find = getattr(finder, "find_spec", None)
        spec: ModuleSpec | None = find(name, path, None) if find is not None else None
        if spec is not None:
            return spec
    return None

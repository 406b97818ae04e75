"""Base classes of plugins that simulate what is not a plugin: entities of a world, and systems of other simulators.

A pack brings the derived classes. They are found by the names of their entities or hooks, as other plugins are found by
their names in files.
"""

from __future__ import annotations

import abc
import functools
import inspect
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from simkit.diagnostics import Diagnostics
from simkit.packs import is_shipped_file, left_out_names, missing_pack_text
from simkit.plugins.base import Plugin, WorldPlugin
from simkit.plugins.plugin_names import ENTRY_POINT_GROUP
from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.scene import SceneWorld

FileFinder = Callable[[str, Path | None], Path | None]
"""Function that returns the file for a URI and the folder of the file that names it; None if there is none."""

ENTITIES: Final = ("actors",)
"""Attributes of `SceneWorld` with entities that only an `EntityPlugin` simulates."""


class EntityPlugin(WorldPlugin):
    """Plugin that simulates all entities of one kind; each world with such entities has an instance.

    Attributes:
        entities: names in `ENTITIES` that select this class.
    """

    entities: ClassVar[tuple[str, ...]] = ()

    @classmethod
    @abc.abstractmethod
    def with_models(cls, world: SceneWorld, find_file: FileFinder, diagnostics: Diagnostics) -> SceneWorld:
        """Return the world with one more model for each entity; problems with an entity are reported."""


class SystemPlugin(Plugin):
    """Plugin that runs a system: an object or a module with hooks of another simulator, which needs no base class.

    Args:
        system: object or module with some of the hooks; None if a subclass finds it.

    Attributes:
        simulator: name of the other simulator, for messages.
        hooks: names of the hooks. An object with one of them is a system.
        factories: names of functions of a module that return a system.
        wrapped_system: class or module that a file names; None for other systems.
    """

    parent_kind = "any"
    simulator: ClassVar[str]
    hooks: ClassVar[tuple[str, ...]] = ()
    factories: ClassVar[tuple[str, ...]] = ()
    wrapped_system: ClassVar[object] = None

    def __init__(self, system: object = None) -> None:
        super().__init__()
        self._initial_system = system

    @classmethod
    def system_of(cls, candidate: object) -> object:
        """Return the system: a new instance of a class, the object itself, or what its factory returns."""
        if inspect.isclass(candidate):
            return candidate()
        if _has_any(candidate, cls.hooks):
            return candidate
        return next(getattr(candidate, name)() for name in cls.factories if _has_any(candidate, (name,)))


@functools.cache
def _entity_kinds() -> Kinds[EntityPlugin]:
    def names(cls: type[EntityPlugin]) -> tuple[str, ...]:
        return cls.entities

    return Kinds("simkit.plugins", ENTRY_POINT_GROUP, EntityPlugin, names, ("entities",))  # type: ignore[type-abstract]


@functools.cache
def _system_kinds() -> Kinds[SystemPlugin]:
    def names(cls: type[SystemPlugin]) -> tuple[str, ...]:  # a derived class finds its system by itself
        return (*vars(cls).get("hooks", ()), *vars(cls).get("factories", ()))

    attributes = ("hooks", "factories")
    return Kinds("simkit.plugins", "simkit.systems", SystemPlugin, names, attributes)  # type: ignore[type-abstract]


def entity_plugins(world: SceneWorld) -> Iterator[type[EntityPlugin]]:
    """Yield the classes that simulate the entities of a world."""
    for name in ENTITIES:
        if getattr(world, name) and name in _entity_kinds():
            yield _entity_kinds()[name]


def with_entity_models(world: SceneWorld, find_file: FileFinder, diagnostics: Diagnostics) -> SceneWorld:
    """Return the world with the models of its entities; entities that no plugin simulates are reported."""
    for name in ENTITIES:
        if getattr(world, name) and name not in _entity_kinds():
            pack = left_out_names("entities").get(name)
            need, advice = missing_pack_text(pack) if pack else ("needs a plugin, which is not installed", "")
            text = f"the simulation of {name} {need}; the {name} of world {world.name!r} are ignored"
            diagnostics.warning("SK-PLUGIN-001", text, getattr(world, name)[0].where, advice)
    for cls in entity_plugins(world):
        world = cls.with_models(world, find_file, diagnostics)
    return world


def system_plugin_for(candidate: object) -> type[SystemPlugin] | None:
    """Return the class that runs a class, an object or a module as a system; None if it has no hooks of a system."""
    if isinstance(candidate, Plugin) or (inspect.isclass(candidate) and issubclass(candidate, Plugin)):
        return None
    return next((_system_kinds()[name] for name in _system_kinds().written if _has_any(candidate, (name,))), None)


def has_hooks(candidate: object) -> bool:
    """Check whether a class, an object or a module is a system."""
    return system_plugin_for(candidate) is not None


def makes_systems(module: object) -> bool:
    """Check whether a module has a function that returns a system."""
    cls = system_plugin_for(module)
    return cls is not None and _has_any(module, cls.factories)


def describe_allowed_plugins() -> str:
    """Return a description, for messages, of the objects that can be plugins."""
    classes = dict.fromkeys(_system_kinds()[name] for name in _system_kinds().written)
    systems = [f", or one with hooks of {cls.simulator} ({', '.join(cls.hooks)})" for cls in classes]
    return "a class derived from simkit's Plugin with a load method" + "".join(systems)


def missing_system_pack(candidates: Iterable[object]) -> str:
    """Return advice if one of these objects has hooks of a pack that is not installed; else an empty text."""
    packs = left_out_names("hooks", "factories")
    for candidate in candidates:
        for name, pack in packs.items():
            if _has_any(candidate, (name,)):
                return f"{name} {': '.join(missing_pack_text(pack))}"
    return ""


def user_code_line(error: BaseException) -> str:
    """Return the line of the user's code that raised an exception, as ` at file:line`; empty without one."""
    if isinstance(error, SyntaxError):
        return ""  # its text has the line
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if not is_shipped_file(frame.filename)]
    return f" at {frames[-1].filename}:{frames[-1].lineno}" if frames else ""


def _has_any(candidate: object, names: Iterable[str]) -> bool:
    return any(callable(getattr(candidate, name, None)) for name in names)

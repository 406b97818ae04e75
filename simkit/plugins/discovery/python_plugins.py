"""Plugins created in Python for `simkit.load(world, plugins=[…])`, and the entities that they are attached to.

A class, an object or a module with the hooks of gz-sim is also accepted as a plugin; it needs no base class.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.plugins.base import Plugin
from simkit.plugins.plugin_names import GZ_HOOKS
from simkit.scene import SceneModel, SceneSensor, SceneVisual, SceneWorld

if TYPE_CHECKING:
    from simkit.plugins.gz.gz_system_plugin import GzSystem
    from simkit.runtime import Simulation

SceneEntity = SceneWorld | SceneModel | SceneSensor | SceneVisual
"""Entity of a scene that a plugin may be attached to."""

ParentGetter = Callable[["Simulation"], object]
"""Function that returns the handle of a plugin's parent in a simulation."""


@dataclass(frozen=True)
class Attachment:
    """Plugin with the entity that it is attached to.

    Attributes:
        plugin: plugin instance.
        top: name of the top-level model that contains the entity; empty for the world.
        scoped: scoped name of the entity; empty for the world.
        scene: scene object of the entity.
        parent: function that returns the entity's handle in a simulation.
    """

    plugin: Plugin
    top: str
    scoped: str
    scene: SceneEntity
    parent: ParentGetter


def attach_plugins(plugins: Iterable[object], world: SceneWorld, diagnostics: Diagnostics) -> list[Attachment]:
    """Attach each plugin to an entity.

    A pair such as `("robot", MyPlugin())` names the entity. Without a name, a world plugin is attached to the world.
    Any other plugin is attached to the only possible entity; several possible entities are an error.

    Args:
        plugins: plugins, or pairs of a scoped name and a plugin.
        world: world with its entities.
        diagnostics: collector of errors; a plugin with an error is skipped.
    """
    found = []
    for item in plugins:
        name, candidate = item if isinstance(item, tuple) and len(item) == 2 else ("", item)
        plugin = as_plugin(candidate, diagnostics)
        attachment = None if plugin is None else _attach_plugin(plugin, str(name), world, diagnostics)
        if attachment is not None:
            found.append(attachment)
    return found


def _attach_plugin(plugin: Plugin, name: str, world: SceneWorld, diagnostics: Diagnostics) -> Attachment | None:
    kinds = (plugin.parent_kind,) if isinstance(plugin.parent_kind, str) else plugin.parent_kind
    may_be_world = "world" in kinds or "any" in kinds
    if may_be_world and name in ("", world.name):
        return Attachment(plugin, "", "", world, lambda sim: sim)
    candidates: dict[str, Attachment] = {}
    for kind in kinds:
        candidates.update(_candidates_of_kind(kind, plugin, world))
    shown = type(plugin).__name__
    allowed = " or a ".join(kind for kind in kinds if kind != "any") or "model, visual or sensor"
    listed = ", ".join(map(repr, list(candidates)[:12])) or "none"
    if name:
        if name not in candidates:
            message = (
                f"plugin {shown!r} cannot be attached to {name!r}, which is not a {allowed}; possible names: {listed}"
            )
            diagnostics.error("SK-PLUGIN-021", message, hint=did_you_mean(name, candidates))
        return candidates.get(name)
    moving = [a for a in candidates.values() if not getattr(a.scene, "static", False)]
    fitting = [a for a in moving if not isinstance(a.scene, SceneModel) or "::" not in a.scoped]
    if len(fitting) == 1:
        return fitting[0]
    message = f"plugin {shown!r} needs the name of one {allowed}; possible names: {listed}"
    diagnostics.error("SK-PLUGIN-021", message, hint=f'name the entity: plugins=[("name", {shown}(...))]')
    return None


def _candidates_of_kind(kind: str, plugin: Plugin, world: SceneWorld) -> Mapping[str, Attachment]:
    """Return an attachment of the plugin to each entity of a kind, by scoped name."""
    found: dict[str, Attachment] = {}
    entities: Iterable[SceneEntity]
    for top in world.models:
        visuals = [visual for link in top.all_links() for visual in link.visuals]
        for own, entities in (("model", top.all_models()), ("sensor", top.all_sensors()), ("visual", visuals)):
            if kind in (own, "any"):
                for entity in entities:
                    getter = handle_getter(own, entity.scoped)
                    found[entity.scoped] = Attachment(plugin, top.name, entity.scoped, entity, getter)
    return found


def handle_getter(kind: str, scoped: str) -> ParentGetter:
    """Return the function that finds the handle of a model, a visual or a sensor in a simulation."""
    return lambda sim: getattr(sim, kind)(scoped)


def as_plugin(candidate: object, diagnostics: Diagnostics, where: Where = NOWHERE) -> Plugin | None:
    """Return the plugin for a user's object; None if it cannot be a plugin, after an error with the allowed objects."""
    if isinstance(candidate, Plugin):
        return candidate
    if inspect.isclass(candidate) and issubclass(candidate, Plugin) and not inspect.isabstract(candidate):
        return candidate()
    if not has_hooks(candidate):
        diagnostics.error("SK-PLUGIN-022", f"found {candidate!r}; expected {describe_allowed_plugins()}", where)
        return None
    from simkit.plugins.gz.gz_system_plugin import GzSystem  # 12 ms: gz's modules, which few worlds use

    plugin = GzSystem(system_of(candidate))
    plugin.name = _plugin_name(candidate)
    return plugin


def as_class(found: object) -> type[Plugin] | None:
    """Return the plugin class for a class or module; None if it cannot be a plugin.

    A class derived from `Plugin` is returned itself. A class or module with gz's hooks is wrapped in a new class.
    """
    if inspect.isclass(found) and issubclass(found, Plugin):
        return None if inspect.isabstract(found) else found
    if not (isinstance(found, ModuleType) or inspect.isclass(found)) or not has_hooks(found):
        return None
    from simkit.plugins.gz.gz_system_plugin import GzSystem  # as above

    def find_system(_self: GzSystem) -> object:
        return system_of(found)

    names = {"find_system": find_system, "wrapped_system": found, "__doc__": found.__doc__}
    return type(_plugin_name(found), (GzSystem,), {**names, "__module__": getattr(found, "__module__", found.__name__)})


def has_hooks(candidate: object) -> bool:
    """Check whether a class, an object or a module has a hook of gz, or the function `get_system`."""
    if isinstance(candidate, Plugin) or (inspect.isclass(candidate) and issubclass(candidate, Plugin)):
        return False
    return any(callable(getattr(candidate, name, None)) for name in (*GZ_HOOKS, "get_system"))


def system_of(candidate: Any) -> object:
    """Return the object with gz's hooks: a new instance of a class, the object itself, or what `get_system` returns."""
    if inspect.isclass(candidate):
        return candidate()
    has_own = any(callable(getattr(candidate, name, None)) for name in GZ_HOOKS)
    return candidate if has_own else candidate.get_system()


def describe_allowed_plugins() -> str:
    """Return a description, for messages, of the objects that can be plugins."""
    return f"a class derived from simkit's Plugin with a load method, or one with hooks of gz ({', '.join(GZ_HOOKS)})"


def _plugin_name(candidate: object) -> str:
    if isinstance(candidate, ModuleType):
        return candidate.__name__.rpartition("/")[2].removesuffix(".py").rpartition(".")[2]
    return str(candidate.__name__ if inspect.isclass(candidate) else type(candidate).__name__)

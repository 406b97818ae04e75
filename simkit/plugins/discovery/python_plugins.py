"""Plugins created in Python for `simkit.load(world, plugins=[…])`, and the entities that they are attached to.

A class, an object or a module with the hooks of another simulator is also accepted as a plugin, without a base class.
"""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.plugins.adapters import describe_allowed_plugins, missing_system_pack, system_plugin_for
from simkit.plugins.base import Plugin
from simkit.scene import SceneModel, SceneSensor, SceneVisual, SceneWorld

if TYPE_CHECKING:
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
    attachments = []
    for item in plugins:
        name, candidate = item if isinstance(item, tuple) and len(item) == 2 else ("", item)
        plugin = as_plugin(candidate, diagnostics)
        attachment = None if plugin is None else _attach_plugin(plugin, str(name), world, diagnostics)
        if attachment is not None:
            attachments.append(attachment)
    return attachments


def copied_plugins(plugins: Iterable[object]) -> tuple[object, ...]:
    """Return copies of plugins, so that several simulations can be loaded from one list.

    A copy has copies of the attributes that `__init__` has set; an attribute that cannot be copied, such as a lock, is
    shared. A plugin that a simulation has already loaded is not copied: its attributes belong to that simulation.

    Args:
        plugins: plugins, or pairs of a scoped name and a plugin.
    """
    return tuple(
        (item[0], _copied_plugin(item[1])) if isinstance(item, tuple) and len(item) == 2 else _copied_plugin(item)
        for item in plugins
    )


def _copied_plugin(plugin: object) -> object:
    if not isinstance(plugin, Plugin):
        return copy.deepcopy(plugin)
    if "sim" in vars(plugin):
        return plugin
    copied = object.__new__(type(plugin))
    memo: dict[int, object] = {id(plugin): copied}  # bound methods and references to itself become those of the copy
    for name, value in vars(plugin).items():
        try:
            vars(copied)[name] = copy.deepcopy(value, memo)
        except Exception:  # noqa: BLE001 - a foreign object may raise anything when copied
            vars(copied)[name] = value
    return copied


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
    candidates: dict[str, Attachment] = {}
    entities: Iterable[SceneEntity]
    for top in world.models:
        visuals = [visual for link in top.all_links() for visual in link.visuals]
        for entity_kind, entities in (("model", top.all_models()), ("sensor", top.all_sensors()), ("visual", visuals)):
            if kind in (entity_kind, "any"):
                for entity in entities:
                    getter = handle_getter(entity_kind, entity.scoped)
                    candidates[entity.scoped] = Attachment(plugin, top.name, entity.scoped, entity, getter)
    return candidates


def handle_getter(kind: str, scoped: str) -> ParentGetter:
    """Return the function that finds the handle of a model, a visual or a sensor in a simulation."""
    return lambda sim: getattr(sim, kind)(scoped)


def as_plugin(candidate: object, diagnostics: Diagnostics, where: Where = NOWHERE) -> Plugin | None:
    """Return the plugin for a user's object; None if it cannot be a plugin, after an error with the allowed objects."""
    if isinstance(candidate, Plugin):
        return candidate
    if inspect.isclass(candidate) and issubclass(candidate, Plugin) and not inspect.isabstract(candidate):
        return candidate()
    cls = system_plugin_for(candidate)
    if cls is None:
        message = f"found {candidate!r}; expected {describe_allowed_plugins()}"
        diagnostics.error("SK-PLUGIN-022", message, where, missing_system_pack([candidate]))
        return None
    plugin = cls(cls.system_of(candidate))
    plugin.name = _plugin_name(candidate)
    return plugin


def as_class(candidate: object) -> type[Plugin] | None:
    """Return the plugin class for a class or module; None if it cannot be a plugin.

    A class derived from `Plugin` is returned itself. A class or module that is a system is wrapped in a new class.
    """
    if inspect.isclass(candidate) and issubclass(candidate, Plugin):
        return None if inspect.isabstract(candidate) else candidate
    if not (isinstance(candidate, ModuleType) or inspect.isclass(candidate)):
        return None
    system_class = system_plugin_for(candidate)
    if system_class is None:
        return None
    names = {
        "wrapped_system": candidate,
        "__doc__": candidate.__doc__,
        "__module__": getattr(candidate, "__module__", candidate.__name__),
    }
    return type(_plugin_name(candidate), (system_class,), names)


def _plugin_name(candidate: object) -> str:
    if isinstance(candidate, ModuleType):
        return candidate.__name__.rpartition("/")[2].removesuffix(".py").rpartition(".")[2]
    return str(candidate.__name__ if inspect.isclass(candidate) else type(candidate).__name__)

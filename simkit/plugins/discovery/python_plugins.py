"""Attach plugins made in Python, `simkit.load(world, plugins=[…])`, to the world, a model, a visual or a sensor.

A class, an object or a module with the hooks of gz-sim is a plugin as well, without the base class `Plugin`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.plugins.base import Plugin
from simkit.plugins.gz.gz_system_plugin import HOOKS, GzSystem
from simkit.scene import SceneModel, SceneSensor, SceneVisual, SceneWorld

if TYPE_CHECKING:
    from simkit.runtime import Simulation

SceneEntity = SceneWorld | SceneModel | SceneSensor | SceneVisual
"""What a plugin may hang on, as a file has it."""

ParentGetter = Callable[["Simulation"], object]
"""Gives the handle of what a plugin hangs on."""


@dataclass(frozen=True)
class Attachment:
    """A plugin and what it hangs on.

    Attributes:
        plugin: the instance.
        top: name of the top-level model that it is part of; empty for the world.
        scoped: scoped name of what it hangs on; empty for the world.
        scene: the resolved entity.
        parent: gives the handle, once there is a simulation.
    """

    plugin: Plugin
    top: str
    scoped: str
    scene: SceneEntity
    parent: ParentGetter


def attach_plugins(made: Iterable[object], world: SceneWorld, diagnostics: Diagnostics) -> list[Attachment]:
    """What each plugin hangs on: what it was handed over with, `("robot", MyPlugin())`, else the world, else the only.

    Args:
        made: plugins, or pairs of a scoped name and a plugin.
        world: what there is.
        diagnostics: gets errors; who has one is left out.
    """
    found = []
    for item in made:
        name, one = item if isinstance(item, tuple) and len(item) == 2 else ("", item)
        plugin = as_plugin(one, diagnostics)
        hung = None if plugin is None else _attach_plugin(plugin, str(name), world, diagnostics)
        if hung is not None:
            found.append(hung)
    return found


def _attach_plugin(plugin: Plugin, name: str, world: SceneWorld, diagnostics: Diagnostics) -> Attachment | None:
    kinds = (plugin.parent_kind,) if isinstance(plugin.parent_kind, str) else plugin.parent_kind
    may_be_world = "world" in kinds or "any" in kinds
    if may_be_world and name in ("", world.name):
        return Attachment(plugin, "", "", world, lambda sim: sim)
    there = {scoped: hung for kind in kinds for scoped, hung in _candidates_of_kind(kind, plugin, world).items()}
    shown = type(plugin).__name__
    places = " or a ".join(kind for kind in kinds if kind != "any") or "model, visual or sensor"
    listed = ", ".join(map(repr, list(there)[:12])) or "none"
    if name:
        if name not in there:
            message = f"plugin {shown!r} is to hang on {name!r}, which is no {places}; there is {listed}"
            diagnostics.error("SK-PLUGIN-021", message, hint=did_you_mean(name, there))
        return there.get(name)
    moving = [hung for hung in there.values() if not getattr(hung.scene, "static", False)]
    fitting = [hung for hung in moving if not isinstance(hung.scene, SceneModel) or "::" not in hung.scoped]
    if len(fitting) == 1:
        return fitting[0]
    message = f"plugin {shown!r} belongs on a {places}, and there is not exactly one to hang it on: {listed}"
    diagnostics.error("SK-PLUGIN-021", message, hint=f'say which: plugins=[("name", {shown}(...))]')
    return None


def _candidates_of_kind(kind: str, plugin: Plugin, world: SceneWorld) -> Mapping[str, Attachment]:
    """Everything of a kind that a plugin might hang on, by scoped name."""
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
    """What gives the handle of a model, a visual or a sensor."""
    return lambda sim: getattr(sim, kind)(scoped)


def as_plugin(made: object, diagnostics: Diagnostics, where: Where = NOWHERE) -> Plugin | None:
    """A plugin of what was handed over; None after an error that says what may be."""
    if isinstance(made, Plugin):
        return made
    if inspect.isclass(made) and issubclass(made, Plugin) and not inspect.isabstract(made):
        return made()
    if not has_hooks(made):
        diagnostics.error("SK-PLUGIN-022", f"found {made!r}, allowed is {describe_allowed_plugins()}", where)
        return None
    plugin = GzSystem(system_of(made))
    plugin.name = _plugin_name(made)
    return plugin


def as_class(found: object) -> type[Plugin] | None:
    """The class of plugins that a class, or a module with gz's hooks, stands for; None where it is no plugin."""
    if inspect.isclass(found) and issubclass(found, Plugin):
        return None if inspect.isabstract(found) else found
    if not (isinstance(found, ModuleType) or inspect.isclass(found)) or not has_hooks(found):
        return None

    def find_system(_self: GzSystem) -> object:
        return system_of(found)

    names = {"find_system": find_system, "stands_for": found, "__doc__": found.__doc__}
    return type(_plugin_name(found), (GzSystem,), {**names, "__module__": getattr(found, "__module__", found.__name__)})


def has_hooks(made: object) -> bool:
    """Whether a class, an object or a module has one of gz's hooks, or the function that gives a system."""
    if isinstance(made, Plugin) or (inspect.isclass(made) and issubclass(made, Plugin)):
        return False
    return any(callable(getattr(made, name, None)) for name in (*HOOKS, "get_system"))


def system_of(made: Any) -> object:
    """The object whose hooks are called: what `get_system` gives, an instance of the class, or the thing itself."""
    if inspect.isclass(made):
        return made()
    has_own = any(callable(getattr(made, name, None)) for name in HOOKS)
    return made if has_own else made.get_system()


def describe_allowed_plugins() -> str:
    """What may be a plugin, in words."""
    return f"a class derived from simkit's Plugin with a load method, or one with hooks of gz ({', '.join(HOOKS)})"


def _plugin_name(made: object) -> str:
    if isinstance(made, ModuleType):
        return made.__name__.rpartition("/")[2].removesuffix(".py").rpartition(".")[2]
    return str(made.__name__ if inspect.isclass(made) else type(made).__name__)

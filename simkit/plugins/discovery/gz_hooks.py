"""Accept a class, an object or a module with the hooks of gz-sim as a plugin, without the base class `Plugin`."""

from __future__ import annotations

import inspect
from types import ModuleType
from typing import Any

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.plugins.base import Plugin
from simkit.plugins.gz.gz_system_plugin import HOOKS, GzSystem


def as_plugin(made: object, diagnostics: Diagnostics, where: Where = NOWHERE) -> Plugin | None:
    """A plugin of what was handed over; None after an error that says what may be."""
    if isinstance(made, Plugin):
        return made
    if inspect.isclass(made) and issubclass(made, Plugin) and not inspect.isabstract(made):
        found: Plugin = made()
        return found
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

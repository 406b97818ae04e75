"""Methods of a plugin that have the name of a hook in other simulators, or a misspelled one."""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Iterator
from typing import Final, Literal

from simkit.diagnostics import closest

StepHook = Literal["before_step", "after_step"]

_STEP_HOOKS: Final[tuple[StepHook, StepHook]] = ("before_step", "after_step")
_MAYBE: Final = re.compile("(?!_)(before|after|.*(step|update))", re.IGNORECASE)  # the closest name takes longer
# Names of Gazebo Sim's systems, Gazebo Classic's event and usual others, in lower case without `_`.
_OTHER_NAMES: Final[dict[str, StepHook]] = {
    "beforestep": "before_step",
    "beforeupdate": "before_step",
    "onupdate": "before_step",
    "prestep": "before_step",
    "preupdate": "before_step",
    "afterstep": "after_step",
    "afterupdate": "after_step",
    "onstep": "after_step",
    "poststep": "after_step",
    "postupdate": "after_step",
}


def uncalled_methods(plugin_class: type) -> Iterator[tuple[str, StepHook]]:
    """Yield each public method that looks like a step hook, if nothing in its module uses it.

    Args:
        plugin_class: class of a plugin; its base classes in simkit are not searched.

    Yields:
        Class and name of the method, such as `Push.pre_step`, and the hook that has its purpose.
    """
    for cls in plugin_class.__mro__:
        if cls.__module__.partition(".")[0] == "simkit":
            return
        for name, method in vars(cls).items():
            hook = _intended_hook(name) if inspect.isfunction(method) else None
            if hook is not None and not _is_used(name, cls.__module__):
                yield f"{cls.__name__}.{name}", hook


def _intended_hook(name: str) -> StepHook | None:
    if name in _STEP_HOOKS or not _MAYBE.match(name):
        return None
    near = closest(name, _STEP_HOOKS, 0.85)
    return _OTHER_NAMES.get(name.replace("_", "").lower()) or next((hook for hook in _STEP_HOOKS if hook == near), None)


def _is_used(name: str, module: str) -> bool:
    """Check whether the module has `.name`, such as a callback of a subscription."""
    try:
        tree = ast.parse(inspect.getsource(sys.modules[module]))
    except (KeyError, OSError, TypeError, SyntaxError):
        return False  # the module has no source
    return any(isinstance(node, ast.Attribute) and node.attr == name for node in ast.walk(tree))

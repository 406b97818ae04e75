"""Module `threading` of a program: Python's own, with a count of questions that do not wait."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import wraps
from types import ModuleType
from typing import TYPE_CHECKING, Any

from simkit_nodes.tasks import current_task

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def counted(function: Callable[..., object]) -> Callable[..., object]:
    """Return a function that counts as a question that does not wait: a loop of such questions gets a step.

    Questions of the module itself, such as those of `Thread.join`, are not counted.
    """
    own_names = function.__globals__

    @wraps(function)
    def ask(*args: object, **kwargs: object) -> Any:
        task = current_task()
        if task is not None and sys._getframe(1).f_globals is not own_names:
            task.poll()
        return function(*args, **kwargs)

    return ask


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Count the questions of a loop that waits for another thread without a pause."""
    for cls, name in ((module.Event, "is_set"), (module.Thread, "is_alive")):
        setattr(cls, name, counted(getattr(cls, name)))
    module.Event.isSet = module.Event.is_set

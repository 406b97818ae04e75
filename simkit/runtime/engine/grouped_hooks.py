"""Hooks of plugins of one kind that are due together, as one task.

A plugin's class may define beside a hook a class method of the hook's name with `_group_hook` after it:

    @classmethod
    def before_step_together(cls, plugins):
        ...                       # once for each schedule: look up what all need
        def run(rota):
            for plugin in rota:   # the same bits, and in the same order, as one after the other
                ...
        return run

Only plugins that follow on each other are taken together, so that hooks keep the order of the document.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from simkit.runtime.engine.scheduler import Task

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import AttachedPlugin
    from simkit.runtime.engine.plugin_faults import PluginFaults

MIN_GROUP_SIZE = 4
"""So few are as soon called one by one."""


class PluginGroup:
    """The plugins of one task; going through them notes whose turn it is, so that who raises can be named.

    Attributes:
        plugins: in the order of the document.
        turn: whose turn it is.
    """

    def __init__(self, plugins: Sequence[AttachedPlugin]) -> None:
        self.plugins, self.turn = list(plugins), plugins[0]

    def __iter__(self) -> Iterator[AttachedPlugin]:
        for plugin in self.plugins:
            self.turn = plugin
            yield plugin


GroupHook = Callable[[Sequence["AttachedPlugin"]], Callable[[PluginGroup], None]]
"""Makes of plugins what calls a hook of all of them."""

HookTasks = Iterator[tuple[float | None, Task]]
"""Rates [Hz] and tasks."""


def hook_tasks(faults: PluginFaults, plugins: Iterable[AttachedPlugin], hook: str) -> HookTasks:
    """The hooks of these plugins with their rates [Hz], in the order of the document.

    Args:
        faults: calls the plugins.
        plugins: those that are at work.
        hook: `before_step` or `after_step`.
    """
    run: list[AttachedPlugin] = []
    for plugin in plugins:
        if not plugin.has_hook(hook):
            continue
        if run and not (_can_group(run[-1], plugin, hook)):
            yield from _group_tasks(faults, run, hook)
            run = []
        run.append(plugin)
    yield from _group_tasks(faults, run, hook)


def _can_group(one: AttachedPlugin, other: AttachedPlugin, hook: str) -> bool:
    return type(one) is type(other) and _hook_rate(one, hook) == _hook_rate(other, hook)


def _hook_rate(plugin: AttachedPlugin, hook: str) -> float | None:
    rate: float | None = getattr(plugin, f"{hook}_rate")
    return rate


def _group_tasks(faults: PluginFaults, run: list[AttachedPlugin], hook: str) -> HookTasks:
    together = _group_hook(type(run[0]), hook) if len(run) >= MIN_GROUP_SIZE else None
    # who may be left out when it raises is called by itself
    if together is None or any(faults.policy(plugin) != "stop" for plugin in run):
        for plugin in run:
            yield _hook_rate(plugin, hook), faults.task(plugin, hook)
    else:
        yield _hook_rate(run[0], hook), _guard_group(faults, PluginGroup(run), hook, together(run))


def _group_hook(kind: type, hook: str) -> GroupHook | None:
    """What a class gives for many of its plugins; None where a class below it has another hook than that is for."""
    for cls in kind.__mro__:
        if f"{hook}_together" in vars(cls):
            found: GroupHook = getattr(kind, f"{hook}_together")
            return found
        if hook in vars(cls):
            return None
    return None


def _guard_group(faults: PluginFaults, rota: PluginGroup, hook: str, run: Callable[[PluginGroup], None]) -> Task:
    def task(_: int = 0) -> None:
        try:
            run(rota)
        except Exception as error:  # noqa: BLE001 - what a plugin calls may raise anything
            faults.meet(rota.turn, hook, error)

    return task

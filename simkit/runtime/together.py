"""Hooks of plugins of one kind that are due together, as one task.

A plugin's class may define beside a hook a class method of the hook's name with `_together` after it:

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
from typing import TYPE_CHECKING, Any

from simkit.runtime.loop import guarded
from simkit.runtime.scheduler import Task

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

LEAST = 4
"""So few are as soon called one by one."""


class Rota:
    """The plugins of one task; going through them notes whose turn it is, so that who raises can be named.

    Attributes:
        plugins: in the order of the document.
        turn: whose turn it is.
    """

    def __init__(self, plugins: Sequence[Any]) -> None:
        self.plugins, self.turn = list(plugins), plugins[0]

    def __iter__(self) -> Iterator[Any]:
        for plugin in self.plugins:
            self.turn = plugin
            yield plugin


def tasks(sim: Simulation, plugins: Iterable[Any], hook: str) -> Iterator[tuple[float | None, Task]]:
    """The hooks of these plugins with their rates [Hz], in the order of the document.

    Args:
        sim: whose plugins.
        plugins: those that are at work.
        hook: `before_step` or `after_step`.
    """
    run: list[Any] = []
    for plugin in plugins:
        if not plugin.has_hook(hook):
            continue
        if run and not (_alike(run[-1], plugin, hook)):
            yield from _of_run(sim, run, hook)
            run = []
        run.append(plugin)
    yield from _of_run(sim, run, hook)


def _alike(one: Any, other: Any, hook: str) -> bool:
    return type(one) is type(other) and _rate(one, hook) == _rate(other, hook)


def _rate(plugin: Any, hook: str) -> float | None:
    rate: float | None = getattr(plugin, f"{hook}_rate")
    return rate


def _of_run(sim: Simulation, run: list[Any], hook: str) -> Iterator[tuple[float | None, Task]]:
    together = _together(type(run[0]), hook) if len(run) >= LEAST else None
    # who may be left out when it raises is called by itself
    if together is None or any(sim.faults.policy(plugin) != "stop" for plugin in run):
        for plugin in run:
            yield _rate(plugin, hook), guarded(sim, plugin, hook)
    else:
        yield _rate(run[0], hook), _guarded(sim, Rota(run), hook, together(run))


def _together(kind: type, hook: str) -> Callable[[Sequence[Any]], Callable[[Rota], None]] | None:
    """What a class gives for many of its plugins; None where a class below it has another hook than that is for."""
    for cls in kind.__mro__:
        if f"{hook}_together" in vars(cls):
            found: Callable[[Sequence[Any]], Callable[[Rota], None]] = getattr(kind, f"{hook}_together")
            return found
        if hook in vars(cls):
            return None
    return None


def _guarded(sim: Simulation, rota: Rota, hook: str, run: Callable[[Rota], None]) -> Task:
    def task(_: int = 0) -> None:
        try:
            run(rota)
        except Exception as error:  # noqa: BLE001 - what a plugin calls may raise anything
            sim.faults.meet(rota.turn, hook, error)

    return task

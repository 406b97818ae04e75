"""Journal of the external inputs of a simulation, for recordings that repeat a run.

External inputs come from the code that steps the simulation and from topic callbacks that belong to no plugin. Inputs
by plugins are not recorded, because the plugins repeat them when the run is repeated.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
OutsideCallback = Callable[[Any], object] | None
ResultStore = Callable[[Any], None]
S = TypeVar("S", bound="Journaled")


class Journal(Protocol):
    """Recorder of external inputs; `TopicBus.journal` while it is active."""

    def passing(self, operation: str, arguments: Mapping[str, object]) -> AbstractContextManager[Any]:
        """Return the context manager in which an operation runs; it records the operation if the caller is external.

        Args:
            operation: name of the operation.
            arguments: arguments of the operation.
        """

    def called_back(self, callback: object) -> AbstractContextManager[ResultStore | None]:
        """Return the context manager in which a callback runs.

        If the callback belongs to no plugin, the journal records the calls that the callback makes. The value of the
        context is then the function that records the callback's result.

        Args:
            callback: subscription, or `ScriptCallback`.
        """

    def hears(self, topic: str, subscription: object) -> None:
        """Record a subscription whose callback belongs to no plugin, before the bus adds the subscription."""

    def outside(self, callback: OutsideCallback) -> OutsideCallback:
        """Return a wrapper of a callback, which records the calls that an external callback makes."""

    def before_steps(self) -> None:
        """Record the beginning of a series of steps."""

    def after_steps(self) -> None:
        """Record the end of a series of steps, also after an error."""


class JournalKeeper(Protocol):
    """Object that stores the active journal. The topic bus is such an object.

    Attributes:
        journal: recorder of external inputs; None without one.
    """

    journal: Journal | None


class Journaled(Protocol):
    """Part of a simulation whose external calls are recorded in a journal."""

    @property
    def _bus(self) -> JournalKeeper:
        """Topic bus with the journal."""


def journaled(method: Callable[Concatenate[S, P], R]) -> Callable[Concatenate[S, P], R]:
    """Decorate a method so that a journal records each of its calls."""
    signature = inspect.signature(method)
    name = method.__name__.lstrip("_")

    def call_through(self: S, /, *args: P.args, **kwargs: P.kwargs) -> R:
        journal = self._bus.journal
        if journal is None:
            return method(self, *args, **kwargs)
        bound = signature.bind(self, *args, **kwargs)
        bound.apply_defaults()
        arguments = dict(list(bound.arguments.items())[1:])
        with journal.passing(name, arguments) as report:
            result = method(self, *args, **kwargs)
            if report is not None:
                report(result)
            return result

    functools.update_wrapper(call_through, method)
    return call_through

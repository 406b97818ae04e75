"""The doors of a simulation: what comes in from outside goes through them, and who writes a journal hears of it.

Outside is whoever makes the steps, and whoever is called back by a topic without being a plugin of the world. What
plugins do themselves comes again when the run is repeated, and is not told.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
OutsideCallback = Callable[[Any], Any] | None
S = TypeVar("S", bound="Journaled")


class Journal(Protocol):
    """Hears of all that comes in; it is `TopicBus.journal` while it does."""

    def passing(self, door: str, words: Mapping[str, object]) -> AbstractContextManager[Any]:
        """A context manager around what is done by somebody who may be outside; `words` are the arguments."""

    def called_back(self, subscription: object) -> AbstractContextManager[None]:
        """A context manager around a callback that is no plugin's."""

    def hears(self, topic: str, subscription: object) -> None:
        """Told before somebody subscribes with a callback that is no plugin's."""

    def outside(self, callback: OutsideCallback) -> OutsideCallback:
        """A callback that somebody hands over who may be outside, to be called instead of it."""

    def before_steps(self) -> None:
        """Told before steps are made."""

    def after_steps(self) -> None:
        """Told after them, also where they ended in an error."""


class JournalKeeper(Protocol):
    """Knows who writes a journal: the topic bus.

    Attributes:
        journal: hears of what comes in from outside; None where nobody does.
    """

    journal: Journal | None


class Journaled(Protocol):
    """Part of a simulation whose calls from outside go into a journal."""

    @property
    def _bus(self) -> JournalKeeper:
        """Knows the journal."""


def journaled(method: Callable[Concatenate[S, P], R]) -> Callable[Concatenate[S, P], R]:
    """Has a journal hear of each call of a method."""
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

"""What a controller has opened to the outside: topics, services, actions.

They stay with the controller's name: one that is unloaded and loaded again, or configured again, finds them open, and
what comes in meanwhile finds nobody.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Key = tuple[str, str]
Relay = Callable[..., Any]
T = TypeVar("T")


class Ends:
    """The ends of one controller name.

    Attributes:
        handlers: who answers now, by what kind of end it is and its name.
    """

    def __init__(self) -> None:
        self._handles: dict[Key, Any] = {}
        self.handlers: dict[Key, Callable[..., Any]] = {}

    def open(self, key: Key, make: Callable[[], T]) -> T:
        """The end of that name, made where there is none yet."""
        if key not in self._handles:
            self._handles[key] = make()
        found: T = self._handles[key]
        return found

    def relay(self, key: Key, handler: Callable[..., Any], absent: Callable[..., Any] = lambda *_: None) -> Relay:
        """A call to whoever answers at that end when it comes: from now on `handler`; else `absent`."""
        self.handlers[key] = handler
        return lambda *values: self.handlers.get(key, absent)(*values)

    def close(self) -> None:
        """Leaves nobody to answer."""
        self.handlers = {}

    def __deepcopy__(self, memo: dict[int, Any]) -> Ends:
        return self

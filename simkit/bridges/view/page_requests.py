"""Requests of the pages. Each one acts between two steps, like a call of the same service by a script."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Protocol

if TYPE_CHECKING:
    from simkit.bridges.view.page_server import PageRequest
    from simkit.bridges.view.travel import Travel
    from simkit.runtime import Simulation


class ViewHost(Protocol):
    """Protocol of the live view that executes requests.

    Attributes:
        travel: paths that the models have driven.
    """

    sim: Simulation
    travel: Travel


class RequestFailed(Exception):
    """Error for a request that cannot be executed; the message has the reason."""


class Call:
    """Request with its arguments, each of which is validated when it is read.

    Attributes:
        view: live view with the simulation.
        client: page that has sent the request.
    """

    def __init__(self, view: ViewHost, request: PageRequest) -> None:
        self.view, self.sim, self.client = view, view.sim, request.client
        self._arguments = request.content

    def text(self, name: str) -> str:
        """Return an argument that is a text."""
        value = self._arguments.get(name)
        if not isinstance(value, str):
            raise RequestFailed(f"{name!r} must be a text, got {value!r:.80}")
        return value

    def number(self, name: str, default: float | None = None) -> float:
        """Return an argument that is a finite number."""
        value = self._arguments.get(name, default)
        if type(value) not in (int, float) or not math.isfinite(value):
            raise RequestFailed(f"{name!r} must be a finite number, got {value!r:.80}")
        return float(value)

    def flag(self, name: str) -> bool:
        """Return an argument that is true or false."""
        value = self._arguments.get(name)
        if not isinstance(value, bool):
            raise RequestFailed(f"{name!r} must be true or false, got {value!r:.80}")
        return value

    def value(self, name: str) -> Any:
        """Return an argument of any kind; None if it is missing."""
        return self._arguments.get(name)


def execute_request(view: ViewHost, request: PageRequest) -> object:
    """Execute a request and return its answer.

    Raises:
        RequestFailed: the request is unknown, or an argument is invalid.
    """
    name = request.content["do"]
    if name not in REQUESTS:
        raise RequestFailed(f"unknown request {name!r:.80}; known: {', '.join(REQUESTS)}")
    return REQUESTS[name](Call(view, request))


def _pause(call: Call) -> None:
    call.sim.paused = call.flag("value")


def _step(call: Call) -> None:
    count = call.number("count", 1)
    if not (count.is_integer() and 1 <= count <= 1 << 31):
        raise RequestFailed(f"'count' must be a whole number of steps of at least 1, got {count:g}")
    call.sim.control.pausing.step(int(count))


def _pace(call: Call) -> None:
    value = call.value("value")
    pace = None if value is None else call.number("value")
    if pace is not None and not pace > 0:
        raise RequestFailed(f"'value' must be above 0, or null for no limit, got {value!r:.80}")
    call.sim.control.pausing.pace = pace


def _reset(call: Call) -> None:
    call.sim.reset()


def _travel(call: Call) -> object:
    paths = call.view.travel.paths.items()
    return {name: [[round(float(x), 4) for x in point] for point in path] for name, path in paths}


REQUESTS: Final[dict[str, Callable[[Call], object]]] = {
    "left": lambda _: None,
    "pause": _pause,
    "step": _step,
    "pace": _pace,
    "reset": _reset,
    "travel": _travel,
}
"""Function of each request, by the name in `do`."""

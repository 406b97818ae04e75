"""Request of a page with its arguments."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit.bridges.view.driving import Driving
    from simkit.bridges.view.page_calls import PageCalls
    from simkit.bridges.view.page_server import PageRequest
    from simkit.bridges.view.streams import Stream
    from simkit.recording.travel import Travel
    from simkit.runtime import Simulation


def _is_finite(value: object) -> bool:
    """Check whether a value of a request is a finite number; JSON may have integers that no float can hold."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


class ViewHost(Protocol):
    """Protocol of the live view that executes requests.

    Attributes:
        travel: paths that the models have driven.
        driving: robots that the pages drive.
        calls: calls of services and goals of actions that pages have sent.
        is_held: True after a page has requested a pause, until a page resumes.
    """

    sim: Simulation
    travel: Travel
    driving: Driving
    calls: PageCalls
    is_held: bool

    def stream(self, name: str) -> Stream | None:
        """Return an open stream; None if no page shows it."""
        ...


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
        value: Any = self._arguments.get(name, default)
        if not _is_finite(value):
            raise RequestFailed(f"{name!r} must be a finite number, got {value!r:.80}")
        return float(value)

    def numbers(self, name: str, count: int) -> list[float]:
        """Return an argument that is a list of finite numbers."""
        values: Any = self._arguments.get(name)
        is_valid = isinstance(values, list) and len(values) == count
        if not is_valid or not all(map(_is_finite, values)):
            raise RequestFailed(f"{name!r} must be a list of {count} finite numbers, got {values!r:.80}")
        return [float(v) for v in values]

    def flag(self, name: str) -> bool:
        """Return an argument that is true or false."""
        value = self._arguments.get(name)
        if not isinstance(value, bool):
            raise RequestFailed(f"{name!r} must be true or false, got {value!r:.80}")
        return value

    def value(self, name: str) -> Any:
        """Return an argument of any kind; None if it is missing."""
        return self._arguments.get(name)

"""Request of a page with its arguments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from simkit.bridges.live.request_fields import RequestRefused, checked_value, read_field

if TYPE_CHECKING:
    from simkit.bridges.view.driving import Driving
    from simkit.bridges.view.page_calls import PageCalls
    from simkit.bridges.view.page_server import PageRequest
    from simkit.bridges.view.streams import Stream
    from simkit.recording.travel import Travel
    from simkit.runtime import Simulation


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
        return read_field(self._arguments, name, str)

    def number(self, name: str, default: float | None = None) -> float:
        """Return an argument that is a finite number."""
        if default is None:
            return read_field(self._arguments, name, float)
        return checked_value(self._arguments.get(name, default), f"{name!r}", float)

    def numbers(self, name: str, count: int) -> list[float]:
        """Return an argument that is a list of finite numbers."""
        values = read_field(self._arguments, name, list)
        if len(values) != count:
            raise RequestRefused(f"{name!r} must be a list of {count} finite numbers, got {len(values)}")
        return [checked_value(value, f"{name}[{number}]", float) for number, value in enumerate(values)]

    def flag(self, name: str) -> bool:
        """Return an argument that is true or false."""
        return read_field(self._arguments, name, bool)

    def value(self, name: str) -> Any:
        """Return an argument of any kind; None if it is missing."""
        return self._arguments.get(name)

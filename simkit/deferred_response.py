"""Response of a service that is given in a later step than that of the request."""

from __future__ import annotations

from collections.abc import Callable

from simkit.in_process import InProcess
from simkit.msgs import Message


class DeferredResponse(InProcess):
    """Response that a service gives later. The handler of the service returns it instead of a response.

    `respond` or `fail` may be called at any time, also before the handler returns. Only the first call counts. None
    counts if the service was closed, or if a reset or restore has undone the request.
    """

    __slots__ = ("_early", "_finish")

    def __init__(self) -> None:
        self._finish: Callable[[Message, str], None] | None = None
        self._early: tuple[Message, str] | None = None

    def respond(self, response: Message = None) -> None:
        """Give the response: a message, a dict of its fields, or None for a message whose fields are all zero.

        Raises:
            MessageError: the response does not fit the type of the service.
        """
        self._end(response, "")

    def fail(self, reason: str) -> None:
        """Give the caller an error instead of a response."""
        self._end(None, reason or "the service gave no response")

    def _end(self, response: Message, error: str) -> None:
        if self._finish is not None:
            self._finish(response, error)
        elif self._early is None:
            self._early = response, error

    def connect(self, finish: Callable[[Message, str], None]) -> None:
        """Set the function that receives the response or the text of an error."""
        self._finish = finish
        if self._early is not None:
            finish(*self._early)

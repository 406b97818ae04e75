"""What can go wrong between a running simulation and those who talk to it."""

from __future__ import annotations

from simkit.errors import InputError


class LiveError(InputError):
    """No simulation answers, or it answered that it cannot do what was asked.

    Attributes:
        code: of the other side's error where it is one of theirs (`SK-SERVICE-001`), else one of `SK-LIVE-001` to 009.
    """

    def __init__(self, message: str, code: str) -> None:
        super().__init__(message if code in message else f"{code} {message}", code)


class LiveClosed(LiveError):
    """The simulation has ended, or has closed the connection; says why where that is known."""

    def __init__(self, message: str, code: str = "SK-LIVE-005") -> None:
        super().__init__(message, code)


class BadFrame(Exception):
    """What came from the other side is no frame of the protocol."""

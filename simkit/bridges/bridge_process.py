"""Process of a bridge or server that is a client of the simulation: its start, its notes and its end."""

from __future__ import annotations

import json
import queue
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import IO, Any, Final, NamedTuple, Self

from simkit.errors import InputError
from simkit.number_text import counted
from simkit.process_control import kill_process_tree
from simkit.run_spec import JsonObject

_START_TIMEOUT: Final = 60.0  # [s]; the first import of rclpy on a slow disk takes several seconds
_END_TIMEOUT: Final = 5.0  # [s] for passing on the last messages
_LAST_LINES_TIMEOUT: Final = 0.5  # [s] for the lines of a process that has ended
_NOTE_PERIOD: Final = 10.0  # [s] of wall time
_MOST_NOTES: Final = 20  # in a period
_POLL: Final = 0.02  # [s] between two looks at a bridge that starts


class BridgeCodes(NamedTuple):
    """Diagnostic codes of a kind of bridge.

    Attributes:
        cannot_start: error of a bridge that cannot start.
        ended: warning about a bridge that has ended during a run.
        note: note about something that the bridge leaves out.
    """

    cannot_start: str
    ended: str
    note: str


class BridgeProcess:
    """Bridge process; a context manager that waits for the end of the process.

    Args:
        title: name of the bridge in messages, such as `bridge to ROS 2`.
        codes: diagnostic codes of the bridge.
        program: module of simkit or of a pack with the function `main`, which receives the settings in the process.
            The Python of the process need not have its package installed.
        settings: settings of the program, as JSON.
        report: callback for a line to the user.
        python: Python of the process; None for the Python of this process.
        environment: environment variables of the process; None for those of this process.
    """

    def __init__(
        self,
        title: str,
        codes: BridgeCodes,
        program: str,
        settings: Mapping[str, object],
        report: Callable[[str], None],
        python: Path | None = None,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self._title, self._codes, self._program, self._settings = title, codes, program, settings
        self._report, self._python, self._environment = report, python, environment
        self._process: subprocess.Popen[bytes] | None = None
        self._readers: list[threading.Thread] = []
        self._lines: queue.SimpleQueue[JsonObject] = queue.SimpleQueue()
        self._errors: deque[str] = deque(maxlen=20)
        self._last: JsonObject = {}
        self._is_over = False
        self._period_start: float | None = None
        self._note_count = 0

    def start(
        self,
        socket: Path,
        serve: Callable[[float], object] = time.sleep,
        is_interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """Start the process and wait until everything is open.

        Args:
            socket: path of the simulation's socket.
            serve: function that serves the simulation's clients for some wall time [s].
            is_interrupted: function that returns True to wait no longer.

        Raises:
            InputError: the bridge cannot start; the message has the reason.
        """
        python, settings = self._python or sys.executable, {"socket": str(socket), **self._settings}
        package = import_module(self._program.partition(".")[0])
        folder = Path(str(package.__file__)).resolve().parent
        try:
            self._process = process = subprocess.Popen(
                [str(python), "-P", str(Path(__file__).parent / "bridge_main.py"), self._program, str(folder)],
                stdin=subprocess.PIPE,  # settings, which may contain a token; the pipe closes when this process ends
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=self._environment,
                start_new_session=True,
            )
        except OSError as error:
            raise self.start_error(f"{python} cannot be started: {error.strerror}") from None
        if process.stdin is not None:
            with suppress(OSError):  # its last words say why it has ended
                process.stdin.write(json.dumps(settings).encode() + b"\n")
                process.stdin.flush()
        for pipe, take in ((process.stdout, self._take_line), (process.stderr, self._errors.append)):
            self._readers.append(threading.Thread(target=_read_lines, args=(pipe, take), daemon=True))
            self._readers[-1].start()
        end = time.monotonic() + _START_TIMEOUT
        while "ready" not in self._last:
            serve(_POLL)
            self._report_notes()
            if is_interrupted():
                return
            if process.poll() is not None:
                self._report_last_notes()
                reason = self._last.get("error") or (
                    self._errors[-1] if self._errors else f"exit code {process.poll()}"
                )
                raise self.start_error(str(reason))
            if time.monotonic() > end:
                raise self.start_error(f"the bridge is not ready after {_START_TIMEOUT:g} s")
        self._report(self._ready_text(self._last["ready"]))

    def _ready_text(self, line: Any) -> str:
        """Return the line for the user about a bridge that is open."""
        raise NotImplementedError

    def _start_help(self, reason: str) -> str:
        """Return the help for a bridge that cannot start; empty if there is none."""
        return ""

    def start_error(self, reason: str) -> InputError:
        """Return the error for a bridge that cannot start."""
        python = f" with {self._python}" if self._python else ""
        text = f"the {self._title} cannot start{python}: {reason}"
        return InputError(self._codes.cannot_start, text, help=self._start_help(reason))

    def check(self) -> None:
        """Report new notes of a bridge whose run continues, and once the end of the process."""
        if not self._is_over and not self._is_alive():
            self._is_over = True
            text = f"the {self._title} has ended ({self._end_reason()}); the simulation continues without it"
            self._report(f"warning {self._codes.ended}: {text}")

    def wait(self, is_interrupted: Callable[[], bool]) -> int:
        """Wait until the process ends or a function returns True.

        Returns:
            Exit code: 0 if the simulation has ended, 1 if the bridge has failed.
        """
        while self._is_alive():
            time.sleep(_POLL)
            if is_interrupted():
                self._end()
                return 0
        if "ended" in self._last:
            self._report(f"note: {self._end_reason()}")
            return 0
        self._report(f"error: {self._codes.ended} the {self._title} has ended ({self._end_reason()})")
        return 1

    def _is_alive(self) -> bool:
        """Report new notes, and check whether the process runs."""
        self._report_notes()
        if self._process is None or self._process.poll() is None:
            return self._process is not None
        self._report_last_notes()
        return False

    def _end_reason(self) -> str:
        reason = self._last.get("ended") or self._last.get("error")
        if reason or self._process is None:
            return str(reason)
        code = self._process.returncode
        return f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"

    def _end(self) -> None:
        """Ask the process to end."""
        if self._process is not None and self._process.stdin is not None:
            with suppress(OSError):  # settings that the process has not read are written again
                self._process.stdin.close()

    def _take_line(self, line: str) -> None:
        try:
            note = json.loads(line)
        except ValueError:
            return
        if isinstance(note, dict):
            self._lines.put(note)

    def _report_notes(self) -> None:
        """Process the lines that have arrived."""
        while not self._lines.empty():
            line = self._lines.get()
            self._last.update(line)
            if "note" in line:
                self._report_note(str(line["note"]))
        self._report_omitted(time.monotonic() - _NOTE_PERIOD)

    def _report_note(self, text: str) -> None:
        """Report a note, or count it after `_MOST_NOTES` in a period: clients may send invalid requests."""
        now = time.monotonic()
        self._report_omitted(now - _NOTE_PERIOD)
        self._period_start = self._period_start or now
        self._note_count += 1
        if self._note_count <= _MOST_NOTES:
            self._report(f"note {self._codes.note}: {text}")

    def _report_omitted(self, latest_start: float) -> None:
        """End a period that began before a time, and report the number of its omitted notes."""
        if self._period_start is None or self._period_start > latest_start:
            return
        if (omitted := self._note_count - _MOST_NOTES) > 0:
            self._report(f"note {self._codes.note}: {counted(omitted, 'more note')} not shown")
        self._period_start, self._note_count = None, 0

    def _report_last_notes(self) -> None:
        """Process all lines of a process that has ended."""
        for reader in self._readers:
            reader.join(_LAST_LINES_TIMEOUT)  # a child of the process may keep its pipes open
        self._report_notes()
        self._report_omitted(time.monotonic())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Wait until the process has passed on the last messages; kill a process that does not end."""
        process, self._is_over = self._process, True
        if process is None:
            return
        with suppress(subprocess.TimeoutExpired):
            process.wait(_END_TIMEOUT)
        self._end()
        kill_process_tree(process)
        process.wait()


def _read_lines(pipe: IO[bytes] | None, take: Callable[[str], None]) -> None:
    """Pass the lines of a pipe to a function until the pipe closes."""
    if pipe is not None:
        with pipe:
            for line in pipe:
                take(line.decode("utf-8", "replace").strip())

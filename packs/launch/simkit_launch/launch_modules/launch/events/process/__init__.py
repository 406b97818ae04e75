"""Events of processes."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from simkit_launch.launch_modules.launch.event import Event

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "ProcessStderr",
    "ProcessStdin",
    "ProcessStdout",
    "ProcessTargetedEvent",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_executable",
    "matches_name",
    "matches_pid",
]


class RunningProcessEvent(Event):
    """Event of a process.

    Args:
        action: action that starts the process.
        name: name of the process.
        cmd: command line.
        cwd: working directory.
        env: variables of the environment.
        pid: number of the process.
    """

    name: ClassVar[str] = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Any,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: Mapping[str, str] | None,
        pid: int,
    ) -> None:
        self._action, self._process_name, self._cmd, self._cwd, self._env, self._pid = action, name, cmd, cwd, env, pid

    @property
    def action(self) -> Any:
        """Action that starts the process."""
        return self._action

    @property
    def execute_process_action(self) -> Any:
        """Action that starts the process."""
        return self._action

    @property
    def process_name(self) -> str:
        """Name of the process."""
        return self._process_name

    @property
    def cmd(self) -> list[str]:
        """Command line."""
        return self._cmd

    @property
    def cwd(self) -> str | None:
        """Working directory."""
        return self._cwd

    @property
    def env(self) -> Mapping[str, str] | None:
        """Variables of the environment."""
        return self._env

    @property
    def pid(self) -> int:
        """Number of the process."""
        return self._pid


class ProcessStarted(RunningProcessEvent):
    """Event that a process has started."""

    name: ClassVar[str] = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """Event that a process has ended.

    Args:
        returncode: exit code.
    """

    name: ClassVar[str] = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._returncode = returncode

    @property
    def returncode(self) -> int:
        """Exit code."""
        return self._returncode


class ProcessIO(RunningProcessEvent):
    """Event that a process has read or written text.

    Args:
        text: text.
        fd: 0, 1 or 2 for the standard input, output or error output.
    """

    name: ClassVar[str] = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._text, self._fd = text, fd

    @property
    def text(self) -> bytes:
        """Text."""
        return self._text

    @property
    def from_stdin(self) -> bool:
        """True for the standard input."""
        return self._fd == 0

    @property
    def from_stdout(self) -> bool:
        """True for the standard output."""
        return self._fd == 1

    @property
    def from_stderr(self) -> bool:
        """True for the error output."""
        return self._fd == 2


class ProcessStdin(ProcessIO):
    """Event that a process has read text."""

    name: ClassVar[str] = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=0, **kwargs)


class ProcessStdout(ProcessIO):
    """Event that a process has written text."""

    name: ClassVar[str] = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)


class ProcessStderr(ProcessIO):
    """Event that a process has written text to the error output."""

    name: ClassVar[str] = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=2, **kwargs)


class ProcessTargetedEvent(Event):
    """Event for processes that a matcher accepts.

    Args:
        process_matcher: function that decides whether the event is for a process.
    """

    name: ClassVar[str] = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self._process_matcher = process_matcher

    @property
    def process_matcher(self) -> Callable[[Any], bool]:
        """Function that decides whether the event is for a process."""
        return self._process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """Event that ends processes."""

    name: ClassVar[str] = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """Event that sends a signal to processes.

    Args:
        signal_number: number or name of the signal.
        process_matcher: function that decides whether the event is for a process.
    """

    name: ClassVar[str] = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: int | str, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self._signal = (
            signal.Signals[signal_number] if isinstance(signal_number, str) else signal.Signals(signal_number)
        )

    @property
    def signal(self) -> signal.Signals:
        """Signal."""
        return self._signal

    @property
    def signal_name(self) -> str:
        """Name of the signal."""
        return self._signal.name


def matches_pid(pid: int) -> Callable[[Any], bool]:
    """Return a function that checks whether a process has a number."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> Callable[[Any], bool]:
    """Return a function that checks whether a process has a name."""
    return lambda action: bool((action.process_details or {}).get("name") == name)


def matches_executable(executable: str) -> Callable[[Any], bool]:
    """Return a function that checks whether a process has an executable."""
    return lambda action: os.path.basename(((action.process_details or {}).get("cmd") or [""])[0]) == executable  # noqa: PTH119

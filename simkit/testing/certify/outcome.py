"""Outcome of one run in a child process, and its file."""

from __future__ import annotations

import os
import pickle
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.errors import SimkitError

STACK_FILE: Final = "stack"
"""File to which `faulthandler` writes the stack trace of a process that is stopped at its limit."""

Numbers = npt.NDArray[np.uint64]


@dataclass
class TopicOutcome:
    """Hashes of the received messages of one topic.

    Attributes:
        type_name: ROS type.
        digests: Short hash of each message in CDR, shape (messages,).
        ticks: Tick at which each message was received, shape (messages,); -1 if messages were collected later.
        digest: Hexadecimal SHA-256 of all messages.
        owner: Publisher: `plugin 'drive' (robot.sdf:12)`.
    """

    type_name: str
    digests: Numbers
    ticks: npt.NDArray[np.int64]
    digest: str
    owner: str = ""


@dataclass
class PluginCall:
    """Call of a plugin.

    Attributes:
        tick: Tick of the call.
        owner: Plugin and its position: `plugin 'drive' (robot.sdf:12)`.
        hook: Name of the hook.
        before, after: Short hashes of the writable state before and after the call.
        changed: Hashes of attributes changed since the previous call; 0 for a deleted attribute.
        shown: Values of these attributes as short texts.
    """

    tick: int
    owner: str
    hook: str
    before: int
    after: int
    changed: dict[str, int] = field(default_factory=dict)
    shown: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class CodePosition:
    """Line of code that a process was executing.

    Attributes:
        file, line: Position.
        function: Name of the function.
    """

    file: str
    line: int
    function: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass
class RunOutcome:
    """Results of one run.

    Attributes:
        failure: Error of loading the world; None if it was loaded.
        stopped: Reason why the process gave no result; empty if it gave one.
        is_killed: True if the system killed the process, as Linux does when memory runs out.
        stack: Code positions when the process was stopped, innermost function first.
        end: Error that ended the run; empty for a regular end.
        ticks: Number of steps.
        timestep: Time step [s].
        state: Hash of the physics at the end, as `simkit run` prints it.
        marks: Short hash of the physics after each tick, shape (ticks,).
        inputs: Short hash of the inputs at each tick, shape (ticks,).
        heard: Topic -> hashes of its received messages.
        heard_from: Tick at which the subscribers were added; only later messages are compared.
        latest: Sensor -> hash of its newest reading at the end.
        remembered: Plugin -> hashes of its attributes at the end.
        sources: Plugin or sensor -> file, first line and last line of its class.
        fingerprint: Fingerprint of the machine.
        events: Recorded plugin calls; empty if the calls were not recorded.
        seconds: Wall time of the run [s].
    """

    failure: SimkitError | None = None
    stopped: str = ""
    is_killed: bool = False
    stack: list[CodePosition] = field(default_factory=list)
    end: str = ""
    ticks: int = 0
    timestep: float = 0.0
    state: str = ""
    marks: Numbers = field(default_factory=lambda: np.zeros(0, np.uint64))
    inputs: Numbers = field(default_factory=lambda: np.zeros(0, np.uint64))
    heard: dict[str, TopicOutcome] = field(default_factory=dict)
    heard_from: int = 0
    latest: dict[str, int] = field(default_factory=dict)
    remembered: dict[str, dict[str, int]] = field(default_factory=dict)
    sources: dict[str, tuple[str, int, int]] = field(default_factory=dict)
    fingerprint: dict[str, str] = field(default_factory=dict)
    events: list[PluginCall] = field(default_factory=list)
    seconds: float = 0.0


def write_pickle(path: Path, value: object) -> None:
    """Write an object for the other process atomically.

    Pickle is safe here, because both processes belong to the same user and use a private folder.
    """
    beside = path.with_suffix(".part")
    beside.write_bytes(pickle.dumps(value))
    os.replace(beside, path)  # noqa: PTH105 - atomic on every platform


def read_pickle(path: Path) -> Any:
    """Read the object that the other process wrote."""
    return pickle.loads(path.read_bytes())

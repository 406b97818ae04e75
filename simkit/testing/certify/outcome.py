"""What one process found, and its file."""

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
"""The file in which a process says where it stood when it was ended, as `faulthandler` writes it."""

Numbers = npt.NDArray[np.uint64]


@dataclass
class TopicOutcome:
    """What one topic gave.

    Attributes:
        type_name: its ROS type.
        digests: a short hash of each message as CDR, (messages,).
        ticks: when each arrived, (messages,); -1 where that was not seen, since messages were looked at later.
        digest: SHA-256 of all of them, hexadecimal.
        owner: who publishes it: `plugin 'drive' (robot.sdf:12)`.
    """

    type_name: str
    digests: Numbers
    ticks: npt.NDArray[np.int64]
    digest: str
    owner: str = ""


@dataclass
class PluginCall:
    """A plugin that was called.

    Attributes:
        tick: when.
        owner: who, with its place.
        hook: what was called, in words.
        before, after: short hashes of what plugins can write to, before the call and after it.
        changed: hashes of the attributes that are other than at its call before; 0 for one that is gone.
        shown: their values, where they are short.
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
    """A line of code that a run stood in.

    Attributes:
        file, line: where.
        function: its name.
    """

    file: str
    line: int
    function: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass
class RunOutcome:
    """What one run gave.

    Attributes:
        failure: why the world did not open; None where it did.
        stopped: why its process gave nothing: it ended, or had to be ended; empty where it did give something.
        stack: where it stood then, the innermost first.
        end: how the run ended: "", or what it was stopped by.
        ticks: how many steps it had.
        timestep: of one [s].
        state: the hash of the physics at the end, as `simkit run` prints it.
        marks: a short hash of the physics after each tick, (ticks,).
        inputs: the same of what was put in, (ticks,).
        heard: by topic.
        heard_from: the tick after which messages count.
        latest: a hash of the newest reading of each sensor at the end, by its scoped name.
        remembered: hashes of each plugin's attributes at the end, by plugin.
        sources: file of the code of each plugin, by plugin.
        fingerprint: of the machine.
        events: calls of plugins, where they were watched.
        seconds: wall time of the run.
    """

    failure: SimkitError | None = None
    stopped: str = ""
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
    """Hands something to the other process, as a whole; both are of the same user, and the folder is nobody else's."""
    beside = path.with_suffix(".part")
    beside.write_bytes(pickle.dumps(value))
    os.replace(beside, path)  # noqa: PTH105 - atomic on every platform


def read_pickle(path: Path) -> Any:
    """What the other process handed over."""
    return pickle.loads(path.read_bytes())

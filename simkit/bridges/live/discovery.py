"""List the running simulations, and find the socket of the requested simulation."""

from __future__ import annotations

import os
import select
import socket
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from simkit.bridges.live.protocol import LARGEST_OUT, TELL, BadFrame, FrameReader, LiveError, read_json_frame
from simkit.bridges.live.socket_files import connect, file_name, is_living, process_number, sockets
from simkit.diagnostics import did_you_mean

_GREETING_TIMEOUT = 0.5  # [s] of wall time, longest wait for a simulation's greeting
VARIABLE = "SIMKIT_SIM"


@dataclass(frozen=True)
class RunningSim:
    """Running simulation of this user.

    Attributes:
        name: name for connecting to the simulation.
        path: path of its socket.
        pid: number of its process; 0 if neither the system nor the simulation reports it.
        world: name of its world; empty if the simulation does not answer at once.
    """

    name: str
    path: Path
    pid: int
    world: str


def simulations() -> list[RunningSim]:
    """Return the running simulations of this user, sorted by name."""
    callers: dict[Path, socket.socket] = {}
    readers: dict[socket.socket, FrameReader] = {}
    for path in sockets():
        with suppress(OSError):  # the process has ended, or it does not answer
            callers[path], token = connect(path, _GREETING_TIMEOUT)
            readers[callers[path]] = FrameReader(LARGEST_OUT, (TELL,), token)
    greetings = _read_greetings(callers, readers)
    running = []
    for path, caller in callers.items():
        pid, world = greetings.get(path, (0, ""))
        with suppress(OSError):
            pid = process_number(path, caller) or pid
        running.append(RunningSim(path.stem, path, pid, world))
        caller.close()
    return running


def _read_greetings(
    callers: dict[Path, socket.socket], readers: dict[socket.socket, FrameReader]
) -> dict[Path, tuple[int, str]]:
    """Read process number and world from the greeting of each simulation; greetings that arrive late are left out."""
    paths = {caller: path for path, caller in callers.items()}
    greetings: dict[Path, tuple[int, str]] = {}
    waiting, end = set(readers), time.monotonic() + _GREETING_TIMEOUT
    while waiting and (left := end - time.monotonic()) > 0:
        for caller in select.select(list(waiting), [], [], left)[0]:
            try:
                data = caller.recv(1 << 16)
                readers[caller].feed(data)
                frame = readers[caller].next()
                if frame is not None:
                    words = read_json_frame(frame[1])[0]
                    greetings[paths[caller]] = int(words.get("pid", 0)), str(words.get("world", ""))
                if frame is not None or not data:
                    waiting.discard(caller)
            except (OSError, BadFrame, ValueError):
                waiting.discard(caller)
    return greetings


def find_socket(name: str | None = None) -> Path:
    """Return the socket of a simulation: `name`, else the name in `SIMKIT_SIM`, else the only running simulation.

    Raises:
        LiveError: SK-LIVE-001 no simulation runs; SK-LIVE-002 several simulations run; SK-LIVE-003 no simulation has
            the name.
    """
    requested_name = name or os.environ.get(VARIABLE) or None
    living = [path for path in sockets() if is_living(path)]
    names = [path.stem for path in living]
    listed = ", ".join(names)
    if requested_name is None:
        if len(living) == 1:
            return living[0]
        if living:
            raise LiveError("SK-LIVE-002", f"{len(living)} simulations run ({listed}); choose one with --sim NAME")
        raise LiveError("SK-LIVE-001", "no simulation runs; start one with `simkit run WORLD` in another terminal")
    for stem in (requested_name, file_name(requested_name)):  # a server replaces characters that files cannot have
        for path in living:
            if path.stem == stem:
                return path
    if not names:
        raise LiveError("SK-LIVE-001", f"no simulation {requested_name!r} runs; start one with `simkit run WORLD`")
    raise LiveError(
        "SK-LIVE-003",
        f"no simulation {requested_name!r} runs; {did_you_mean(requested_name, names) or 'running: ' + listed}",
    )

"""List the running simulations and find the socket of the one that is meant."""

from __future__ import annotations

import os
import select
import socket
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from simkit.bridges.live.protocol import LARGEST_OUT, TELL, BadFrame, FrameReader, LiveError, read_json_frame
from simkit.bridges.live.socket_files import file_name, is_living, is_possible, peer_credentials, sockets
from simkit.diagnostics import did_you_mean

_PATIENCE = 0.5  # [s] for which a simulation is waited for to say what it is
VARIABLE = "SIMKIT_SIM"


@dataclass(frozen=True)
class RunningSim:
    """A simulation that runs.

    Attributes:
        name: by which it is connected to.
        path: of its socket.
        pid: of its process; 0 where the system does not tell and it does not answer.
        world: the name of its world; empty where it does not answer at once.
    """

    name: str
    path: Path
    pid: int
    world: str


def simulations() -> list[RunningSim]:
    """The running simulations of this user, by name."""
    callers: dict[Path, socket.socket] = {}
    for path in sockets():
        caller = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        caller.settimeout(_PATIENCE)
        try:
            caller.connect(str(path))
            callers[path] = caller
        except OSError:  # nobody is there any more, or somebody is who does not answer
            caller.close()
    said = _read_greetings(callers)
    found = []
    for path, caller in callers.items():
        pid, world = said.get(path, (0, ""))
        with suppress(OSError):
            pid = peer_credentials(caller)[0] or pid
        found.append(RunningSim(path.stem, path, pid, world))
        caller.close()
    return found


def _read_greetings(callers: dict[Path, socket.socket]) -> dict[Path, tuple[int, str]]:
    """Read the process and world that each simulation sends first, as far as they come in time."""
    readers = {caller: FrameReader(LARGEST_OUT, (TELL,)) for caller in callers.values()}
    paths = {caller: path for path, caller in callers.items()}
    found: dict[Path, tuple[int, str]] = {}
    waiting, end = set(readers), time.monotonic() + _PATIENCE
    while waiting and (left := end - time.monotonic()) > 0:
        for caller in select.select(list(waiting), [], [], left)[0]:
            try:
                data = caller.recv(1 << 16)
                readers[caller].feed(data)
                frame = readers[caller].next()
                if frame is not None:
                    words = read_json_frame(frame[1])[0]
                    found[paths[caller]] = int(words.get("pid", 0)), str(words.get("world", ""))
                if frame is not None or not data:
                    waiting.discard(caller)
            except (OSError, BadFrame, ValueError):
                waiting.discard(caller)
    return found


def find_socket(name: str | None = None) -> Path:
    """The socket of a simulation: by name, else by the environment's `SIMKIT_SIM`, else of the only one.

    Raises:
        LiveError: SK-LIVE-001 none runs; SK-LIVE-002 several do; SK-LIVE-003 none of that name does.
    """
    if not is_possible():
        raise LiveError("this system's Python has no local sockets, so that nobody can be talked to", "SK-LIVE-001")
    wanted = name or os.environ.get(VARIABLE) or None
    living = [path for path in sockets() if is_living(path)]
    names = [path.stem for path in living]
    listed = ", ".join(names)
    if wanted is None:
        if len(living) == 1:
            return living[0]
        if living:
            raise LiveError(f"{len(living)} simulations run ({listed}); --sim NAME says which", "SK-LIVE-002")
        raise LiveError("no simulation runs; `simkit run WORLD` in another terminal starts one", "SK-LIVE-001")
    for said in (wanted, file_name(wanted)):  # a run of any name is called so that a file can be
        for path in living:
            if path.stem == said:
                return path
    if not names:
        raise LiveError(f"no simulation {wanted!r} runs, nor any other; `simkit run WORLD` starts one", "SK-LIVE-001")
    raise LiveError(
        f"no simulation {wanted!r} runs; {did_you_mean(wanted, names) or 'there is ' + listed}", "SK-LIVE-003"
    )

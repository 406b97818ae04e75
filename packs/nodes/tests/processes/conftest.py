"""A simulation that a thread keeps running, and programs beside it in processes of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent

import pytest

import simkit
from simkit.live import Client, Server

LIMIT = 60.0  # [s] of wall time for anything that must happen
ROOT = Path(__file__).resolve().parents[4]


class NodeProcess:
    """Process of `simkit node run`."""

    def __init__(self, file: Path, words: tuple[str, ...], options: tuple[str, ...]) -> None:
        command = [sys.executable, "-m", "simkit", "node", "run", *options, str(file), *words]
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, cwd=file.parent
        )
        self.lines: list[str] = []
        self._has_line = threading.Condition()
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._has_line:
                self.lines.append(line.rstrip("\n"))
                self._has_line.notify_all()
        with self._has_line:
            self._has_line.notify_all()

    def wait_for(self, text: str) -> str:
        """Return the first line with a text, once it is there."""

        def first() -> str | None:
            return next((line for line in self.lines if text in line), None)

        with self._has_line:
            self._has_line.wait_for(lambda: first() or not self._thread.is_alive(), LIMIT)
        line = first()
        assert line is not None, "\n".join([f"no line with {text!r}:", *self.lines])
        return line

    def end(self, number: int = signal.SIGINT) -> int:
        """Send a signal and return the exit code."""
        self.process.send_signal(number)
        return self.exit_code()

    def exit_code(self) -> int:
        """Return the exit code after the end."""
        code = self.process.wait(LIMIT)
        self._thread.join(LIMIT)
        assert self.process.stdout is not None
        self.process.stdout.close()
        return 130 if code == -signal.SIGINT else code  # Python ends itself so if Ctrl-C came within `exec` of a text

    @property
    def text(self) -> str:
        """All lines."""
        return "\n".join(self.lines)


@pytest.fixture
def sockets(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder for the sockets of these tests; a path of a socket has room for about 100 bytes."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp" if os.name == "posix" else None) as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        monkeypatch.delenv("SIMKIT_SIM", raising=False)
        yield Path(folder)


class RunningWorld:
    """Simulation that a thread keeps running.

    Attributes:
        client: client of the simulation.
    """

    def __init__(self, sim: simkit.Simulation) -> None:
        self._server = Server(sim)
        self._sim = sim
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()
        self.client = Client(self._server.path)

    def _run(self) -> None:
        while not self._is_over.is_set():
            self._server.poll(0.001)
            self._sim.run(0.005)

    def close(self) -> None:
        """End the simulation."""
        self._is_over.set()
        self._thread.join()
        self._server.close()
        self.client.close()

    def wait(self, condition: Callable[[], bool]) -> None:
        """Wait for a condition that depends on the answers of the simulation."""
        end = time.monotonic() + LIMIT
        while not condition():  # the simulation need not send anything when the condition comes true
            assert time.monotonic() < end
            self.client.receive(0.02)


@pytest.fixture
def world(sockets: Path) -> Iterator[RunningWorld]:
    """The world `empty`, running."""
    with simkit.load("empty") as sim:
        running = RunningWorld(sim)
        try:
            yield running
        finally:
            running.close()


@pytest.fixture
def run_node(sockets: Path, tmp_path: Path) -> Iterator[Callable[..., NodeProcess]]:
    """`run_node(program, *words)` starts a program of a text; `name` is the name of its file."""
    processes: list[NodeProcess] = []

    def start(
        text: str, *words: str, name: str = "program", options: tuple[str, ...] = ("--wait", "20")
    ) -> NodeProcess:
        file = tmp_path / f"{name}.py"
        file.write_text(dedent(text))
        processes.append(NodeProcess(file, words, options))
        return processes[-1]

    yield start
    for each in processes:
        if each.process.poll() is None:
            each.process.kill()
        each.exit_code()

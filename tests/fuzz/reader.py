"""A reader of broken files that survives its own death: a worker process, started anew when it crashes or hangs."""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import simkit

SECONDS = 30.0  # within which a file is answered, whatever it holds
CPU_SECONDS = 10.0  # of the processor that an answer may take
LARGEST = 2048  # [MiB] that reading it may take
FINE = {"loaded", "refused"}


class Reader:
    """Feeds files to a worker.

    Args:
        resources: resource folders that the files may name.

    Attributes:
        slowest: seconds and name of the input that took longest.
        largest: MiB and name of the input that took most memory.
        outcomes: how often each outcome came.
    """

    def __init__(self, resources: list[Path] | None = None) -> None:
        self._resources = [str(p) for p in resources or []]
        self._worker: subprocess.Popen[bytes] | None = None
        self._top = tempfile.TemporaryDirectory(prefix="simkit_fuzz_", ignore_cleanup_errors=True)
        self._said = tempfile.TemporaryFile()  # noqa: SIM115 -- closed with the reader
        self.slowest: tuple[float, str] = (0.0, "")
        self.largest: tuple[int, str] = (0, "")
        self.outcomes: dict[str, int] = {}

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
        self._said.close()
        self._top.cleanup()

    def read(
        self, main: str, files: Mapping[str, bytes], name: str = "", arguments: Sequence[str] = ()
    ) -> dict[str, Any]:
        """What became of a file with its companions; a crash or a hang of the worker is an outcome as well.

        Args:
            main: the name among `files` of the one that is opened.
            files: path -> content.
            name: how the report calls this input.
            arguments: command line that opens the files; empty: the main file is loaded as a world.
        """
        answer = self._ask(main, files, arguments)
        if answer["outcome"] in FINE and answer["cpu"] > CPU_SECONDS:
            answer["outcome"] = f"took {answer['cpu']} s"
        if answer["outcome"] in FINE and answer["peak_mib"] > LARGEST:
            answer["outcome"] = f"took {answer['peak_mib']} MiB"
        self.slowest = max(self.slowest, (answer.get("seconds", SECONDS), name))
        self.largest = max(self.largest, (answer.get("peak_mib", 0), name))
        self.outcomes[answer["outcome"]] = self.outcomes.get(answer["outcome"], 0) + 1
        return answer

    def report(self) -> str:
        """Counts, the slowest and the largest input in one line."""
        return (
            f"{sum(self.outcomes.values())} inputs {self.outcomes}; slowest {self.slowest[0]:.1f} s ({self.slowest[1]})"
            f"; largest {self.largest[0]} MiB ({self.largest[1]})"
        )

    def _ask(self, main: str, files: Mapping[str, bytes], arguments: Sequence[str]) -> dict[str, Any]:
        worker = self._worker or self._start()
        assert worker.stdin is not None
        lengths = [[n, len(c)] for n, c in files.items()]
        header = json.dumps({"main": main, "arguments": list(arguments), "files": lengths}).encode()
        try:
            worker.stdin.write(header + b"\n" + b"".join(files.values()))
            worker.stdin.flush()
        except BrokenPipeError:
            return self._died(worker)
        line = self._line(worker, SECONDS)
        if line is None:
            self.close()
            return {"outcome": f"no answer within {SECONDS:.0f} s", "trace": self._last_words()}
        return json.loads(line) if line else self._died(worker)

    def close(self) -> None:
        if self._worker is not None:
            self._worker.kill()
            self._worker.communicate()
            self._worker = None

    def _start(self) -> subprocess.Popen[bytes]:
        command = [sys.executable, str(Path(__file__).with_name("worker.py")), self._top.name, *self._resources]
        same_simkit = str(Path(simkit.__file__).resolve().parents[1])
        self._worker = subprocess.Popen(
            command,
            env={**os.environ, "PYTHONPATH": same_simkit},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
        )
        assert self._line(self._worker, 60.0) == b'{"ready": true}\n', "the worker does not start"
        return self._worker

    def _died(self, worker: subprocess.Popen[bytes]) -> dict[str, Any]:
        self._worker = None
        worker.communicate()
        code = worker.wait()
        name = signal.Signals(-code).name if code < 0 else str(code)
        return {"outcome": f"the interpreter died: {name}", "trace": self._last_words()}

    def _last_words(self) -> str:
        """Return the end of what the worker wrote to standard error: where each thread was, by faulthandler."""
        self._said.seek(max(0, self._said.seek(0, os.SEEK_END) - 5000))
        return self._said.read().decode(errors="replace")

    @staticmethod
    def _line(worker: subprocess.Popen[bytes], seconds: float) -> bytes | None:
        """The next line of its answer, empty when it has died, None when it does not come in time."""
        assert worker.stdout is not None
        with selectors.DefaultSelector() as ready:
            ready.register(worker.stdout, selectors.EVENT_READ)
            if not ready.select(seconds):
                return None
        return worker.stdout.readline()

"""Opens files as a user does, in this process, and prints which files were opened and what was said about them.

    python file_tracer.py JOBS.json

Each job is `[action, file]`, with an action of `ACTIONS`. The output has one JSON line for each job: the real paths of
the opened files, and the text of all messages. An audit hook sees the files that Python opens.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import simkit
from simkit.cli import main
from simkit.errors import SimkitError

_opened: list[str] = []


def _hear(event: str, values: tuple[Any, ...]) -> None:
    if event == "open" and isinstance(values[0], (str, bytes)):
        _opened.append(os.path.realpath(os.fsdecode(values[0])))


def _check(file: str) -> Iterator[str]:
    for diagnostic in simkit.check(file):
        yield f"{diagnostic} {diagnostic.hint}"


def _load(file: str) -> Iterator[str]:
    with simkit.load(file) as sim:
        sim.step()
        yield from (f"{diagnostic} {diagnostic.hint}" for diagnostic in sim.diagnostics)
    yield str(simkit.describe(file))


def _vendor(file: str) -> Iterator[str]:
    """Return the content of every file in the vendored folder."""
    target = Path(tempfile.mkdtemp())
    try:
        with contextlib.suppress(SystemExit):
            sys.argv = ["simkit", "vendor", file, str(target / "v")]
            main()
        yield from (path.read_bytes().decode(errors="replace") for path in target.rglob("*") if path.is_file())
    finally:
        shutil.rmtree(target)


ACTIONS: dict[str, Callable[[str], Iterator[str]]] = {"check": _check, "load": _load, "vendor": _vendor}


def run_job(action: str, file: str) -> dict[str, Any]:
    """Run one job; return the opened files and all text."""
    _opened.clear()
    said: list[str] = []
    output = io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
        try:
            said += ACTIONS[action](file)
        except SimkitError as error:
            said.append(str(error))
    return {"opened": sorted(set(_opened)), "said": output.getvalue() + "\n".join(said)}


if __name__ == "__main__":
    sys.addaudithook(_hear)
    for job in json.loads(Path(sys.argv[1]).read_text("utf-8")):
        sys.stdout.write(json.dumps(run_job(*job)) + "\n")

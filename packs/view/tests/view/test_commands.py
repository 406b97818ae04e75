"""The address that `simkit run --web` and `simkit view` print, on a line of its own."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from packs.view.tests.view.conftest import TIMEOUT, YARD

ROOT = Path(__file__).parents[4]
ADDRESS = re.compile(r"http://127\.0\.0\.1:\d+/\?token=[\w-]{20,}\n")


@pytest.fixture
def folder() -> Iterator[Path]:
    """Short path, because that of a socket has room for about 100 bytes."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp" if os.name == "posix" else None) as found:
        (Path(found) / "yard.sdf").write_text(YARD, encoding="utf-8")
        yield Path(found)


@contextmanager
def started(folder: Path, *arguments: str, **streams: int) -> Iterator[subprocess.Popen[str]]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_RUNTIME_DIR": str(folder), "TERM": "xterm"}
    command = [sys.executable, "-m", "simkit", *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams}
    with subprocess.Popen(command, cwd=folder, env=environment, text=True, **pipes) as process:
        try:
            yield process
        finally:
            process.terminate()


@pytest.mark.slow
def test_a_run_prints_the_address_first_and_serves_the_page(folder: Path) -> None:
    with started(folder, "run", "yard.sdf", "--web", "--no-open") as run:
        address = run.stdout.readline()
        assert ADDRESS.fullmatch(address)
        with urllib.request.urlopen(address.strip(), timeout=TIMEOUT) as answer:
            assert b'<script type="module" src="app.js">' in answer.read()


@pytest.mark.slow
def test_the_address_is_the_last_line_before_the_run(folder: Path) -> None:
    with started(folder, "view", "yard.sdf", "--no-open", stderr=subprocess.STDOUT) as view:
        lines = []
        while not ADDRESS.fullmatch(lines[-1] if lines else ""):
            lines.append(view.stdout.readline())
        assert any("paused at t=0 s until the page or a service resumes it" in line for line in lines)
        view.send_signal(signal.SIGINT)
        assert view.stdout.readline().startswith("simulated 0.000 s")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals are of POSIX systems")
def test_a_terminal_shows_the_address_below_the_time_as_long_as_the_run_lasts(folder: Path) -> None:
    own, other = os.openpty()
    screen = ""
    with started(folder, "view", "yard.sdf", "--no-open", stdout=other, stderr=other, stdin=other) as view:
        os.close(other)
        pattern = re.compile(r"t = [\d.]+ s   paused\s+" + ADDRESS.pattern.replace(r"\n", r"\s+topic"))
        while len(pattern.findall(screen)) < 3:  # three drawings of the display
            screen += re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", os.read(own, 65536).decode())
        view.send_signal(signal.SIGINT)
        while "state " not in screen:
            screen += os.read(own, 65536).decode()
    os.close(own)


@pytest.mark.slow
def test_other_machines_are_let_in_only_with_a_warning(folder: Path) -> None:
    with started(folder, "run", "yard.sdf", "--web", "--host", "0.0.0.0", "--no-open", "--duration", "0.1") as run:
        output, errors = run.communicate(timeout=TIMEOUT)
    assert ADDRESS.match(output) and "warning SK-WEB-007" in errors
    assert run.returncode == 0


@pytest.mark.slow
@pytest.mark.parametrize("option", [["--no-open"], ["--host", "::1"], ["--web=x"], ["--web", "99999"]])
def test_a_wrong_option_is_refused(folder: Path, option: list[str]) -> None:
    with started(folder, "run", "yard.sdf", *option) as run:
        _, errors = run.communicate(timeout=TIMEOUT)
    assert run.returncode == 2 and "Traceback" not in errors


@pytest.mark.slow
def test_a_running_simulation_shows_its_page_to_another_terminal(folder: Path) -> None:
    with started(folder, "run", "yard.sdf", "--rtf", "1", "--name", "lab") as run:
        while "until Ctrl-C" not in run.stderr.readline():
            pass
        with started(folder, "view", "lab", "--no-open") as view:
            address = view.stdout.readline()
            assert ADDRESS.fullmatch(address)
            with urllib.request.urlopen(address.strip(), timeout=TIMEOUT) as answer:
                assert answer.status == 200


@pytest.mark.slow
def test_a_world_that_is_viewed_stands_still(folder: Path) -> None:
    with started(folder, "view", "yard.sdf", "--no-open") as view:
        assert ADDRESS.fullmatch(view.stdout.readline())
        while "paused at t=0 s" not in view.stderr.readline():
            pass

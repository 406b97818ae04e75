"""Ctrl-C and SIGTERM end every command with one line and exit code 130 or 143, at any moment."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SLEEPING_PLUGIN = """
import time
import simkit

class Sleeping(simkit.WorldPlugin):
    def load(self, parent, params):
        {code}
"""
WORLD = """<sdf version="1.9"><world name="w">
  <plugin name="p" filename="sleeping.py"/>
</world></sdf>"""


def start(*words: object, cwd: Path | None = None, **environment: str) -> subprocess.Popen[str]:
    """Start a command as a shell in the foreground does: Ctrl-C is not ignored."""
    ours = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), **environment}
    return subprocess.Popen(
        [sys.executable, "-m", "simkit", *map(str, words)],
        cwd=cwd, env=ours, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip


def interrupt_loading(tmp_path: Path, code: str, number: int = signal.SIGINT) -> tuple[int, str]:
    """Interrupt a check while the plugin of its world loads; return the exit code and standard error."""
    if "loading" not in code:
        code = 'print("loading", flush=True)\n        ' + code
    (tmp_path / "sleeping.py").write_text(SLEEPING_PLUGIN.format(code=code))
    (tmp_path / "w.sdf").write_text(WORLD)
    with start("run", "w.sdf", "--plugin-path", ".", "--duration", "1", cwd=tmp_path) as process:
        assert process.stdout is not None and process.stdout.readline() == "loading\n"
        process.send_signal(number)
        _, messages = process.communicate()
    return process.returncode, messages


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_while_a_world_loads_ends_with_one_line(tmp_path: Path, number: int) -> None:
    assert interrupt_loading(tmp_path, "time.sleep(100)", number) == (128 + number, "interrupted\n")


def test_an_interrupt_that_a_library_turns_into_an_import_error_is_still_an_interrupt(tmp_path: Path) -> None:
    code = """
        try:
            time.sleep(100)
        except KeyboardInterrupt:
            raise ImportError("initialization failed")
        """
    assert interrupt_loading(tmp_path, code) == (130, "interrupted\n")


def test_an_interrupt_that_is_lost_in_a_destructor_is_raised_again(tmp_path: Path) -> None:
    code = """
        class Lost:
            def __del__(self):
                time.sleep(100)
        Lost()
        time.sleep(100)
        """
    assert interrupt_loading(tmp_path, code) == (130, "interrupted\n")


def test_an_interrupt_during_a_long_call_of_a_library_ends_the_process(tmp_path: Path) -> None:
    """`pause` in a loop in C is not available everywhere: SQLite counts for minutes in one call."""
    code = """
        import sqlite3
        count = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x+1 FROM c WHERE x < 1e9) SELECT sum(x) FROM c"
        sqlite3.connect(":memory:").execute(count).fetchone()
        """
    assert interrupt_loading(tmp_path, code) == (130, "interrupted\n")


@pytest.mark.slow
def test_files_and_clean_up_code_are_finished_before_the_end(tmp_path: Path) -> None:
    code = """
        try:
            print("loading", flush=True)
            time.sleep(100)
        finally:
            time.sleep(0.5)
            open("cleaned", "w").write("yes")
        """
    assert interrupt_loading(tmp_path, code) == (130, "interrupted\n")
    assert (tmp_path / "cleaned").read_text() == "yes"


def test_an_ignored_ctrl_c_stays_ignored() -> None:
    """A shell script starts `simkit … &` so; the command must run to its end."""
    script = (
        "import signal, simkit.cli; signal.signal(2, signal.SIG_IGN); from simkit.cli.terminal import interruption; "
        "interruption.install(); signal.raise_signal(2); print(signal.getsignal(2) is signal.SIG_IGN)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def interrupt_after(delay: float, number: int, words: tuple[str, ...]) -> None:
    """Interrupt a command some time after simkit's first instruction and check its end."""
    main = f"import signal, threading; threading.Timer({delay}, signal.raise_signal, ({number},)).start(); "
    command = f"import sys; sys.argv = ['simkit', *{words!r}]; from simkit.cli import main; main()"
    restored = "signal.signal(2, signal.default_int_handler); "
    ours = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", "import simkit.cli; " + main + restored + command],
        capture_output=True, text=True, check=False, env=ours, timeout=60,
    )  # fmt: skip
    assert done.returncode == 128 + number, (delay, words, done.stderr)
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr, (delay, words, done.stderr)
    has_begun = "running until" in done.stderr  # then the run prints its summary
    assert has_begun or done.stderr.splitlines()[-1] == "interrupted", (delay, words, done.stderr)


START = """
import os, signal, sys
left = [int(os.environ["SIMKIT_TEST_FILE"])]
def hear(event, values):
    if event == "exec" and f"{os.sep}simkit{os.sep}" in getattr(values[0], "co_filename", ""):
        left[0] -= 1
        if left[0] == 0:
            signal.raise_signal(int(os.environ["SIMKIT_TEST_SIGNAL"]))
sys.addaudithook(hear)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("file", [3, 4, 6, 8, 9, 12])
def test_a_signal_while_the_first_files_are_imported_ends_with_one_line(
    file: int, number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first two files are `simkit/__init__.py` and the one with the handler."""
    (tmp_path / "sitecustomize.py").write_text(START)
    monkeypatch.syspath_prepend(tmp_path)
    with start("--version", SIMKIT_TEST_FILE=str(file), SIMKIT_TEST_SIGNAL=str(int(number))) as process:
        _, messages = process.communicate()
    assert (process.returncode, messages) == (128 + number, "interrupted\n")


def test_importing_simkit_changes_no_signal_handler() -> None:
    script = "import signal, simkit.cli; print(signal.getsignal(2) is signal.default_int_handler, signal.getsignal(15))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == f"True {signal.SIG_DFL}\n"


LONG = (
    ("run", "turtlebot3_world", "--rtf", "1"),
    ("run", "turtlebot3_empty", "--rtf", "1"),
    ("certify", "turtlebot3_world"),
)


@pytest.mark.parametrize("delay", [0.02, 0.15, 0.4])
def test_a_command_can_be_interrupted_from_its_first_milliseconds(delay: float) -> None:
    interrupt_after(delay, signal.SIGINT, LONG[0])


@pytest.mark.fuzz
def test_a_command_can_be_interrupted_at_any_moment() -> None:
    draw, begun = random.Random(0), time.perf_counter()
    for _ in range(200):
        interrupt_after(draw.uniform(0.005, 1.5), draw.choice((signal.SIGINT, signal.SIGTERM)), draw.choice(LONG))
        if time.perf_counter() - begun > float(os.environ.get("SIMKIT_FUZZ_SECONDS", "300")):
            break

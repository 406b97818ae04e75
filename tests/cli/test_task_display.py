"""Long tasks on a terminal: shown after a second, gone at the end, and never in pipes or CI."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from simkit.cli.terminal import task_display
from simkit.cli.terminal.task_display import displayed_tasks, task_text, time_text
from simkit.progress import Task, task
from tests.cli.terminals import Terminal

WAITING = """
import time, pathlib, simkit

class Waiting(simkit.WorldPlugin):
    def load(self, parent, params):
        while not pathlib.Path("go").exists():
            time.sleep(0.01)
"""
WORLD = """<sdf version="1.9"><world name="w"><plugin name="p" filename="waiting.py"/></world></sdf>"""


def check_in_terminal(folder: Path, **environment: str) -> Terminal:
    """Start a check of a world whose plugin waits for the file `go`."""
    (folder / "waiting.py").write_text(WAITING)
    (folder / "w.sdf").write_text(WORLD)
    words = (
        "run",
        "w.sdf",
        "--plugin-path",
        ".",
        "--duration",
        "0.1",
        "--quiet" if environment.pop("quiet", "") else "-v",
    )
    return Terminal(sys.executable, "-m", "simkit", *words, cwd=folder, environment={"CI": "", **environment})


@pytest.mark.slow
def test_a_long_task_is_shown_and_removed(tmp_path: Path) -> None:
    with check_in_terminal(tmp_path) as terminal:
        terminal.wait_for(r"loading plugins, [12] s")
        (tmp_path / "go").touch()
        assert terminal.wait() == 0
        # the last drawing is erased, and the cursor is visible again
        assert "\x1b[2K" in terminal.seen and terminal.seen.rfind("\x1b[?25h") > terminal.seen.rfind("\x1b[?25l")
        assert "loading" not in terminal.seen.rpartition("\x1b[2K")[2]


@pytest.mark.slow
def test_ctrl_c_removes_the_display(tmp_path: Path) -> None:
    with check_in_terminal(tmp_path) as terminal:
        terminal.wait_for("loading plugins")
        terminal.press("\x03")
        assert terminal.wait() == 130
        assert (
            terminal.seen.rpartition("\x1b[2K")[2].strip().endswith("interrupted") and "Traceback" not in terminal.seen
        )


@pytest.mark.slow
@pytest.mark.parametrize("environment", [{"CI": "true"}, {"TERM": "dumb"}, {"quiet": "yes"}])
def test_nothing_is_shown_in_ci_or_if_quiet(tmp_path: Path, environment: dict[str, str]) -> None:
    with check_in_terminal(tmp_path, **environment) as terminal:
        end = time.monotonic() + 2.5
        while time.monotonic() < end:
            terminal._read(end)
        (tmp_path / "go").touch()
        assert terminal.wait() == 0 and "loading" not in terminal.seen


def test_a_task_is_one_line_with_amount_item_and_times() -> None:
    task = Task("building models", total=80, item="shelf.dae")
    task.begun, task.done = task.begun - 4.0, 20
    assert task_text(task) == "building models: 20 of 80 (shelf.dae), 4 s, about 12 s left"
    task = Task("running w", total=10.0, unit="s", done=2.5)
    task.begun -= 100.0
    assert task_text(task) == "running w: 2.5 of 10 s, 1 min 40 s, about 5 min 0 s left"
    assert task_text(Task("decomposing", total=6.0, unit="%", done=3.0)).startswith("decomposing: 50 %, 0 s")
    assert task_text(Task("copying")) == "copying, 0 s"
    assert time_text(7500.0) == "2 h 5 min"


def test_without_a_terminal_a_long_task_is_a_line_from_time_to_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(task_display, "_FIRST_LINE", 0.05)
    monkeypatch.setattr(task_display, "_LINE_PERIOD", 0.05)
    written = ""
    with displayed_tasks(lambda: pytest.fail("no console is needed")), task("checking files", 4) as outer:
        outer.advance("a.sdf")
        with task("reading the world"):
            while written.count("\n") < 2:
                written += capsys.readouterr().err
    first = written.splitlines()[0]
    assert first.startswith("checking files: 1 of 4 (a.sdf), 0 s") and first.endswith("; reading the world, 0 s")
    assert "\x1b" not in written


def test_a_short_or_quiet_task_writes_no_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with displayed_tasks(lambda: pytest.fail("no console is needed")), task("short"):
        pass
    monkeypatch.setattr(task_display, "_FIRST_LINE", 0.0)
    with displayed_tasks(lambda: pytest.fail("no console is needed"), quiet=True), task("quiet"):
        pass
    assert capsys.readouterr().err == ""

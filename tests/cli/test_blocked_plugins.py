"""A run that a plugin keeps waiting says which, and where; one that a plugin ends leaves its recording whole."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

import simkit
from simkit import Params, WorldPlugin
from simkit.cli import app
from simkit.cli.terminal.blocked_plugins import BlockedPlugins, describe_blocking_plugin
from simkit.runtime import Simulation

EMPTY = "<sdf version='1.9'><world name='w'/></sdf>"
ROOT = Path(__file__).resolve().parents[2]


class Looker(WorldPlugin):
    """Looks where it is itself."""

    def load(self, parent: Simulation, params: Params) -> None:
        self.seen = {"load": self.look()}
        self.listen("poke", "std_msgs/msg/Empty", lambda _: self.note("poke"))
        self.offer("ask", "std_srvs/srv/Empty", lambda _: self.note("ask"))

    def look(self) -> str:
        found = describe_blocking_plugin(sys._getframe())
        return "" if found is None else found[1]

    def note(self, what: str) -> None:
        self.seen[what] = self.look()

    def before_step(self) -> None:
        self.note("before_step")

    def after_step(self) -> None:
        self.note("after_step")


def test_the_hook_at_work_is_found_in_the_stack_with_its_line() -> None:
    looker = Looker()
    with simkit.load(EMPTY, plugins=[looker]) as sim:
        sim.publish("/poke", {})
        sim.call("/ask")
        sim.step()
        assert describe_blocking_plugin(sys._getframe()) is None
    for hook, said in {
        "load": "in load,",
        "before_step": "in before_step,",
        "after_step": "in after_step,",
        "poke": "in its callback for '/poke',",
        "ask": "in service /ask,",
    }.items():
        text = looker.seen[hook]
        assert "plugin 'Looker'" in text and said in text, hook
        assert "test_blocked_plugins.py:" in text and text.endswith("in look")


class Waiter(WorldPlugin):
    """Waits in its third step until it is told of."""

    def __init__(self, told: threading.Event) -> None:
        self.told, self.steps = told, 0

    def load(self, parent: Simulation, params: Params) -> None:
        pass

    def after_step(self) -> None:
        self.steps += 1
        if self.steps == 3:
            assert self.told.wait(60)


def test_only_a_plugin_that_blocks_too_long_is_reported() -> None:
    told, lines = threading.Event(), []

    def say(text: str) -> None:
        lines.append(text)
        told.set()

    waiter = Waiter(told)
    with BlockedPlugins(say, patience=0.3), simkit.load(EMPTY, plugins=[waiter]) as sim:
        sim.step(5)
    assert len(lines) == 1 and waiter.steps == 5
    assert lines[0].startswith("waiting for plugin 'Waiter'") and "in after_step, at " in lines[0]


@pytest.mark.slow
def test_after_a_requested_stop_a_blocking_plugin_is_reported_sooner() -> None:
    told, lines = threading.Event(), []

    def say(text: str) -> None:
        lines.append(text)
        told.set()

    with BlockedPlugins(say, patience=1e9) as blocked, simkit.load(EMPTY, plugins=[Waiter(told)]) as sim:
        blocked.hasten()
        sim.step(5)
    assert len(lines) == 1 and lines[0].endswith("Ctrl-C again stops at once")


PLUGIN = """
import os
import signal
from simkit import WorldPlugin

class Trouble(WorldPlugin):
    def load(self, parent, params):
        self.kind = params.text("kind")

    def after_step(self):
        if self.sim.time < 0.2:
            return
        if self.kind == "raise":
            raise ValueError("that was all")
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGINT)
        while True:
            pass
"""


def trouble(folder: Path, kind: str) -> None:
    (folder / "trouble.py").write_text(PLUGIN)
    plugin = f"<plugin name='trouble' filename='trouble.py'><kind>{kind}</kind></plugin>"
    (folder / "w.sdf").write_text(EMPTY.replace("/></sdf>", f">{plugin}</world></sdf>"))


def recorded(file: Path) -> int:
    """How many messages a recording has, which must have been closed."""
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None and summary.statistics is not None
    return int(summary.statistics.message_count)


def run(folder: Path, *options: str) -> Any:
    words = ["run", str(folder / "w.sdf"), "--plugin-path", str(folder), "--duration", "0.5", *options]
    return CliRunner().invoke(app, words)


@pytest.mark.parametrize(("word", "code", "messages"), [("stop", 4, 20), ("disable", 0, 50), ("", 4, 20)])
def test_a_plugin_that_raises_stops_the_run_or_is_left_out(tmp_path: Path, word: str, code: int, messages: int) -> None:
    trouble(tmp_path, "raise")
    bag = tmp_path / "out.mcap"
    options = ["--on-plugin-error", word] if word else []
    done = run(tmp_path, *options, "--record", str(bag), "--topic", "/clock")
    assert done.exit_code == code, done.output
    assert messages - 1 <= recorded(bag) <= messages
    assert ("SK-PLUGIN-004" in done.output) is (code == 4)


def test_another_word_is_bad_usage(tmp_path: Path) -> None:
    trouble(tmp_path, "raise")
    done = run(tmp_path, "--on-plugin-error", "ignore")
    assert done.exit_code == 2 and "expected stop, disable" in done.output


@pytest.mark.skipif(sys.platform == "win32", reason="has other signals")
@pytest.mark.slow
def test_a_second_interrupt_stops_in_the_middle_of_a_hook_and_the_recording_is_whole(tmp_path: Path) -> None:
    trouble(tmp_path, "hang")
    bag = tmp_path / "out.mcap"
    words = ["-m", "simkit", "run", str(tmp_path / "w.sdf"), "--plugin-path", str(tmp_path), "--record", str(bag)]
    done = subprocess.run(
        [sys.executable, *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(ROOT)},
        check=False,
    )
    assert done.returncode == 130, done.stderr
    assert "interrupted in the middle of plugin 'trouble'" in done.stderr and "in after_step" in done.stderr
    assert recorded(bag) > 0

"""Types of the user on the command line: every command reads them, and bags, clients and bundles carry them."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from simkit import msgs
from simkit.cli import app
from simkit.live import connect

ROOT = str(Path(__file__).resolve().parents[2])
PLUGIN = """
import simkit
from simkit import msgs

class Counter(simkit.WorldPlugin):
    filenames = ("libcounter.so",)
    after_step_rate = 10.0

    def load(self, parent, params):
        self.number, self.heard = 0, 0
        self.topic = self.advertise("/num", "course_msgs/msg/Num")
        self.offer("/add", "course_msgs/srv/AddThreeInts", self.add)

    def add(self, request):
        return msgs.make("course_msgs/srv/AddThreeInts_Response", sum=request.a + request.b + request.c)

    def after_step(self):
        self.number += 1
        self.topic.publish(msgs.make("course_msgs/msg/Num", num=self.number))
"""
WORLD = '<sdf version="1.9"><world name="course"><plugin filename="libcounter.so" name="counter"/></world></sdf>'
Line = Callable[..., str]


@pytest.fixture
def line(tmp_path: Path) -> Iterator[Line]:
    """Return a function that runs a command in a process of its own, in a folder with a world and a plugin."""
    (tmp_path / "plugins").mkdir()
    (tmp_path / "plugins" / "counter.py").write_text(PLUGIN, encoding="utf-8")
    (tmp_path / "world").mkdir()
    (tmp_path / "world" / "course.sdf").write_text(WORLD, encoding="utf-8")
    for name, text in (
        ("msg/Num.msg", "int64 num\n"),
        ("srv/AddThreeInts.srv", "int64 a\nint64 b\nint64 c\n---\nint64 sum\n"),
    ):
        file = tmp_path / "types" / "course_msgs" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as sockets:
        environment = {**os.environ, "PYTHONPATH": ROOT, "XDG_RUNTIME_DIR": sockets, "TMPDIR": sockets, "NO_COLOR": "1"}

        def run(*words: str, code: int = 0) -> str:
            done = subprocess.run(
                [sys.executable, "-m", "simkit", *words],
                cwd=tmp_path,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == code, done.stdout + done.stderr
            return done.stdout + done.stderr

        run.environment = environment  # type: ignore[attr-defined]
        yield run


RUN = ("run", "world/course.sdf", "--plugin-path", "plugins")
TYPES = ("--interfaces", "types")


@pytest.mark.slow
def test_a_run_a_bag_and_a_bundle_know_the_types_and_later_commands_need_no_folder(line: Line, tmp_path: Path) -> None:
    assert "--interfaces DIR" in line(*RUN, "--duration", "0.5", code=4)
    line(*RUN, *TYPES, "--duration", "0.5", "--record", "run.mcap")
    assert line("topic", "echo", "/num", "--bag", "run.mcap", "--csv").split() == ["1", "2", "3", "4", "5"]
    assert line("interface", "show", "course_msgs/msg/Num", "--bag", "run.mcap") == "int64 num\n"
    line("bundle", "world/course.sdf", "--plugin-path", "plugins", *TYPES, "--duration", "0.5", "-o", "run.zip")
    assert "identical" in line("replay", "run.zip", "--allow-code")


@pytest.mark.slow
def test_a_client_knows_what_the_run_knows_and_the_run_what_a_client_defines(
    line: Line, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    environment = line.environment  # type: ignore[attr-defined]
    command = [sys.executable, "-m", "simkit", *RUN, *TYPES, "--paused", "--quiet", "--name", "own_types"]
    run = subprocess.Popen(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
    monkeypatch.setenv("XDG_RUNTIME_DIR", environment["XDG_RUNTIME_DIR"])
    monkeypatch.delenv("SIMKIT_SIM", raising=False)
    try:
        with connect("own_types", timeout=30.0, wait=30.0) as client:
            assert line("interface", "show", "course_msgs/msg/Num") == "int64 num\n"
            assert "sum=6" in line("service", "call", "/add", "{a: 1, b: 2, c: 3}")
            numbers = client.subscribe("/num")
            msgs.add("client_msgs/msg/Note", "geometry_msgs/Point at\nstring text\n")
            notes = client.subscribe("/note")
            client.advertise("/note", "client_msgs/msg/Note").publish({"text": "hi"})
            client.control("step", 101)
            received, note = numbers.get(20.0), notes.get(20.0)
            assert received is not None
            assert note is not None
            assert (received.type_name, received.message.num) == ("course_msgs/msg/Num", 1)
            assert (note.type_name, note.message.text) == ("client_msgs/msg/Note", "hi")
            assert client.call("/add", {"a": 1, "b": 2, "c": 4}).sum == 7
            assert set(client.interfaces()) == {
                "client_msgs/msg/Note",
                "course_msgs/msg/Num",
                "course_msgs/srv/AddThreeInts",
            }
    finally:
        run.terminate()
        run.communicate(timeout=20)


def test_broken_definitions_are_left_out_with_all_problems(line: Line, tmp_path: Path) -> None:
    (tmp_path / "types" / "course_msgs" / "msg" / "Bad.msg").write_text("int count\nint64 wheelCount\n")
    text = line("interface", "show", "course_msgs/msg/Num", *TYPES).replace("\n", "")
    assert "Bad.msg:1: warning SK-INTERFACE-003: unknown type 'int'" in text
    assert "Bad.msg:2: warning SK-INTERFACE-002" in text
    assert "int64 num" in text
    text = line("interface", "show", "course_msgs/msg/Bad", *TYPES, code=2)
    assert "Bad.msg:1: error SK-INTERFACE-003: unknown type 'int'" in text
    assert "Traceback" not in text


def commands(group: Any, name: str = "simkit") -> Iterator[tuple[str, Any]]:
    """Yield every command below a group of commands, with its name."""
    for word, each in getattr(group, "commands", {}).items():
        real = getattr(each, "real", each)
        if hasattr(real, "commands"):
            yield from commands(real, f"{name} {word}")
        else:
            yield f"{name} {word}", real


def test_every_command_has_the_option() -> None:
    root: Any = typer.main.get_command(app)
    root.list_commands(typer.Context(root))  # adds the commands of packs
    found = dict(commands(root))
    assert len(found) > 60
    for name, command in found.items():
        names = [each.name for each in command.get_params(command.context_class(command))]
        assert names.count("interfaces") == 1, name

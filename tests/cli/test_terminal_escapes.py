"""Names out of files cannot control the terminal: every command prints their control characters as `\\x1b`."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from simkit import msgs
from simkit.cli.terminal.output import printable, stdout_console
from simkit.recording.bags.writer import McapBag

EVIL = "/a\x1b]0;title\x07\x1b[31m\x9b1m\u202e\nb"
SHOWN = r"/a\x1b]0;title\x07\x1b[31m\x9b1m\u202e"
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e]")
TF, TEXT = "tf2_msgs/msg/TFMessage", "std_msgs/msg/String"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    bag = McapBag(tmp_path / "run.mcap")
    named = bag.add_channel(EVIL, TEXT, False, msgs.definition(TEXT).encode(), {})
    typed = bag.add_channel("/typed", EVIL, False, b"string data", {})
    text = msgs.serialize(msgs.make(TEXT, data=EVIL))
    for channel in (named, typed):
        bag.write_raw(channel, text, 0)
    stamped = {"header": {"frame_id": EVIL}, "child_frame_id": f"child{EVIL}"}
    bag.write_raw(bag.channel("/tf", TF, False), msgs.serialize(msgs.make(TF, transforms=[stamped])), 0)
    bag.close()
    return bag.path


def test_no_command_on_a_bag_prints_a_control_character(bag: Path, simkit_line: Any, tmp_path: Path) -> None:
    at = ("--bag", str(bag))
    commands: list[tuple[str, ...]] = [
        *(("topic", "list", *at), ("topic", "list", "-t", *at), ("topic", "echo", EVIL, *at)),
        *(("topic", "echo", EVIL, "--field", "data", *at), ("topic", "echo", EVIL, "--csv", *at)),
        *(("topic", "echo", "/typed", *at), ("topic", "echo", "/none", *at), ("topic", "info", EVIL, *at)),
        *(("tf", "tree", *at), ("tf", "echo", "a", "b", *at), ("interface", "show", EVIL, *at)),
        *(("bag", "info", str(bag)), ("bag", "info", str(bag), "-t"), ("bag", "plot", str(bag))),
        ("bag", "export", str(bag), "--topic", "/a*", "-o", str(tmp_path / "out")),
        ("bag", "recover", str(bag), str(tmp_path / "saved.mcap")),
    ]
    for command in commands:
        found = simkit_line(*command)
        assert found.exit_code in (0, 2), (command, found.stderr)
        assert not CONTROL.search(found.stdout + found.stderr), command
    assert SHOWN + r"\nb" in simkit_line("topic", "list", *at).stdout.splitlines()
    assert SHOWN.removeprefix("/") in simkit_line("tf", "tree", *at).stdout
    names = simkit_line("topic", "list", "--json", *at).stdout
    assert not CONTROL.search(names) and EVIL in [row["name"] for row in json.loads(names)]


def test_no_command_on_a_world_prints_a_control_character(simkit_line: Any, tmp_path: Path) -> None:
    name = "m&#x9b;31m&#x7f;"
    world = f'<sdf version="1.9"><world name="{name}"><model name="{name}"><link name="l"/></model></world></sdf>'
    (tmp_path / "w.sdf").write_text(world, encoding="utf-8")
    for command in (
        ("inspect",),
        ("inspect", "--json"),
        ("check",),
        ("check", "--json"),
        ("run", "--duration", "0.01"),
    ):
        found = simkit_line(command[0], str(tmp_path / "w.sdf"), *command[1:])
        assert found.exit_code == 0 and not CONTROL.search(found.stdout + found.stderr), command


def test_styles_stay_and_controls_in_styled_texts_do_not(capsys: pytest.CaptureFixture[str]) -> None:
    from rich.text import Text

    stdout_console().print(Text("\x1b[31mname", style="red"), "\x9brow")
    assert capsys.readouterr().out == "\\x1b[31mname \\x9brow\n"
    assert printable("\x1b[1m\tü\n\ud800") == "\\x1b[1m\tü\n\\ud800"

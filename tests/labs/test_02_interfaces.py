"""Lab 2: the commands of its README work in terminals of their own, and draw its picture."""

from __future__ import annotations

import shutil
import tempfile
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.cli.course_page import Desk, blocks

LAB = Path(__file__).parents[2] / "labs" / "02_interfaces"
README = (LAB / "README.md").read_text("utf-8")
END = README.index("Ctrl-C ends a node.")
CHECKS = """
The nodes are at work. Terminal 6:

```console title="Terminal 6"
{shown}$ simkit interface package lab_interfaces --interfaces lab_interfaces
lab_interfaces/msg/Num
lab_interfaces/srv/AddThreeInts
lab_interfaces/action/Countdown
$ simkit service call /add_three_ints lab_interfaces/srv/AddThreeInts "{a: 9223372036854775807, b: -1, c: -7}"
requester: making request: lab_interfaces.srv.AddThreeInts_Request(a=9223372036854775807, b=-1, c=-7)

response:
lab_interfaces.srv.AddThreeInts_Response(sum=9223372036854775799)

```
"""


@pytest.mark.labs
def test_the_commands_of_the_readme_work_in_separate_terminals_and_draw_its_picture(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    interfaces = ("msg/Num", "srv/AddThreeInts", "action/Countdown")
    definitions = {name: LAB / f"solution/lab_interfaces/{name}.{name.split('/')[0]}" for name in interfaces}
    shown = "".join(
        f"$ simkit interface show lab_interfaces/{name}\n{file.read_text('utf-8')}"
        for name, file in definitions.items()
    )
    desk_folder = tmp_path / "desk"
    shutil.copytree(LAB, desk_folder, ignore=shutil.ignore_patterns("solution", "__pycache__", "graph.svg"))
    shutil.copytree(LAB / "solution", desk_folder, dirs_exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as sockets, ExitStack() as stack:
        desk = Desk(desk_folder, stack, {"TMPDIR": sockets, "XDG_RUNTIME_DIR": sockets})
        desk.play(README[:END])
        desk.play(CHECKS.replace("{shown}", shown))
        desk.play(README[END:])
        desk.finish()
    drawn = desk_folder / "my_graph.svg"
    assert (LAB / "graph.svg").read_text("utf-8") == drawn.read_text("utf-8"), drawn


def test_each_block_of_the_readme_has_its_terminal_in_the_paragraph_before() -> None:
    found = blocks(README)
    assert len(found) == 9
    assert all(block.kind == "console" and block.paragraph.endswith(f"{block.title}:") for block in found)

"""Message classes by name: their stubs say what they hold, and type checkers accept what users write with them."""

from __future__ import annotations

import ast
import dataclasses
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from simkit import msgs
from simkit.msgs.message_class_stubs import stub_text
from simkit.msgs.message_types import class_names, message_type_names

ROOT = Path(__file__).resolve().parents[2]
STUBS = ROOT / "simkit" / "msgs" / "message_classes.pyi"


def test_the_stubs_match_the_definitions() -> None:
    command = "python -m simkit.msgs.message_class_stubs > simkit/msgs/message_classes.pyi"
    assert STUBS.read_text(encoding="utf-8") == stub_text(), f"write them with: {command}"


def test_every_message_type_has_one_class_name() -> None:
    assert sorted(class_names().values()) == message_type_names()
    for class_name, type_name in class_names().items():
        assert getattr(msgs, class_name) is msgs.type_of(type_name)


def test_a_stub_has_the_fields_and_constants_of_the_class() -> None:
    stubs = {n.name: n for n in ast.parse(STUBS.read_text("utf-8")).body if isinstance(n, ast.ClassDef)}
    assert set(stubs) == {*class_names(), "ServiceRequest", "ActionGoal"}  # bases for type checkers only
    for name, stub in ((name, stubs[name]) for name in class_names()):
        found = [n.target.id for n in stub.body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)]
        cls = getattr(msgs, name)
        assert [f.name for f in dataclasses.fields(cls)] == found, name
        for node in stub.body:
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value is not None:
                assert getattr(cls, node.target.id) == ast.literal_eval(node.value)


def test_a_class_is_imported_by_the_last_part_of_its_types_name() -> None:
    from simkit.msgs import LaserScan

    assert isinstance(msgs.make("sensor_msgs/msg/LaserScan"), LaserScan)
    assert msgs.type_name(LaserScan) == "sensor_msgs/msg/LaserScan"


@pytest.mark.parametrize(
    ("class_name", "type_name"),
    [
        ("Pose2D", "geometry_msgs/msg/Pose2D"),  # ROS's own before vision_msgs's
        ("vision_msgs__msg__Pose2D", "vision_msgs/msg/Pose2D"),
        ("gazebo_msgs__srv__SpawnEntity_Request", "gazebo_msgs/srv/SpawnEntity_Request"),
        ("ros_gz_interfaces__srv__SpawnEntity_Request", "ros_gz_interfaces/srv/SpawnEntity_Request"),
        ("action_msgs__msg__GoalStatus", "action_msgs/msg/GoalStatus"),
    ],
)
def test_a_shared_class_name_belongs_to_ros_and_other_types_have_full_names(class_name: str, type_name: str) -> None:
    assert class_names()[class_name] == type_name


@pytest.mark.parametrize("name", ["SpawnEntity_Request", "GoalStatus", "LaserScans", "sensor_msgs__msg__LaserScan"])
def test_a_name_without_a_class_is_an_attribute_error(name: str) -> None:
    with pytest.raises(AttributeError, match=name):
        getattr(msgs, name)


def test_a_misspelled_class_names_the_closest() -> None:
    with pytest.raises(AttributeError, match="did you mean 'LaserScan'"):
        msgs.LaserScn  # noqa: B018


def test_a_misspelled_function_does_not_load_the_type_store() -> None:
    code = "import sys, simkit.msgs as m; print(hasattr(m, 'mak'), hasattr(m, '__wrapped__'), 'rosbags' in sys.modules)"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed == "False False False\n"


def python_blocks(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text("utf-8"), flags=re.DOTALL | re.MULTILINE)


def type_check(folder: Path, scripts: dict[str, str]) -> str:
    """Return what mypy says of some scripts of a user; what it would say of simkit itself is left out."""
    for name, text in scripts.items():
        (folder / name).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", "cache", *scripts]
    environment = {**os.environ, "MYPYPATH": str(ROOT)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False).stdout


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_mypy_accepts_the_pages_code_and_finds_a_misspelled_field(tmp_path: Path) -> None:
    page = python_blocks("docs/messages_and_topics.md")  # its class of a plugin has no annotations
    blocks = [*python_blocks("README.md"), *(b for b in page if "msgs" in b and "class " not in b)]
    scripts = {f"block_{index}.py": text for index, text in enumerate(blocks)}
    assert len(scripts) >= 3
    assert type_check(tmp_path, scripts).startswith("Success")
    wrong = (
        "from simkit.msgs import LaserScan\n\n\ndef nearest(scan: LaserScan) -> float:\n    return scan.rangs.min()\n"
    )
    assert 'has no attribute "rangs"; maybe "ranges"?' in type_check(tmp_path, {"wrong.py": wrong})

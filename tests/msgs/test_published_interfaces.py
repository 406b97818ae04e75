"""The definitions that simkit ships have the fields, constants and default values of the published packages."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from published_interfaces import digest, facts, main, published_table, shipped_facts, shipped_names

from simkit import msgs
from simkit.msgs.definition_parser import PARTS
from simkit.msgs.interface_definitions import interface_text
from simkit.msgs.message_builder import builder_of
from simkit.msgs.shipped_interfaces import shipped_parts

RENAMED = {
    "dave_gazebo_ros_plugins/msg/StratifiedCurrentDatabase": "M2amp is m2_amp",
}
"""Types of ROS 1 with fields that ROS 2 does not allow, and their names in simkit."""


def test_every_shipped_definition_has_the_published_fields_constants_and_defaults() -> None:
    published = {name: found for name, (_, found) in published_table().items() if name not in RENAMED}
    assert {name: digest(shipped_facts(name)) for name in shipped_names() if name not in RENAMED} == published
    assert len(published) > 500


def test_a_field_that_is_left_out_has_its_published_default() -> None:
    found = []
    for name in shipped_names():
        for suffix, part in zip(PARTS[name.split("/")[1]], shipped_parts(name) or (), strict=True):
            message = builder_of(name + suffix).build({}) if part.defaults else None
            for field, value in part.defaults.items():
                found.append(f"{name}.{field}")
                assert np.array_equal(getattr(message, field), value), found[-1]
    assert {"geometry_msgs/msg/Quaternion.w", "simulation_interfaces/srv/StepSimulation.steps"} <= set(found)


def test_an_entity_category_has_its_published_number() -> None:
    category = msgs.EntityCategory
    numbers = {name: getattr(category, f"CATEGORY_{name}") for name in ("OBJECT", "ROBOT", "HUMAN")}
    assert numbers == {"OBJECT": 0, "ROBOT": 1, "HUMAN": 2}
    assert (category.CATEGORY_DYNAMIC_OBJECT, category.CATEGORY_STATIC_OBJECT) == (4, 5)
    assert not hasattr(category, "CATEGORY_UNKNOWN")


def test_a_shown_definition_has_its_defaults() -> None:
    assert "float64 w 1.0" in interface_text("geometry_msgs/msg/Quaternion").split("\n")
    assert "int8 status -2" in interface_text("sensor_msgs/msg/NavSatStatus").split("\n")
    assert "\tbool read_only false" in interface_text("rcl_interfaces/srv/DescribeParameters").split("\n")


# ---------------------------------------------------------------------- the program that compares


def package(folder: Path, category: str) -> Path:
    (folder / "msg").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>simulation_interfaces</name><version>9.9.9</version></package>")
    (folder / "msg" / "EntityCategory.msg").write_text(category)
    return folder


CATEGORY = """uint8 CATEGORY_OBJECT = 0  # a comment
uint8 CATEGORY_ROBOT = 1
uint8 CATEGORY_HUMAN = 2

uint8 CATEGORY_DYNAMIC_OBJECT = 4
uint8 CATEGORY_STATIC_OBJECT=5
uint8 category"""


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("", "", 0),
        ("HUMAN = 2", "HUMAN = 3", 1),
        ("uint8 category", "uint8 category 1", 1),
        ("uint8 category", "int8 category", 1),
        ("uint8 CATEGORY_ROBOT = 1\n", "", 1),
    ],
)
def test_the_program_finds_a_difference(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], old: str, new: str, code: int
) -> None:
    changed = CATEGORY.replace(old, new) if old else CATEGORY
    monkeypatch.setattr(sys, "argv", ["published_interfaces.py", str(package(tmp_path / "one", changed))])
    assert main() == code
    printed = capsys.readouterr().out
    assert f"{code} of 1 types differ" in printed
    assert ("simulation_interfaces/msg/EntityCategory differs from version 9.9.9" in printed) == bool(code)


def test_facts_have_one_spelling() -> None:
    goal = 'Header header  # c\nfloat32[2] pair [1, 2.5]\nstring NAME="a b"\nbool flag True\n'
    assert facts("my_msgs/srv/Test", goal + "---\nNum[<=3] many\nbyte B=0x10\n").split("\n") == [
        "string NAME='a b'",
        "std_msgs/msg/Header header",
        "float32[2] pair [1.0, 2.5]",
        "bool flag True",
        "---",
        "byte B=16",
        "my_msgs/msg/Num[<=3] many",
    ]

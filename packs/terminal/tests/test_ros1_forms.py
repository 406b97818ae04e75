"""Command lines in the forms of ROS 1: `rostopic pub`, `rosservice call` and `rosparam`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from simkit.errors import InputError
from simkit_terminal.cli.terminal.positional_values import read_fields

TWIST = "geometry_msgs/msg/Twist"


def test_a_value_for_each_field_is_a_message() -> None:
    assert read_fields("std_msgs/msg/String", ["hello"], "the message") == {"data": "hello"}
    assert read_fields("std_msgs/msg/String", ["15"], "the message") == {"data": "15"}  # a text field has the word
    assert read_fields(TWIST, ["[2.0, 0.0, 0.0]", "[0.0, 0.0, 1.8]"], "the message") == {
        "linear": {"x": 2.0, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": 1.8},
    }
    assert read_fields(TWIST, ["{linear: {x: 1.0}}"], "the message") == {"linear": {"x": 1.0}}
    assert read_fields(TWIST, [], "the message") == {}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["hello"], "expected a mapping of fields"),
        (["[1, 2, 3]"] * 3, "found 3 values; geometry_msgs/msg/Twist has 2 fields: linear, angular"),
        (["[1, 2]", "[1, 2, 3]"], "found 2 values; its field linear has 3 fields: x, y, z"),
        (["[1, 2", "[1, 2, 3]"], "is not YAML"),
    ],
)
def test_values_that_are_not_those_of_the_fields_are_refused(words: list[str], told: str) -> None:
    with pytest.raises(InputError, match="SK-CLI-031") as error:
        read_fields(TWIST, words, "the message")
    assert told in str(error.value)


def test_topics_and_services_take_values_without_names(yard: Any, simkit_line: Any) -> None:
    told = simkit_line("topic", "pub", "-1", "-w", "0", "/chatter", "std_msgs/String", "hello").stdout
    assert "publishing #1: std_msgs.msg.String(data='hello')" in told
    assert "SetBool_Request(data=True)" in simkit_line("service", "call", "/lamp", "true").stdout
    assert simkit_line("service", "args", "/lamp").stdout == "data\n"
    assert json.loads(simkit_line("service", "args", "/lamp", "--json").stdout) == ["data"]


def test_services_of_a_node_are_listed(yard: Any, simkit_line: Any) -> None:
    listed = simkit_line("service", "list", "--node", "/Tuner").stdout.split()
    assert "/Tuner/get_parameters" in listed and "/apply_joint_effort" not in listed
    assert "SK-CLI-034" in simkit_line("service", "list", "--node", "/Turner").stderr


def test_global_names_reach_the_parameters_of_nodes_and_the_parameter_server(
    start: Any, simkit_line: Any, tmp_path: Path
) -> None:
    live = start()
    assert simkit_line("param", "get", "/Tuner/p_gain").stdout == "2.0\n"
    assert simkit_line("param", "set", "/p_gain", "2.5").stdout == "Set parameter successful\n"
    assert simkit_line("param", "get", "/Tuner", "p_gain").stdout == "Double value is: 2.5\n"
    refused = simkit_line("param", "set", "/Tuner/p_gain", "-1000")
    assert refused.exit_code == 2 and "Setting parameter failed: " in refused.stderr
    assert json.loads(simkit_line("param", "get", "/", "--json").stdout)["Tuner"]["p_gain"] == 2.5
    file = tmp_path / "gains.yaml"
    file.write_text("Tuner: {p_gain: 3.0}\n", encoding="utf-8")
    assert "successful" in simkit_line("param", "load", str(file), "copy").stdout
    assert simkit_line("param", "get", "/copy").stdout == "Tuner:\n  p_gain: 3.0\n"
    assert live.sim.ros1_parameters().get("/copy/Tuner/p_gain") == 3.0
    assert simkit_line("param", "get", "/p_gain").stdout == "2.5\n"  # a copy in a namespace changes no node
    assert simkit_line("param", "load", str(file)).exit_code == 0
    assert simkit_line("param", "get", "/p_gain").stdout == "3.0\n"
    assert simkit_line("param", "delete", "/copy").stdout == "Deleted parameter successfully\n"
    assert "SK-CLI-034" in simkit_line("param", "get", "/copy").stderr
    assert "is declared by /Tuner" in simkit_line("param", "delete", "/Tuner/p_gain").stderr

"""`simkit service`, `simkit param` and `simkit action` on a running simulation, as ROS 2's commands print them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml


def test_services_are_listed_found_and_typed(yard: Any, simkit_line: Any) -> None:
    assert "/lamp\n" in simkit_line("service", "list").stdout
    assert "/lamp [std_srvs/srv/SetBool]\n" in simkit_line("service", "list", "-t").stdout
    assert simkit_line("service", "type", "/lamp").stdout == "std_srvs/srv/SetBool\n"
    assert "/lamp" in simkit_line("service", "find", "std_srvs/srv/SetBool").stdout.split()
    told = "Type: std_srvs/srv/SetBool\nClients count: 0\nServices count: 1\n"
    assert simkit_line("service", "info", "/lamp").stdout == told


def test_a_call_prints_request_and_response(yard: Any, simkit_line: Any) -> None:
    result = simkit_line("service", "call", "/lamp", "std_srvs/srv/SetBool", "{data: true}")
    assert result.stdout == (
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='lit')\n\n"
    )
    assert json.loads(simkit_line("service", "call", "/lamp", "{data: true}", "--json").stdout)["success"] is True
    assert json.loads(simkit_line("service", "call", "/lamp", "--stdin", "--json", stdin="data: true").stdout)[
        "success"
    ]


def test_gazebos_services_can_be_called(start: Any, simkit_line: Any) -> None:
    live = start()
    simkit_line("service", "call", "/pause_physics", "std_srvs/srv/Empty")
    assert live.sim.paused
    request = "{world_control: {pause: false}}"
    answer = simkit_line("service", "call", "/world/yard/control", "ros_gz_interfaces/srv/ControlWorld", request)
    assert "ControlWorld_Response(success=True)" in answer.stdout
    assert not live.sim.paused


def test_parameters_are_listed_read_and_described(yard: Any, simkit_line: Any) -> None:
    assert (
        simkit_line("param", "list").stdout
        == "/Tuner:\n  count\n  frame.offset\n  mode\n  on\n  p_gain\n  use_sim_time\n"
    )
    typed = simkit_line("param", "list", "/Tuner", "--param-type", "--filter", "^p_").stdout
    assert typed == "  p_gain (type: double)\n"
    for name, text in (
        ("p_gain", "Double value is: 2.0\n"),
        ("count", "Integer value is: 3\n"),
        ("mode", "String value is: fast\n"),
        ("on", "Boolean value is: True\n"),
        ("frame.offset", "Double values are: array('d', [0.0, 0.5])\n"),
    ):
        assert simkit_line("param", "get", "/Tuner", name).stdout == text
    assert simkit_line("param", "get", "/Tuner", "mode", "--hide-type").stdout == "fast\n"
    assert simkit_line("param", "describe", "/Tuner", "p_gain").stdout == (
        "Parameter name: p_gain\n  Type: double\n  Description: gain [N·m/rad]\n  Constraints:\n"
        "    Min value: 0.0\n    Max value: 100.0\n    Additional constraints: a number from 0 to 100\n"
    )


def test_parameters_are_set_dumped_and_loaded(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    live = start(paused=True)
    assert simkit_line("param", "set", "/Tuner", "p_gain", "12.5").stdout == "Set parameter successful\n"
    assert live.sim.communication.parameters["/Tuner"]["p_gain"].value == 12.5
    several = simkit_line("param", "set", "/Tuner", "frame.offset", "[1.0, -2.0]", "mode", "slow")
    assert several.stdout == "frame.offset: Set parameter successful\nmode: Set parameter successful\n"
    refused = simkit_line("param", "set", "Tuner", "p_gain", "-1.0")
    assert refused.exit_code == 2
    assert refused.stderr.startswith("Setting parameter failed: ") and "from 0 to 100" in refused.stderr
    text = simkit_line("param", "dump", "/Tuner").stdout
    expected = {"count": 3, "frame": {"offset": [1.0, -2.0]}, "mode": "slow", "on": True, "p_gain": 12.5}
    expected["use_sim_time"] = True
    assert yaml.safe_load(text) == {"/Tuner": {"ros__parameters": expected}}
    file = tmp_path / "tuner.yaml"
    file.write_text(text.replace("12.5", "7.0"), encoding="utf-8")
    loaded = simkit_line("param", "load", "/Tuner", str(file))
    assert "Set parameter p_gain successful\n" in loaded.stdout and loaded.exit_code == 0
    assert live.sim.communication.parameters["/Tuner"]["p_gain"].value == 7.0
    together = simkit_line("param", "set", "/Tuner", "count", "9", "p_gain", "1000.0", "--atomic")
    assert together.exit_code == 2 and live.sim.communication.parameters["/Tuner"]["count"].value == 3


def test_actions_are_listed_and_described(yard: Any, simkit_line: Any) -> None:
    listed = simkit_line("action", "list", "-t").stdout.splitlines()
    steps = "/simulate_steps [simulation_interfaces/action/SimulateSteps]"
    assert listed == ["/countdown [example_interfaces/action/Fibonacci]", steps]
    told = simkit_line("action", "info", "/countdown", "-t").stdout
    assert told.startswith("Action: /countdown\nAction clients: 0\nAction servers: 1\n    /")
    assert told.endswith(" [example_interfaces/action/Fibonacci]\n")


def test_a_goal_gives_feedback_and_a_result(yard: Any, simkit_line: Any) -> None:
    words = ("action", "send_goal", "/countdown", "example_interfaces/action/Fibonacci", "{order: 2}", "--feedback")
    lines = simkit_line(*words).stdout
    head, _, rest = lines.partition("Goal accepted with ID: ")
    assert head == "Waiting for an action server to become available...\nSending goal:\n     order: 2\n\n"
    assert rest[32:] == (
        "\n\nFeedback:\n    sequence:\n- 1\n\nFeedback:\n    sequence:\n- 0\n\n"
        "Result:\n    sequence:\n- 0\n\nGoal finished with status: SUCCEEDED\n"
    )
    found = json.loads(simkit_line("action", "send", "/countdown", "{order: 1}", "--json").stdout)
    assert found == {"status": "SUCCEEDED", "reason": "", "result": {"sequence": [0]}}


def test_a_rejected_or_cancelled_goal_is_reported(yard: Any, simkit_line: Any) -> None:
    refused = simkit_line("action", "send_goal", "/countdown", "{order: 0}")
    assert refused.stdout.endswith("Goal was rejected: nothing to count\n")
    off = simkit_line("action", "send_goal", "/countdown", "{order: 1000000}", "--timeout", "0.2").stdout
    assert "Canceling goal...\nGoal canceled.\n" in off and off.endswith("Goal finished with status: CANCELED\n")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "code", "hint"),
    [
        (("service", "call", "/lmp"), "SK-CLI-037", "did you mean '/lamp'?"),
        (("service", "call", "/lamp", "std_srvs/srv/Empty"), "SK-CLI-032", "std_srvs/srv/SetBool"),
        (("service", "call", "/lamp", "std_srvs/srv/SetBool", "{date: true}"), "SK-CLI-031", "'data'"),
        (("action", "send_goal", "/countdwn", "{}"), "SK-CLI-037", "'/countdown'"),
        (("param", "get", "/Tner", "p_gain"), "SK-CLI-034", "'/Tuner'"),
        (("param", "get", "/Tuner", "p_gan"), "SK-CLI-034", "'p_gain'"),
        (("param", "set", "/Tuner", "p_gain"), "SK-CLI-031", "pairs"),
        (("param", "load", "/Tuner", "no_such.yaml"), "SK-CLI-041", "cannot be read"),
        (("service", "call", "/lamp", "{data: 2024-13-45}"), "SK-CLI-031", "a value does not fit its type"),
        (("service", "call", "/lamp", "&a {data: *a}"), "SK-CLI-031", "nested too deep"),
        (("action", "send_goal", "/countdown", "{order: !!int no}"), "SK-CLI-031", "is not YAML"),
        (("service", "call", "/lamp", "[" * 5000), "SK-CLI-031", "nested too deep"),
    ],
)
def test_an_error_gives_its_remedy(words: tuple[str, ...], code: str, hint: str, yard: Any, simkit_line: Any) -> None:
    result = simkit_line(*words)
    assert result.exit_code == 2
    assert code in result.stderr and hint in result.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    "text", ["/Tuner: {ros__parameters: {p_gain: 2024-13-45}}", "/Tuner: {ros__parameters: &a {x: *a}}", "[" * 3000]
)
def test_an_invalid_parameter_file_is_reported(text: str, yard: Any, simkit_line: Any, tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text(text)
    told = simkit_line("param", "load", "/Tuner", str(tmp_path / "p.yaml"))
    assert told.exit_code == 2 and "SK-CLI-041" in told.stderr and "is not YAML" in told.stderr


@pytest.mark.slow
@pytest.mark.parametrize("text", ["2024-13-45", "!!bool foo", "9" * 5000, "[" * 3000])
def test_a_value_that_is_no_yaml_is_a_text_and_refused(text: str, yard: Any, simkit_line: Any) -> None:
    told = simkit_line("param", "set", "/Tuner", "p_gain", text)
    assert told.exit_code == 2 and "Setting parameter failed" in told.stderr


def test_a_goal_may_be_waited_for_for_ever(yard: Any, simkit_line: Any) -> None:
    found = simkit_line("action", "send", "/countdown", "{order: 1}", "--timeout", "inf", "--json")
    assert json.loads(found.stdout)["status"] == "SUCCEEDED"


@pytest.mark.slow
def test_a_message_that_is_too_large_is_reported(yard: Any, simkit_line: Any) -> None:
    values = '{data: "' + "x" * (17 << 20) + '"}'
    told = simkit_line("topic", "pub", "--once", "-w", "0", "/big", "std_msgs/msg/String", values)
    assert told.exit_code == 2 and "is too large to send; the limit is 16777216" in told.stderr

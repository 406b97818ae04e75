"""`simkit topic` on a running simulation: what `ros2 topic` prints, by the simulation's clock."""

from __future__ import annotations

import itertools
import json
import re
from typing import Any

import pytest
import yaml


def test_the_list_is_plain_with_types_counted_and_with_its_ends(yard: Any, simkit_line: Any) -> None:
    assert {"/cmd_vel", "/imu", "/joint_states", "/odom", "/tf"} <= set(simkit_line("topic", "list").stdout.split())
    assert "/imu [sensor_msgs/msg/Imu]\n" in simkit_line("topic", "list", "-t").stdout
    assert int(simkit_line("topic", "list", "-c").stdout) == len(simkit_line("topic", "list").stdout.split())
    verbose = simkit_line("topic", "list", "-v").stdout
    published, _, subscribed = verbose.partition("Subscribed topics:\n")
    assert published.startswith("Published topics:\n")
    assert " * /odom [nav_msgs/msg/Odometry] 1 publisher\n" in published
    assert " * /cmd_vel [geometry_msgs/msg/Twist] 1 subscriber\n" in subscribed
    rows = {row["name"]: row for row in json.loads(simkit_line("topic", "list", "-v", "--json").stdout)}
    assert rows["/odom"]["publishers"][0]["node"]


def test_info_type_and_find(yard: Any, simkit_line: Any) -> None:
    told = simkit_line("topic", "info", "/odom").stdout
    assert told == "Type: nav_msgs/msg/Odometry\nPublisher count: 1\nSubscription count: 0\n"
    verbose = simkit_line("topic", "info", "/odom", "-v").stdout
    assert re.search(
        r"^Type: nav_msgs/msg/Odometry\n\nPublisher count: 1\n\nNode name: \w+\nNode namespace: /\w*\n"
        r"Topic type: nav_msgs/msg/Odometry\nTopic type hash: RIHS01_[0-9a-f]{64}\nEndpoint type: PUBLISHER\n"
        r"GID: ([0-9a-f]{2}\.){15}[0-9a-f]{2}\nQoS profile:\n  Reliability: RELIABLE\n"
        r"  History \(Depth\): KEEP_LAST \(10\)\n  Durability: VOLATILE\n  Lifespan: Infinite\n  Deadline: Infinite\n"
        r"  Liveliness: AUTOMATIC\n  Liveliness lease duration: Infinite\n\nSubscription count: 0\n\n$",
        verbose,
    )
    assert simkit_line("topic", "type", "imu").stdout == "sensor_msgs/msg/Imu\n"
    assert simkit_line("topic", "find", "geometry_msgs/Twist").stdout == "/cmd_vel\n"
    assert simkit_line("topic", "find", "geometry_msgs/msg/TwistStamped").stdout == "/cmd_vel\n"


def test_echo_prints_yaml_between_dashes(yard: Any, simkit_line: Any) -> None:
    text = simkit_line("topic", "echo", "/joint_states", "--once").stdout
    assert text.endswith("\n---\n")
    message = yaml.safe_load(text.removesuffix("---\n"))
    assert list(message) == ["header", "name", "position", "velocity", "effort"]
    assert message["name"] == ["left_wheel", "right_wheel"]
    line = simkit_line("topic", "echo", "/joint_states", "--once", "--flow-style").stdout
    assert line.startswith("{header: {stamp: {sec: ") and line.count("\n") == 2


def test_echo_shows_a_part_alone(yard: Any, simkit_line: Any) -> None:
    assert re.fullmatch(
        r"array\('d', \[\S+, \S+\]\)\n---\n",
        simkit_line("topic", "echo", "/joint_states", "--once", "--field", "position").stdout,
    )
    assert simkit_line("topic", "echo", "/joint_states", "--once", "--field", "name[1]").stdout == "right_wheel\n---\n"
    place = simkit_line("topic", "echo", "/odom", "--once", "--field", "pose.pose.position").stdout
    assert list(yaml.safe_load(place.removesuffix("---\n"))) == ["x", "y", "z"]
    wrong = simkit_line("topic", "echo", "/odom", "--once", "--field", "pose.pos")
    assert wrong.exit_code == 2 and "SK-CLI-033" in wrong.stderr and "did you mean 'pose'?" in wrong.stderr


def test_echo_shortens_leaves_out_and_counts(yard: Any, simkit_line: Any) -> None:
    short = yaml.safe_load(simkit_line("topic", "echo", "/odom", "--once", "-l", "2").stdout.removesuffix("---\n"))
    assert short["pose"]["covariance"][2:] == ["..."]
    assert short["header"]["frame_id"] == "od..."
    none = simkit_line("topic", "echo", "/imu", "--once", "--no-arr", "--no-str").stdout
    assert "orientation_covariance: '<array type: float64[9]>'\n" in none
    assert "frame_id: '<string length: <16>>'\n" in none
    row = simkit_line("topic", "echo", "/joint_states", "--once", "--csv").stdout
    assert re.fullmatch(r"\d+,\d+,[^,]*,left_wheel,right_wheel(,[-+.e\d]+){6}\n", row)
    assert (
        len(json.loads(simkit_line("topic", "echo", "/imu", "--once", "--json").stdout)["orientation_covariance"]) == 9
    )


def test_echo_prints_only_messages_that_match_the_filter(yard: Any, simkit_line: Any) -> None:
    found = simkit_line("topic", "echo", "/imu", "--once", "--field", "header.stamp.sec", "--filter", "m >= 1").stdout
    assert int(found.split()[0]) >= 1
    wrong = simkit_line("topic", "echo", "/imu", "--once", "--filter", "m.nothing > 1")
    assert wrong.exit_code == 2 and "SK-CLI-033" in wrong.stderr


@pytest.mark.slow
def test_rates_are_those_of_the_simulations_clock(yard: Any, simkit_line: Any) -> None:
    """An IMU of 50 Hz has 50 Hz, however fast the simulation runs."""

    def measured(*words: str, holds: str) -> str:
        # The duration is one of wall time: on a busy machine the simulation needs a longer one for some messages.
        for duration in ("0.4", "2", "10", "30"):
            told = simkit_line("topic", *words, "--duration", duration).stdout
            if re.search(holds, told, re.MULTILINE):
                return told
        raise AssertionError(told)

    measured(
        "hz",
        "/imu",
        holds=r"^average rate: 50\.000\n\tmin: 0\.020s max: 0\.020s std dev: 0\.00000s window: \d+$",
    )
    found = json.loads(measured("hz", "/imu", "-w", "10", "--json", holds=r'"window": 10\b'))
    assert found["rate"] == pytest.approx(50.0) and found["window"] == 10
    size = r"\tMessage size mean: 0\.\d\d KB min: 0\.\d\d KB max: 0\.\d\d KB\n$"
    told = measured("bw", "/imu", holds=r"KB/s from \d+ messages\n" + size)
    assert told.startswith("Subscribed to [/imu]\n")
    assert json.loads(measured("delay", "/imu", "--json", holds=r'"max"'))["max"] == 0.0


def test_a_message_that_is_published_drives_the_robot(start: Any, simkit_line: Any) -> None:
    live = start()
    result = simkit_line("topic", "pub", "--once", "/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 0.5}}")
    assert result.stdout == (
        "publisher: beginning loop\n"
        "publishing #1: geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=0.5, y=0.0, z=0.0), "
        "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0))\n\n"
    )
    simkit_line("topic", "echo", "/odom", "--once", "--filter", "m.header.stamp.sec >= 3")
    simkit_line("service", "call", "/pause_physics")
    assert live.sim.model("rover").pose.position[0] > 0.01


def test_several_go_out_at_a_rate_of_simulated_time(yard: Any, simkit_line: Any) -> None:
    words = ("topic", "pub", "-t", "4", "-r", "5", "--keep-alive", "0", "--json", "/cmd_vel")
    sent = simkit_line(*words, "geometry_msgs/msg/TwistStamped", "{header: auto, twist: {linear: {x: 0.1}}}").stdout
    stamps = [m["header"]["stamp"] for m in map(json.loads, sent.splitlines())]
    times = [s["sec"] + s["nanosec"] * 1e-9 for s in stamps]
    assert len(times) == 4
    gaps = [b - a for a, b in itertools.pairwise(times)]
    assert min(gaps) > 0.0  # a simulation that outruns the terminal makes them wider, never closer than it can see
    assert times[-1] - times[0] >= 3 * 0.2 - 0.2


@pytest.mark.parametrize(
    ("words", "code", "hint"),
    [
        (("echo", "/odm"), "SK-CLI-030", "did you mean '/odom'?"),
        (("info", "/nothing_like_it"), "SK-CLI-030", "in the simulation 'yard'"),
        (("pub", "-1", "/cmd_vel", "geometry_msgs/msg/Twist", "{liner: {x: 1}}"), "SK-CLI-031", "'linear'"),
        (("pub", "-1", "/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: }"), "SK-CLI-031", "is not YAML"),
        (("pub", "-1", "/cmd_vel", "geometry_msgs/msg/Twist", "[1]"), "SK-CLI-031", "a mapping"),
        (("pub", "-1", "/cmd_vel", "geometry_msgs/msg/Twst", "{}"), "SK-CLI-032", "geometry_msgs/msg/Twist"),
        (("hz", "/imu", "--filter", "m >"), "SK-CLI-033", "is not a Python expression"),
        (("pub", "-1", "-t", "3", "/cmd_vel", "{}"), "SK-CLI-018", "one of them"),
    ],
)
def test_an_error_gives_its_remedy(words: tuple[str, ...], code: str, hint: str, yard: Any, simkit_line: Any) -> None:
    result = simkit_line("topic", *words)
    assert result.exit_code == 2
    assert code in result.stderr and hint in result.stderr
    assert "Traceback" not in result.stderr


def test_network_options_of_ros_2_are_accepted_and_ignored(yard: Any, simkit_line: Any) -> None:
    words = ("--qos-reliability", "best_effort", "--qos-profile=sensor_data", "--no-daemon", "--spin-time", "2")
    assert simkit_line("topic", "echo", "/imu", "--once", *words, "--field", "header.stamp.sec").exit_code == 0


def test_two_simulations_are_distinguished_by_name(
    start: Any, simkit_line: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    start("yard", paused=True)
    start("field", paused=True)
    result = simkit_line("topic", "list")
    assert result.exit_code == 2 and "SK-LIVE-002" in result.stderr and "field" in result.stderr
    assert simkit_line("topic", "list", "--sim", "field").exit_code == 0
    monkeypatch.setenv("SIMKIT_SIM", "yard")
    assert simkit_line("topic", "list").exit_code == 0


def test_without_a_simulation_the_command_says_how_to_start_one(place: Any, simkit_line: Any) -> None:
    result = simkit_line("topic", "list")
    assert result.exit_code == 2 and "SK-LIVE-001" in result.stderr and "simkit run" in result.stderr


@pytest.mark.parametrize("name", ["", "/", "//", "/a//b", "/a/", "/ä", "~/x", "/{ns}", "/a b"])
def test_an_invalid_topic_name_is_rejected(name: str, yard: Any, simkit_line: Any) -> None:
    told = simkit_line("topic", "pub", "--once", "-w", "0", "--", name, "std_msgs/msg/Empty", "{}")
    assert told.exit_code == 2 and "is not a topic name" in told.stderr


def test_infinite_times_are_accepted(yard: Any, simkit_line: Any) -> None:
    assert simkit_line("topic", "echo", "--once", "/odom", "--timeout", "1e400").exit_code == 0
    assert simkit_line("topic", "hz", "/odom", "--window", "9" * 20).exit_code == 2


def test_numbers_with_an_exponent_are_numbers_as_in_ros(yard: Any, simkit_line: Any) -> None:
    sent = simkit_line("topic", "pub", "--once", "/cmd_vel", "{linear: {x: 0e-3, y: 1e-3}}").stdout
    assert "Vector3(x=0.0, y=0.001, z=0.0)" in sent


def test_raw_bytes_are_json_too(yard: Any, simkit_line: Any) -> None:
    found = json.loads(simkit_line("topic", "echo", "--once", "/odom", "--raw", "--json").stdout)
    assert found[:4] == [0, 1, 0, 0]


@pytest.mark.slow
def test_an_unknown_frame_has_no_pose_in_itself(yard: Any, simkit_line: Any) -> None:
    told = simkit_line("tf", "echo", "nobody", "nobody", "--once")
    assert told.exit_code == 2 and "SK-CLI-038" in told.stderr

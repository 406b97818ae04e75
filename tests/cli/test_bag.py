"""`simkit bag`, and the commands that read one instead of a simulation."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli.commands import app
from simkit.recording.bags.recorder import Recorder


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory, yard_world: str) -> Path:
    path = tmp_path_factory.mktemp("bags") / "drive.mcap"
    with simkit.load(yard_world) as sim, Recorder(sim, path):
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(1.0)
    return path


def test_topics_of_a_bag_are_read_as_those_of_a_simulation(bag: Path, simkit_line: Any) -> None:
    at = ("--bag", str(bag))
    assert "/odom [nav_msgs/msg/Odometry]\n" in simkit_line("topic", "list", "-t", *at).stdout
    told = "Type: nav_msgs/msg/Odometry\nPublisher count: 1\nSubscription count: 0\n"
    assert simkit_line("topic", "info", "/odom", *at).stdout == told
    rows = simkit_line("topic", "echo", "/imu", "--field", "header.stamp", "--json", *at).stdout.splitlines()
    assert len(rows) == 51 and json.loads(rows[-1]) == {"sec": 1, "nanosec": 0}
    rate = json.loads(simkit_line("topic", "hz", "/imu", "--json", *at).stdout)
    assert rate["rate"] == pytest.approx(50.0, abs=0.2) and rate["window"] == 50
    assert simkit_line("topic", "bw", "/imu", *at).stdout.count("from 51 messages") == 1
    assert simkit_line("topic", "find", "sensor_msgs/msg/Imu", *at).stdout == "/imu\n"
    assert simkit_line("tf", "tree", *at).stdout.startswith("odom\n  base\n")
    place = json.loads(simkit_line("tf", "echo", "odom", "base", "--json", *at).stdout)
    assert place["translation"][0] == pytest.approx(0.5, abs=0.06)
    shown = simkit_line("interface", "show", "std_msgs/msg/Header", *at).stdout
    assert shown.startswith("builtin_interfaces/Time stamp\n\tint32 sec\n")
    assert "SK-CLI-030" in simkit_line("topic", "echo", "/odm", *at).stderr
    assert "SK-CLI-018" in simkit_line("topic", "list", "--sim", "x", *at).stderr


def test_info_describes_a_bag(bag: Path, simkit_line: Any) -> None:
    assert simkit_line("bag", "info", str(bag)).stdout.startswith("\nFiles:             drive.mcap\nBag size: ")
    assert "/odom" in simkit_line("bag", "info", str(bag), "--topic-name").stdout.split()
    assert json.loads(simkit_line("bag", "info", str(bag), "--json").stdout)["complete"] is True
    missing = simkit_line("bag", "info", "no_such.mcap")
    assert missing.exit_code == 2 and "SK-CLI-035" in missing.stderr


def test_a_running_simulation_is_recorded(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    start()
    target = tmp_path / "rec"
    found = simkit_line("bag", "record", "/odom", "/imu", "/cmd_vel", "-o", str(target), "--duration", "0.5")
    assert found.exit_code == 0
    assert "[INFO] [rosbag2_recorder]: Subscribed to topic '/imu'" in found.stderr
    summary = json.loads(simkit_line("bag", "info", str(target), "--json").stdout)
    counts = {t["name"]: t["count"] for t in summary["topics"]}
    assert counts["/imu"] in (25, 26) and counts["/cmd_vel"] == 0
    again = simkit_line("bag", "record", "-a", "-o", str(target), "--duration", "0.1")
    assert again.exit_code == 2 and "SK-BAG-001" in again.stderr
    assert "SK-CLI-018" in simkit_line("bag", "record", "-o", str(tmp_path / "x")).stderr


def test_a_rate_limit_thins_the_messages_of_each_topic(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    start()
    target = tmp_path / "thin.mcap"
    limits = ("--max-rate", "10", "--duration", "1.0")
    assert simkit_line("bag", "record", "/odom", "/imu", "-o", str(target), *limits).exit_code == 0
    summary = json.loads(simkit_line("bag", "info", str(target), "--json").stdout)
    assert all(topic["count"] in (10, 11) for topic in summary["topics"])


def test_two_bags_are_played_on_one_timeline(
    bag: Path, start: Any, simkit_line: Any, tmp_path: Path, yard_world: str
) -> None:
    lamps = tmp_path / "second.mcap"
    with simkit.load(yard_world) as sim, Recorder(sim, lamps):
        sim.publish("/cmd_vel", {"linear": {"x": 0.25}})
        sim.run(0.2)
    start()
    played = json.loads(simkit_line("bag", "play", str(bag), str(lamps), "--topics", "/cmd_vel", "--json").stdout)
    assert played == {"messages": 2, "topics": ["/cmd_vel"]}
    played = json.loads(simkit_line("bag", "play", str(bag), "--all", "-r", "20", "--json").stdout)
    assert {"/cmd_vel", "/imu", "/odom"} <= set(played["topics"])


def test_a_recording_loses_large_messages_only_and_says_which(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    sim = start(paused=True).sim
    camera = sim.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    counter = sim.advertise("/count", "std_msgs/msg/Int32")
    burst = iter([{"data": bytes(4 << 20)}])

    def publish(_: Any) -> None:
        for message in burst if camera.subscribers and counter.subscribers else ():
            for value in range(60):
                camera.publish(message)
                counter.publish({"data": value})

    sim.subscribe("/imu", publish)
    sim.paused = False
    target = tmp_path / "rec.mcap"
    found = simkit_line("bag", "record", "/picture", "/count", "/imu", "-o", str(target), "--duration", "0.5", "--json")
    summary = json.loads(found.stdout)
    counts = {
        t["name"]: t["count"] for t in json.loads(simkit_line("bag", "info", str(target), "--json").stdout)["topics"]
    }
    assert counts["/count"] == 60
    assert summary["lost_by_topic"] == {"/picture": 60 - counts["/picture"]}
    assert summary["lost"] == 60 - counts["/picture"] and 7 <= counts["/picture"] < 60


def test_the_commands_of_a_bag_drive_the_robot_again(bag: Path, start: Any, simkit_line: Any) -> None:
    live = start(paused=True)
    before = float(live.sim.model("rover").pose.position[0])  # only a paused simulation can be read by this thread
    live.sim.paused = False
    played = simkit_line("bag", "play", str(bag), "--json")
    assert json.loads(played.stdout) == {"messages": 1, "topics": ["/cmd_vel"]}
    simkit_line("topic", "echo", "/odom", "--once", "--filter", "m.header.stamp.sec >= 3")
    simkit_line("service", "call", "/pause_physics")
    assert float(live.sim.model("rover").pose.position[0]) > before + 0.01
    assert "SK-CLI-018" in simkit_line("bag", "play", str(bag), "--remap", "x").stderr
    assert "SK-CLI-030" in simkit_line("bag", "play", str(bag), "--topics", "/cmd_vl").stderr


@pytest.mark.skipif(os.name == "nt", reason="no such signals there")
def test_an_interrupt_ends_a_recording_that_is_whole(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    start()
    target = tmp_path / "rec.mcap"
    words = ["bag", "record", "-a", "-x", "camera", "-o", str(target), "--sim", "yard"]
    main = "from simkit.cli import main; main()"
    with subprocess.Popen([sys.executable, "-c", main, *words], stderr=subprocess.PIPE, text=True) as running:
        assert running.stderr is not None
        while "/odom" not in running.stderr.readline():
            pass
        simkit_line("topic", "echo", "/odom", "--once", "--filter", "m.header.stamp.sec >= 2")
        running.send_signal(signal.SIGINT)
        _, told = running.communicate(timeout=20)
    assert running.returncode == 130 and "messages on" in told
    summary = json.loads(simkit_line("bag", "info", str(target), "--json").stdout)
    assert summary["complete"] and {t["name"]: t["count"] for t in summary["topics"]}["/odom"] > 0


def test_a_recording_of_nothing_ends_too(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    start()
    target = tmp_path / "none.mcap"
    found = simkit_line("bag", "record", "/nobody", "-o", str(target), "--duration", "0.2")
    assert found.exit_code == 0 and "0 messages on 0 topics" in found.stderr


def test_a_bag_of_nothing_ends_however_often_it_is_played(bag: Path, start: Any, simkit_line: Any) -> None:
    start()
    words = ("bag", "play", str(bag), "--topics", "/cmd_vel", "--loop", "--start-offset", "100", "--json")
    assert json.loads(simkit_line(*words).stdout)["messages"] == 0


def test_an_invalid_file_name_is_reported(bag: Path, start: Any, simkit_line: Any) -> None:
    start()
    long = "x" * 300
    told = simkit_line("bag", "record", "/odom", "-o", long)
    assert told.exit_code == 2 and "SK-BAG-002" in told.stderr
    told = simkit_line("topic", "list", "--bag", f"{long}.mcap")
    assert told.exit_code == 2 and "SK-CLI-035" in told.stderr


def test_a_recording_of_a_simulation_that_ends_is_whole(start: Any, simkit_line: Any, tmp_path: Path) -> None:
    live = start()
    target = tmp_path / "rec.mcap"
    live.steps_heard = 500
    found = simkit_line("bag", "record", "-a", "-x", "camera", "-o", str(target))
    assert found.exit_code == 0 and "has ended" in found.stderr and "messages on" in found.stderr
    assert json.loads(simkit_line("bag", "info", str(target), "--json").stdout)["complete"]


def test_a_selected_topic_that_the_run_does_not_have_is_a_warning(tmp_path: Path) -> None:
    topics = ["--topic", "/clok", "--topic", "/cl*"]
    recording = ["--record", str(tmp_path / "x.mcap"), *topics]
    found = CliRunner().invoke(app, ["run", "empty", "--duration", "0.1", "--json", *recording])
    report = json.loads(found.stdout)
    assert (found.exit_code, report["recording"]["messages"]) == (0, 10)
    (warning,) = [d for d in report["diagnostics"] if d["severity"] == "warning"]
    assert warning["code"] == "SK-BAG-017" and "'/clok'" in warning["message"]

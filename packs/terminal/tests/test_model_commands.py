"""`simkit model`, `simkit tf`, `simkit node` and `simkit interface`."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml


def test_models_have_poses_and_joints(start: Any, simkit_line: Any) -> None:
    live = start(paused=True)
    assert simkit_line("model", "list").stdout == "ground\nrover\n"
    rover = live.sim.model("rover")
    x, y, z = (f"{v + 0.0:.6f}" for v in rover.pose.position)
    assert simkit_line("model", "pose", "rover").stdout.startswith(f"xyz {x} {y} {z} rpy ")
    link = json.loads(simkit_line("model", "pose", "rover", "left", "--json").stdout)
    assert link["position"] == pytest.approx(list(rover.link("left").pose.position))
    states = simkit_line("model", "joint", "rover").stdout.splitlines()
    assert [line.split()[0] for line in states] == ["left_wheel", "right_wheel"]
    joint = json.loads(simkit_line("model", "joint", "rover", "left_wheel", "--json").stdout)
    assert joint["position"] == pytest.approx(rover.joint("left_wheel").position)
    assert "(static, 1 link, 0 joints)" in simkit_line("model", "list", "-v").stdout
    assert "did you mean 'rover'?" in simkit_line("model", "pose", "rver").stderr
    assert "SK-CLI-038" in simkit_line("model", "joint", "rover", "lft_wheel").stderr


@pytest.mark.slow
def test_frames_hang_on_each_other(yard: Any, simkit_line: Any) -> None:
    assert simkit_line("tf", "tree", "--time", "1").stdout == "odom\n  base\n    rover::base::imu (static)\n"
    told = simkit_line("tf", "echo", "odom", "base", "--once").stdout.splitlines()
    assert re.fullmatch(r"At time \d+\.\d{9}", told[0])
    assert told[1].startswith("- Translation: [") and told[2].startswith("- Rotation: in Quaternion (xyzw) [")
    assert told[5] == "- Matrix:" and told[9] == "  0.000  0.000  0.000  1.000"
    there = json.loads(simkit_line("tf", "echo", "odom", "base", "--once", "--json").stdout)
    back = json.loads(simkit_line("tf", "echo", "base", "base", "--once", "--json").stdout)
    assert len(there["rotation"]) == 4 and back["translation"] == [0.0, 0.0, 0.0]
    assert "did you mean 'base'?" in simkit_line("tf", "echo", "odom", "bse", "--once").stderr


def test_nodes_are_plugins_and_sensors(yard: Any, simkit_line: Any) -> None:
    nodes = simkit_line("node", "list").stdout.split()
    assert "/Tuner" in nodes and not any(name.startswith("/_") for name in nodes)
    told = simkit_line("node", "info", "/Countdown").stdout
    assert told.startswith("/Countdown\n  Subscribers:\n")
    assert "  Action Servers:\n    /countdown: example_interfaces/action/Fibonacci\n" in told
    assert (
        "    /Tuner/list_parameters: rcl_interfaces/srv/ListParameters\n"
        in simkit_line("node", "info", "/Tuner").stdout
    )
    assert "SK-CLI-034" in simkit_line("node", "info", "/Tner").stderr


def test_the_frames_are_drawn_as_a_pdf(yard: Any, simkit_line: Any, tmp_path: Path) -> None:
    out = tmp_path / "frames.pdf"
    assert simkit_line("tf", "frames", "-o", str(out), "--time", "0.3").stdout == f"{out}: 3 frames\n"
    assert b"(odom) Tj" in out.read_bytes()
    assert "SK-CLI-016" in simkit_line("tf", "frames", "-o", str(tmp_path / "frames.gv")).stderr


def test_interfaces_are_shown_with_their_parts(simkit_line: Any) -> None:
    assert simkit_line("interface", "show", "geometry_msgs/msg/Twist").stdout == (
        "# Velocity: linear and angular part\ngeometry_msgs/Vector3 linear\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
        "geometry_msgs/Vector3 angular\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
    )
    assert simkit_line("interface", "show", "std_srvs/srv/SetBool").stdout == (
        "# Switch something on or off\nbool data\n---\nbool success\nstring message\n"
    )
    turn = simkit_line("interface", "show", "turtlesim/action/RotateAbsolute").stdout
    assert turn.startswith("# Heading at the end of the turn [rad]")
    assert "float32 angle_min  # [rad]\n" in simkit_line("interface", "show", "sensor_msgs/msg/LaserScan").stdout
    plain = simkit_line("interface", "show", "sensor_msgs/msg/LaserScan", "--no-comments").stdout
    assert "#" not in plain and "float32 angle_min\n" in plain
    assert simkit_line("interface", "show", "-", stdin="std_msgs/msg/String\n").stdout == "string data\n"
    proto = simkit_line("interface", "proto", "geometry_msgs/msg/PoseStamped", "--no-quotes").stdout
    assert yaml.safe_load(proto)["pose"]["orientation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    assert simkit_line("interface", "proto", "std_srvs/srv/SetBool").stdout == '"data: false\n"\n'
    listed = simkit_line("interface", "list").stdout
    assert listed.startswith("Messages:\n    ") and "\nServices:\n    " in listed and "\nActions:\n    " in listed
    assert "geometry_msgs" in simkit_line("interface", "packages").stdout.split()
    assert simkit_line("interface", "package", "std_srvs").stdout.split() == [
        "std_srvs/srv/Empty",
        "std_srvs/srv/SetBool",
        "std_srvs/srv/Trigger",
    ]
    wrong = simkit_line("interface", "show", "geometry_msgs/msg/Twst")
    assert "SK-CLI-032" in wrong.stderr and "geometry_msgs/msg/Twist" in wrong.stderr


def test_every_interface_can_be_shown(simkit_line: Any) -> None:
    from simkit.msgs.interface_definitions import interface_names, interface_text, prototype

    for kind in ("msg", "srv", "action"):
        for name in interface_names(kind):
            assert interface_text(name) is not None and prototype(name) is not None

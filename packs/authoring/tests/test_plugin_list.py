"""`simkit plugin list` and `info`: every name, and what stands behind it."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit import Params
from simkit.cli import app
from simkit.plugins.discovery.find_plugin_class import find_plugin
from simkit.scene import ScenePlugin
from simkit_authoring.catalogue import known_plugins

BRAKE = """
from simkit import ModelPlugin

class Brake(ModelPlugin):
    \"\"\"Slows the wheels down. And stops them.\"\"\"

    filenames = ("libbrake.so",)

    def load(self, parent, params):
        self.force = params.number("force", 3.0, minimum=0)  # [N]
        self.state = self.advertise("brake", "std_msgs/msg/Bool")
"""


def simkit(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["plugin", *map(str, arguments)], catch_exceptions=False)


def test_each_name_is_a_line_with_its_parent_elements() -> None:
    lines = simkit("list").stdout.splitlines()
    first = {line.split()[0]: line.split()[1] for line in lines}
    assert first["libgazebo_ros_diff_drive.so"] == "model"
    assert first["ignition::gazebo::systems::DiffDrive"] == "model"
    assert first["libignition-gazebo-imu-system.so"] == "any"
    assert first["gazebo_ros_imu_sensor"] == "sensor"


def test_every_name_that_is_listed_finds_its_plugin() -> None:
    for entry in known_plugins():
        for name in entry.names:
            as_class = ScenePlugin(name, "" if "::" in name else name, "box", Params("plugin"))
            assert find_plugin(as_class) is entry.cls, name


def test_words_filter_the_list_and_json_is_one_value() -> None:
    found = simkit("list", "diff_drive", "diff-drive")
    assert found.exit_code == 0
    assert {line.split()[2] for line in found.stdout.splitlines()} == {"GazeboRosDiffDrive:", "DiffDrive:"}
    entries = json.loads(simkit("list", "--json").stdout)
    drive = next(e for e in entries if e["class"] == "DiffDrive")
    assert drive["parents"] == ["model"] and drive["origin"] == "simkit"
    assert "gz::sim::systems::DiffDrive" in drive["names"]
    assert "nothing_like_it" in simkit("list", "nothing_like_it").stderr


def test_plugins_of_an_allowed_folder_are_listed_too(tmp_path: Path) -> None:
    (tmp_path / "brake.py").write_text(BRAKE)
    lines = simkit("list", "brake", "--plugin-path", tmp_path).stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["brake.py", "brake:Brake", "brake", "libbrake.so"]
    assert lines[0].endswith("Brake: Slows the wheels down.")
    assert "brake.py" not in simkit("list").stdout


@pytest.mark.parametrize(
    "name", ["gz-sim-diff-drive-system", "libgz-sim8-diff-drive-system.so", "gz::sim::systems::DiffDrive", "DiffDrive"]
)
def test_info_takes_any_spelling(name: str) -> None:
    text = simkit("info", name).stdout
    assert text.startswith("gz-sim-diff-drive-system: DiffDrive, on a model\n")
    assert "gz/diff_drive.py:" in text


def test_info_prints_parameters_topics_and_their_types() -> None:
    text = simkit("info", "libgazebo_ros_diff_drive.so").stdout
    row = next(line.split() for line in text.splitlines() if line.strip().startswith("wheelSeparation"))
    assert row == ["wheelSeparation", "number", "0.34", "m", "at", "least", "1e-06"]
    assert "geometry_msgs/msg/Twist" in text and "nav_msgs/msg/Odometry" in text


def test_info_for_programs_has_types_bounds_and_units(tmp_path: Path) -> None:
    (tmp_path / "brake.py").write_text(BRAKE)
    found = json.loads(simkit("info", "brake.py", "--plugin-path", tmp_path, "--json").stdout)
    assert found["origin"] == str(tmp_path / "brake.py")
    (force,) = found["parameters"]
    assert (force["name"], force["type"], force["default"], force["unit"]) == ("force", "number", 3.0, "N")
    assert (force["minimum"], force["maximum"], force["required"]) == (0.0, None, False)
    (topic,) = found["topics"]
    assert (topic["name"], topic["types"], topic["direction"]) == ("brake", ["std_msgs/msg/Bool"], "out")
    assert {"robotNamespace", "ros/remapping"} <= {p["name"] for p in found["common"]}
    drive = json.loads(simkit("info", "DiffDrive", "--json").stdout)
    assert {p["default"] for p in drive["parameters"] if p["name"] == "max_velocity"} == {"inf"}


def test_an_unknown_name_names_the_closest_and_a_file_of_yours_how_to_allow_it(tmp_path: Path) -> None:
    found = simkit("info", "libgazebo_ros_diff_driv.so")
    assert found.exit_code == 2 and "did you mean 'gazebo_ros_diff_drive'?" in found.stderr
    (tmp_path / "brake.py").write_text(BRAKE)
    found = simkit("info", tmp_path / "brake.py")
    assert found.exit_code == 2
    assert any(f"--plugin-path {folder}" in found.stderr for folder in (tmp_path, os.path.relpath(tmp_path)))

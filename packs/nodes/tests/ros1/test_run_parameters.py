"""Parameters of a run: the parameter server of ROS 1 has them before the first program starts."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

import simkit
from simkit import InputError, RunSpec
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

READER = """
import rospy

rospy.init_node("reader")
print(rospy.get_param("/robot"), rospy.get_param("~rate", 0), rospy.get_param("speed", "none"))
rospy.set_param("/robot/speed", 9)
"""
BRIDGE = """
import rclpy
from simkit_nodes.host import current_host
from simkit_nodes.ros1_parameters import parameter_server

print(parameter_server(current_host()).get("/robot/name"))
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "reader.py").write_text(READER)
    (tmp_path / "bridge.py").write_text(BRIDGE)
    (tmp_path / "w.sdf").write_text('<sdf version="1.9"><world name="w"/></sdf>')
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_all_programs_find_the_parameters_of_the_run(folder: Path) -> None:
    with simkit.load("w.sdf") as sim:
        sim.set_ros_parameters({"/robot": {"speed": 0.5, "gains": {"p": 1}}, "speed": 2})
        sim.set_ros_parameters({"/robot/name": "burger", "/reader/rate": 7})
        reader, bridge = sim.add_node("reader.py"), sim.add_node("bridge.py")
        sim.run(0.1)
        assert reader.log == ["{'speed': 0.5, 'gains': {'p': 1}, 'name': 'burger'} 7 2"]
        assert bridge.log == ["burger"]


def test_a_reset_brings_the_parameters_of_the_run_back(folder: Path) -> None:
    with simkit.load("w.sdf") as sim:
        sim.set_ros_parameters({"/robot": {"speed": 0.5}})
        reader = sim.add_node("reader.py")
        for _ in range(2):
            sim.run(0.1)
            assert reader.log == ["{'speed': 0.5} 0 none"]
            sim.reset()


def test_a_parameter_of_a_program_replaces_that_of_the_run(folder: Path) -> None:
    with simkit.load("w.sdf") as sim:
        sim.set_ros_parameters({"/robot": 1, "/reader/rate": 1})
        reader = sim.add_node("reader.py", params={"/robot": 2, "rate": 3})
        sim.run(0.1)
        assert reader.log == ["2 3 none"]


@pytest.mark.parametrize(
    ("name", "value"), [("/a", None), ("/a", 2**40), ("~a", 1), ("/a//b", 1), ("/", 1), ("/a b", 1)]
)
def test_a_name_or_a_value_that_is_not_allowed_is_an_error(name: str, value: object) -> None:
    with simkit.load("empty") as sim, pytest.raises(InputError, match="SK-NODE-066 parameter"):
        sim.set_ros_parameters({name: value})


def test_a_scenario_has_parameters_of_the_run(folder: Path) -> None:
    parameters = {"/robot": {"speed": 0.5, "wheels": [1, 2]}}
    scenario = {"world": "w.sdf", "duration": 0.1, "nodes": ["reader.py"], "ros_parameters": parameters}
    Path("s.yaml").write_text(yaml.safe_dump(scenario))
    spec = read_scenario("s.yaml", allow_code=True)
    assert spec.ros_parameters == parameters
    assert decode_scenario(encode_scenario(spec, folder), folder).ros_parameters == parameters
    with open_scenario(spec) as sim:
        run_scenario(spec, sim)
        assert sim.nodes[0].log == ["{'speed': 0.5, 'wheels': [1, 2]} 0 none"]


def test_runs_without_parameters_are_equal() -> None:
    assert RunSpec("w.sdf") == RunSpec("w.sdf")
    assert "ros_parameters" not in encode_scenario(RunSpec("w.sdf"), Path())

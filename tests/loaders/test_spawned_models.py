"""Additional models of a world: the texts of `--spawn`, on the command line and in Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.diagnostics import Diagnostics
from simkit.errors import LoadError
from simkit.loaders.spawned_models import SpawnedModel, parse_spawn

BOX = """<sdf version="1.9"><model name="box"><pose>0 0 0.25 0 0 1</pose><link name="link">
<collision name="c"><geometry><box><size>0.5 0.5 0.5</size></box></geometry></collision></link></model></sdf>"""


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("tiago:1,2,0.5", SpawnedModel("tiago", (1, 2, 0.5))),
        ("tiago:1,2,.5:left", SpawnedModel("tiago", (1, 2, 0.5), "left")),
        ("a/b.urdf: -1 , 2e0, 0", SpawnedModel("a/b.urdf", (-1, 2, 0))),
        ("model://box:1,2,0.3,0:b", SpawnedModel("model://box", (1, 2, 0.3, 0), "b")),
        ("box:1,2,3,0.1,0.2,0.3", SpawnedModel("box", (1, 2, 3, 0.1, 0.2, 0.3))),
        (r"C:\robots\arm.urdf:0,0,0", SpawnedModel(r"C:\robots\arm.urdf", (0, 0, 0))),
        ("tiago", SpawnedModel("tiago")),
        ("tiago:1,2,0:left:fleet/left", SpawnedModel("tiago", (1, 2, 0), "left", "fleet/left")),
    ],
)
def test_a_spawn_text_is_parsed_into_model_pose_and_name(text: str, expected: SpawnedModel) -> None:
    found = Diagnostics()
    assert parse_spawn(text, found) == expected
    assert not list(found)


@pytest.mark.parametrize("text", ["", " ", "tiago:1,2", "tiago:1,x,2", "tiago:1,2,3,4,5", "tiago:nan,0,0"])
def test_an_invalid_spawn_text_is_an_error_that_shows_the_allowed_form(text: str) -> None:
    found = Diagnostics()
    assert parse_spawn(text, found) is None
    (problem,) = found
    assert problem.code == "SK-SPAWN-001"
    assert "x,y,yaw" in problem.message + problem.hint


def test_a_spawned_model_keeps_its_own_height_unless_z_is_given(tmp_path: Path) -> None:
    (tmp_path / "box.sdf").write_text(BOX)
    with simkit.load("empty", spawn=[f"{tmp_path}/box.sdf:1,2,0.5", f"{tmp_path}/box.sdf:3,0,0.75,0:high"]) as sim:
        pose = sim.model("box").pose
        assert pose.position.tolist() == [1, 2, 0.25]
        assert pose.rpy[2] == pytest.approx(0.5)
        assert sim.model("high").pose.position.tolist() == [3, 0, 0.75]


def test_spawned_models_still_exist_after_a_reset() -> None:
    with simkit.load("empty", spawn=["turtlebot3_burger:0,0,0:a", "turtlebot3_burger.urdf:0,1,0:b"]) as sim:
        sim.run(0.2)
        sim.reset()
        assert {"a", "b"} <= set(sim.models)


def test_a_spawned_model_stands_where_an_override_moves_it_unless_the_override_sets_its_height() -> None:
    spawn = ["turtlebot3_burger:0,0,0:a"]
    with (
        simkit.load("empty", spawn=spawn) as plain,
        simkit.load("empty", spawn=spawn, overrides=["a.pose.x=2"]) as moved,
    ):
        assert moved.model("a").pose.position.tolist() == [2.0, 0.0, plain.model("a").pose.position[2]]
    with simkit.load("empty", spawn=spawn, overrides=["a.pose.z=0.5"]) as high:
        assert high.model("a").pose.position[2] == 0.5


def test_overrides_apply_to_spawned_models() -> None:
    with simkit.load("empty", spawn=["turtlebot3_burger:0,0,0:a"], overrides=["a::base_link.inertial.mass=2"]) as sim:
        assert sim.model("a").link("base_link").mass == pytest.approx(2.0)


def test_the_problems_of_all_spawned_models_are_reported_at_once() -> None:
    with pytest.raises(LoadError) as caught:
        simkit.load("empty", spawn=["turtlebot3_burgr:0,0,0", "x:1", "turtlebot3_burger:0,0,0:ground_plane"])
    assert {d.code for d in caught.value.diagnostics if d.severity == "error"} == {
        "SK-LOAD-002",
        "SK-SPAWN-001",
        "SK-SPAWN-002",
    }


def test_the_command_line_accepts_several_spawn_options() -> None:
    line = ["run", "empty", "--duration", "0.1", "--spawn", "turtlebot3_burger:0,0,0:a", "--spawn"]
    good = CliRunner().invoke(app, [*line, "turtlebot3_waffle:1,0,1.57"])
    assert good.exit_code == 0, good.output
    bad = CliRunner().invoke(app, [*line, "turtlebot3_burger:1,0"])
    assert bad.exit_code != 0
    assert "SK-SPAWN-001" in bad.output


@pytest.mark.parametrize("name", [5, "", "a::b"])
def test_the_name_of_a_spawned_model_is_a_text_without_scopes(name: Any) -> None:
    with pytest.raises(LoadError, match="SK-SPAWN-001: --spawn: turtlebot3_burger has the name"):
        simkit.load("empty", spawn=[{"model": "turtlebot3_burger", "name": name}])


@pytest.mark.parametrize(
    ("text", "code", "help_"),
    [
        ("turtlebot3_burger:0,0,0:a/b", "SK-SPAWN-001", "write MODEL:x,y,yaw"),
        ("turtlebot3_burger:0,0,0:a:b:c", "SK-SPAWN-001", "write MODEL:x,y,yaw"),
        ("robot:0,0,0", "SK-LOAD-002", "give a file, or a model of simkit: aruco_box, "),
    ],
)
def test_a_spawn_text_that_names_no_model_is_an_error_with_the_allowed_ones(text: str, code: str, help_: str) -> None:
    with pytest.raises(LoadError) as caught:
        simkit.load("empty", spawn=[text])
    error = next(d for d in caught.value.diagnostics if d.severity == "error")
    assert error.code == code and error.hint.startswith(help_)


@pytest.mark.parametrize("number", [1e308, -1e16, float("nan")])
def test_a_spawn_pose_beyond_the_largest_distance_is_an_error(number: float) -> None:
    """The levers of contacts overflow at 1e308 m; a bundle can also contain NaN."""
    with pytest.raises(simkit.LoadError, match="SK-SPAWN-001") as raised:
        simkit.load("empty", spawn=[SpawnedModel("turtlebot3_burger", (0.0, number, 0.5), None)])
    assert [d.code for d in raised.value.diagnostics if d.severity == "error"] == ["SK-SPAWN-001"]


def test_two_robots_of_one_file_have_topics_below_their_namespaces() -> None:
    names = {"cmd_vel", "imu", "joint_states", "odom", "scan"}
    spawn = ["turtlebot3_burger:0,0,0:tb1:tb1", "turtlebot3_burger:1,0,0:tb2:/fleet/tb2"]
    with simkit.load("empty", spawn=spawn) as sim:
        topics = set(sim.topics())
        scan, odometry = sim.subscribe("/tb1/scan"), sim.subscribe("/tb1/odom")
        other = sim.subscribe("/fleet/tb2/odom")
        sim.publish("/tb1/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(1.0)
        assert {f"/{namespace}/{name}" for namespace in ("tb1", "fleet/tb2") for name in names} <= topics
        assert not {f"/{name}" for name in names} & topics
        assert scan.latest is not None
        assert odometry.latest.pose.pose.position.x > 0.1
        assert abs(other.latest.pose.pose.position.x) < 0.01
        assert "SK-SENSOR-027" not in {d.code for d in sim.diagnostics}


NAMED = """<sdf version="1.9"><model name="m"><link name="l">
<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
<sensor name="imu" type="imu"><topic>/imu</topic></sensor></link>
<plugin name="old" filename="libgazebo_ros_p3d.so"><bodyName>l</bodyName><topicName>truth</topicName></plugin>
<plugin name="v" filename="gz-sim-velocity-control-system"><topic>cmd_vel</topic></plugin>
<plugin name="p" filename="gz-sim-pose-publisher-system"/></model></sdf>"""


def test_a_namespace_comes_before_topics_of_sensors_of_ros_1_and_of_gazebo_sim(tmp_path: Path) -> None:
    (tmp_path / "m.sdf").write_text(NAMED)
    with simkit.load("empty", spawn=[{"model": tmp_path / "m.sdf", "name": "a", "namespace": "ns"}]) as sim:
        assert {"/ns/imu", "/ns/truth", "/ns/cmd_vel", "/model/a/pose"} <= set(sim.topics())
        assert [d for d in sim.diagnostics if d.severity == "warning"] == []


def test_a_clash_of_two_robots_topics_names_the_namespace_as_remedy() -> None:
    with simkit.load("empty", spawn=["turtlebot3_burger:0,0,0:a", "turtlebot3_burger:1,0,0:b"]) as sim:
        hints = [d.hint for d in sim.diagnostics if d.code == "SK-SENSOR-027"]
    assert len(hints) == 2
    assert all("--spawn MODEL:x,y,yaw:NAME:NAMESPACE" in hint for hint in hints)


def test_invalid_namespaces_are_reported_together() -> None:
    spawn = ["turtlebot3_burger:0,0,0:a:b c", "turtlebot3_burger:0,0,0:b:2", {"model": "tiago", "namespace": 3}]
    with pytest.raises(LoadError) as caught:
        simkit.load("empty", spawn=[*spawn, "turtlebot3_burger:0,0,0:c:"])
    problems = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert [d.code for d in problems] == ["SK-SPAWN-001"] * 4
    assert "'b c'" in problems[0].message and "tb1" in problems[0].hint

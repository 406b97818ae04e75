"""Other names for the topics, services and actions of a world: `--remap OLD:=NEW`."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

import simkit
from simkit import InputError, LoadError, RunSpec, WorldPlugin
from simkit.cli import app
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario

ROBOT = """<sdf version="1.9"><world name="w"><model name="robot"><link name="base">
<sensor name="imu" type="imu"><topic>imu</topic><always_on>1</always_on><update_rate>100</update_rate></sensor>
<sensor name="height" type="altimeter"><topic>height</topic><update_rate>100</update_rate></sensor></link>
<plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system"><topic>/cmd_vel</topic>
</plugin></model></world></sdf>"""


class Speaker(WorldPlugin):
    """Plugin with each kind of interface."""

    def load(self, parent: object, params: object) -> None:
        self.heard: list[str] = []
        self.advertise("words", "std_msgs/msg/String")
        self.subscribe("words", lambda message: self.heard.append(message.data))
        self.offer("stop", "std_srvs/srv/Trigger", lambda _: {"message": "stopped"})
        self.act("go", "example_interfaces/action/Fibonacci", lambda goal: goal.accept())


class Other(WorldPlugin):
    """Second plugin with a service."""

    def load(self, parent: object, params: object) -> None:
        self.offer("halt", "std_srvs/srv/Trigger", lambda _: {})


def test_sensors_and_plugins_get_the_new_names() -> None:
    with simkit.load(ROBOT, remap={"/imu": "/robot/imu", "cmd_vel": "robot/cmd_vel"}) as sim:
        assert {"/robot/imu", "/robot/cmd_vel", "/height"} <= set(sim.topics())
        assert not {"/imu", "/cmd_vel"} & set(sim.topics())
        assert sim.sensor("robot::base::imu").topic == "/robot/imu"
        subscription = sim.subscribe("/robot/imu")
        sim.publish("/robot/cmd_vel", {"linear": {"x": 1.0}})
        sim.run(0.1)
        assert subscription.latest is not None
        assert sim.link("robot::base").linear_velocity[0] == pytest.approx(1.0)


def test_both_ends_of_a_topic_of_the_world_are_renamed() -> None:
    plugin = Speaker()
    with simkit.load("empty", plugins=[plugin], remap=["/words:=/said"]) as sim:
        sim.publish("/said", {"data": "a"})
        sim.communication.publish("/words", simkit.msgs.make("std_msgs/msg/String", data="b"))
        assert plugin.heard == ["a"]


def test_services_and_actions_get_the_new_names() -> None:
    with simkit.load("empty", plugins=[Speaker()], remap={"/stop": "/halt", "/go": "/walk"}) as sim:
        assert sim.call("/halt").message == "stopped"
        assert "/stop" not in sim.communication.services.names()
        goal = sim.send_goal("/walk")
        sim.step(2)
        assert goal.is_active
        assert "/walk" in sim.communication.actions.names()
        assert "/go" not in sim.communication.actions.names()


def test_two_names_can_be_exchanged() -> None:
    with simkit.load(ROBOT, remap={"/imu": "/height", "/height": "/imu"}) as sim:
        assert sim.topics()["/imu"] == "ros_gz_interfaces/msg/Altimeter"
        assert sim.topics()["/height"] == "sensor_msgs/msg/Imu"


def test_scripts_keep_the_names_that_they_use() -> None:
    with simkit.load("empty", remap={"/a": "/b"}) as sim:
        sim.advertise("/a", "std_msgs/msg/String")
        sim.offer("/a", "std_srvs/srv/Trigger", lambda _: {})
        assert "/a" in sim.topics()
        assert "/a" in sim.communication.services.names()


def test_transforms_of_the_world_are_found_under_their_new_name() -> None:
    with simkit.load("turtlebot3_world", remap={"/tf": "/robot/tf"}) as sim:
        sim.run(0.1)
        assert "/tf" not in sim.topics()
        assert sim.tf.lookup("odom", "base_footprint").position[0] == pytest.approx(0.0, abs=0.1)


def test_models_that_are_spawned_later_get_the_new_names() -> None:
    with simkit.load("empty", remap={"/imu": "/robot/imu"}) as sim:
        assert [each.code for each in sim.diagnostics if each.severity == "warning"] == ["SK-TOPIC-008"]
        sim.spawn(ROBOT.replace('<world name="w">', "").replace("</world>", ""))
        assert "/robot/imu" in sim.topics()


def test_a_name_that_the_world_does_not_have_is_a_warning_with_the_closest_one() -> None:
    with simkit.load(ROBOT, remap={"/imuu": "/robot/imu"}) as sim:
        (warning,) = [each for each in sim.diagnostics if each.code == "SK-TOPIC-008"]
        assert warning.message == "--remap /imuu:=/robot/imu: the loaded world has no topic, service or action /imuu"
        assert warning.hint == "did you mean '/imu'?"
    with pytest.raises(LoadError, match="SK-TOPIC-008"):
        simkit.load(ROBOT, remap={"/imuu": "/robot/imu"}, strict=True)


def test_two_topics_of_different_types_cannot_be_joined() -> None:
    with pytest.raises(LoadError, match="SK-TOPIC-007.*/imu cannot have the name /height: one end has the type"):
        simkit.load(ROBOT, remap={"/imu": "/height"})
    with pytest.raises(LoadError, match="SK-TOPIC-001"):
        simkit.load(ROBOT, remap={"/imu": "/cmd_vel"})


def test_two_topics_of_one_type_are_joined() -> None:
    robot = ROBOT.replace("height", "second").replace("altimeter", "imu")
    with simkit.load(robot, remap={"/imu": "/both", "/second": "/both"}) as sim:
        subscription = sim.subscribe("/both")
        sim.run(0.1)
        assert len(subscription.messages) in (20, 22)  # 10 or 11 of each sensor


def test_two_services_cannot_have_one_name() -> None:
    with pytest.raises(LoadError, match="SK-SERVICE-001: plugin 'Speaker': a service '/halt' exists already"):
        simkit.load("empty", plugins=[Other(), Speaker()], remap={"/stop": "/halt"})
    attacher = '<plugin name="a" filename="libgazebo_link_attacher.so"/>'
    world = f'<sdf version="1.9"><world name="w">{attacher}</world></sdf>'
    with pytest.raises(LoadError, match="SK-TOPIC-007.* the world has several services of this name"):
        simkit.load(world, remap={"/ATTACHLINK": "/x", "/DETACHLINK": "/x"})


@pytest.mark.parametrize("remap", [{"/a b": "/c"}, {"/a": "/"}, {"": "/a"}, ["/a"], {"/a": "/b//c"}])
def test_an_invalid_name_is_an_error(remap: dict[str, str] | list[str]) -> None:
    with pytest.raises(InputError, match="SK-CLI-018 --remap"):
        simkit.load("empty", remap=remap)


def test_a_remapping_is_an_option_and_a_key_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("w.sdf").write_text(ROBOT)
    words = ["run", "w.sdf", "--duration", "0.1", "--remap", "/imu:=/robot/imu", "--remap", "height:=/h"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert "/robot/imu" in result.output
    assert "/h " in result.output
    Path("s.yaml").write_text("world: w.sdf\nduration: 0.1\nremap: {/imu: /robot/imu}\n")
    spec = read_scenario("s.yaml")
    with open_scenario(spec) as sim:
        assert "/robot/imu" in sim.topics()
    assert decode_scenario(encode_scenario(spec, tmp_path), tmp_path).options["remap"] == {"/imu": "/robot/imu"}


def test_golden_runs_and_bundles_keep_the_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("w.sdf").write_text(ROBOT)
    remap = ("--remap", "/imu:=/robot/imu", "--remap", "/cmd_vel:=/drive")
    more = ("--duration", "0.5", *remap, "--cmd-vel", "0.5,0")
    for words in (
        ("golden", "record", "w.sdf", "-o", "golden", *more),
        ("golden", "check", "golden"),
        ("bundle", "w.sdf", "-o", "b.zip", *more),
        ("replay", "b.zip"),
    ):
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0, result.output
    assert "identical" in result.output


def test_a_run_specification_has_a_remapping() -> None:
    spec = RunSpec(ROBOT, options={"remap": ("/imu:=/robot/imu",)})
    with open_scenario(spec) as sim:
        assert "/robot/imu" in sim.topics()

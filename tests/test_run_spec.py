"""The description of a run: one, whoever makes it, and it survives a pickle."""

import pickle
from dataclasses import FrozenInstanceError
from pathlib import Path

import pytest

import simkit
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, scenario_spec
from simkit.run_spec import Check, Recording, RunSpec
from simkit.runtime.communication.topic_bus import TopicBus
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, resolve_commands, run_scenario
from simkit_verification.testing.bundles import keep, open_bundle, write_bundle

BALL = """<sdf version="1.9"><world name="w"><model name="ball"><pose>0 0 5 0 0 0</pose><link name="l"><inertial><mass>1
</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link></model></world></sdf>"""


@pytest.fixture
def world(tmp_path: Path) -> Path:
    """A file of a world."""
    path = tmp_path / "ball.sdf"
    path.write_text(BALL)
    return path


def test_a_run_spec_is_frozen_and_can_be_pickled(world: Path) -> None:
    spec = RunSpec(
        str(world), 0.2, 3, overrides=("ball::l.inertial.mass=2",), checks=(Check("final", expression="time == 0.2"),),
        options={"base": "fixed", "xacro_args": {"a": "1"}}, recording=Recording(Path("x.mcap")), velocity="1,0",
    )  # fmt: skip
    assert pickle.loads(pickle.dumps(spec)) == spec
    with pytest.raises(FrozenInstanceError):
        spec.seed = 4  # type: ignore[misc]


def test_a_simulation_has_the_run_spec_that_it_was_loaded_from(world: Path) -> None:
    spec = RunSpec(str(world), seed=3, overrides=("ball::l.inertial.mass=2",), options={"sleep": False})
    with open_scenario(spec) as sim:
        assert sim.run_spec is not None
        assert (sim.run_spec.world, sim.run_spec.seed, sim.run_spec.overrides) == (spec.world, 3, spec.overrides)
        assert sim.run_spec.options["sleep"] is False and sim.run_spec.folder == Path.cwd()
        with open_scenario(sim.run_spec) as again:
            assert again.link("ball::l").mass == 2.0


def test_command_line_options_override_a_scenario_file(world: Path) -> None:
    file = world.with_name("fall.yaml")
    file.write_text("world: ball.sdf\nduration: 0.3\nseed: 5\nset: [ball::l.inertial.mass=2]\nbase: fixed\n")
    assert scenario_spec(str(file), NONE_GIVEN) == read_scenario(file)
    given = {"duration": 0.1, "overrides": ("gravity=0 0 0",), "velocity": "1,0"}
    options = {"xacro_args": {"a": "1"}, "plugin_paths": (Path("plugins"),)}
    over = scenario_spec(str(file), GivenOptions({**given, **options}))
    assert (over.duration, over.seed, over.velocity) == (0.1, 5, "1,0")
    assert over.overrides == ("ball::l.inertial.mass=2", "gravity=0 0 0")
    assert over.options == {"base": "fixed", "xacro_args": {"a": "1"}, "plugin_paths": (Path("plugins"),)}


def test_a_script_is_among_the_commands_once_topics_are_known(tmp_path: Path) -> None:
    script = tmp_path / "go.yaml"
    script.write_text("- {at: 0.1, topic: /cmd_vel, message: {linear: {x: 0.1}}}\n")
    spec = RunSpec("turtlebot3_world", velocity="0.2,0", script=script)
    bus = TopicBus()
    bus.listen("/cmd_vel", ["geometry_msgs/msg/Twist"], print)
    found = resolve_commands(spec, bus)
    assert len(found.commands) == 2 and found.velocity is None and found.script is None
    assert resolve_commands(found, bus) is found


def test_a_bundle_has_seed_overrides_and_options(world: Path) -> None:
    options = {"overrides": ["ball::l.inertial.mass=2"], "on_error": "disable", "base": "fixed"}
    with simkit.load(world, seed=7, **options) as sim, keep(sim):
        sim.run(0.05)
        path = write_bundle(sim, world.with_name("run.zip"))
    with open_bundle(path) as bundle:
        spec = bundle.manifest.run_spec
    assert (spec.seed, spec.overrides) == (7, ("ball::l.inertial.mass=2",))
    expected = {"base": "fixed", "sleep": True, "on_error": "disable", "start_controllers": True, "hold_joints": False}
    assert spec.options == expected


def test_a_run_ends_at_its_timeout_else_its_duration(world: Path) -> None:
    spec = RunSpec(str(world), 0.2, until="time > 9", timeout=0.1)
    assert spec.longest == 0.1 and RunSpec("w", 0.2).longest == 0.2
    with open_scenario(spec) as sim:
        assert run_scenario(spec, sim).reason == "timeout" and sim.time == pytest.approx(0.1)


@pytest.mark.parametrize("given", [{"arm": "left"}, ["arm:=left"], ("arm=left",), "arm:=left"])
def test_xacro_arguments_have_the_form_of_ros_or_of_a_mapping(tmp_path: Path, given: object) -> None:
    text = '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="arm" default="no"/>'
    inertia = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    (tmp_path / "r.xacro").write_text(f'{text}<link name="$(arg arm)">{inertia}</link></robot>')
    spec = RunSpec(str(tmp_path / "r.xacro"), options={"xacro_args": given})
    with simkit.load(spec.world, **spec.load_arguments()) as sim:
        assert list(sim.model("r").links) == ["left"]
    if not isinstance(given, tuple):
        (tmp_path / "s.yaml").write_text(f"world: r.xacro\nduration: 1\nxacro_args: {given!r}\n")
        assert read_scenario(tmp_path / "s.yaml").options["xacro_args"] == {"arm": "left"}
    with pytest.raises(
        simkit.InputError, match="SK-CLI-018 xacro_args: found 'arm'; expected NAME:=VALUE or NAME=VALUE"
    ):
        simkit.load(spec.world, xacro_args=["arm"])

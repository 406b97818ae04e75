"""Overrides of a loaded world give the same bits as overrides before the load."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.pose import Pose
from simkit.runtime.engine.snapshot import state_hash
from simkit.runtime.world_variation import apply_overrides

_ROBOT = "turtlebot3"


def model_numbers(sim: simkit.Simulation) -> dict[str, bytes]:
    """Return every array of the compiled model, and its statistics and options."""
    model = sim.mj_model
    groups: dict[str, Any] = {"": model, "stat.": model.stat, "opt.": model.opt}
    values = {f"{p}{n}": getattr(g, n) for p, g in groups.items() for n in dir(g) if not n.startswith("_")}
    return {n: np.asarray(v).tobytes() for n, v in values.items() if isinstance(v, (np.ndarray, float, int))}


@pytest.mark.parametrize(
    "overrides",
    [
        [f"{_ROBOT}::base_link.inertial.mass=2"],
        [f"{_ROBOT}::wheel_left_link.inertial.mass=0.3", "world.gravity=0 0 -5"],
        [f"{_ROBOT}::wheel_left_link::tread.surface.friction.ode.mu=0.4"],
        [f"{_ROBOT}::wheel_left_joint.axis.dynamics.damping=0.2"],
        ["ground_plane::link::collision.surface.friction.ode.mu=0.1"],
        [
            "arena::pillars::pillar_1.pose.x=0.3",
            "arena::pillars::cap_1.pose.x=0.3",
            "arena::pillars::pillar_2.radius=0.2",
        ],
        ["arena.pose=-0.1 0.2 0 0 0 0.3", "turtlebot3::base_link.mass=2"],
        ["sun.intensity=0.5", "sun.diffuse=1 0.5 0.2 1", "sun.pose=3 4 20 0.3 0.1 0", "sun.cast_shadows=false"],
    ],
)
def test_numbers_that_are_set_in_a_loaded_world_give_the_bits_of_a_load(overrides: list[str]) -> None:
    with simkit.load("turtlebot3_world", overrides=overrides) as loaded, simkit.load("turtlebot3_world") as varied:
        varied.run(0.1)
        assert apply_overrides(varied, overrides)
        assert model_numbers(varied) == model_numbers(loaded)
        for sim in (loaded, varied):
            sim.advertise("/cmd_vel", "geometry_msgs/msg/Twist").publish({"linear": {"x": 0.2}, "angular": {"z": 0.5}})
            sim.run(2.0)
        assert state_hash(varied) == state_hash(loaded)
        assert apply_overrides(varied, [])
        with simkit.load("turtlebot3_world") as base:
            assert model_numbers(varied) == model_numbers(base)


_INERTIA = "<inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz></inertia>"
_OBJECTS = f"""
<sdf version="1.9"><world name="w">
  <model name="ground"><static>1</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
  </link></model>
  <model name="shelf"><static>1</static><pose>0 0 0.02 0 0 0</pose><link name="l"><collision name="c"><geometry>
    <box><size>0.5 0.5 0.04</size></box></geometry></collision></link></model>
  <model name="box"><pose>0 0 0.3 0.2 0 0.1</pose><link name="l"><inertial><mass>2</mass>{_INERTIA}</inertial>
    <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
    <visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></visual></link></model>
  <model name="door"><pose>2 0 0 0 0 0.3</pose>
    <link name="frame"><pose>0.1 0.2 0.7 0 0 0.2</pose><inertial><mass>5</mass>{_INERTIA}</inertial></link>
    <joint name="fixed" type="fixed"><parent>world</parent><child>frame</child></joint>
    <link name="leaf"><pose>0.5 0.2 0.7 0.1 0 0.2</pose><inertial><mass>1</mass>{_INERTIA}</inertial>
      <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>
    <joint name="hinge" type="revolute"><parent>frame</parent><child>leaf</child><pose>-0.4 0 0 0 0 0</pose>
      <axis><xyz>0 1 0.3</xyz><dynamics><damping>0.02</damping></dynamics></axis></joint></model>
</world></sdf>
"""


@pytest.mark.parametrize(
    "overrides",
    [
        ["box.pose=0.31 -0.17 0.45 0.3 -0.2 1.1"],
        ["box.pose.z=0.6", "box::l.inertial.mass=0.7", "box::l::c.surface.friction.ode.mu=0.3", "world.gravity=0 0 -5"],
        ["box::l::c.geometry.box.size=0.1 0.3 0.2", "box::l::v.geometry.box.size=0.1 0.3 0.2"],
        ["shelf.pose.z=0.12", "shelf::l::c.size=0.6 0.6 0.04"],
        ["door.pose=-1.3 0.7 0.1 0 0 -0.9"],
        ["door.pose.x=1.7", "door::hinge.axis.dynamics.damping=0.3", "door::leaf.pose=0.55 0.2 0.7 0.1 0 0.2"],
    ],
)
def test_poses_and_sizes_of_moving_objects_in_a_loaded_world_give_the_bits_of_a_load(overrides: list[str]) -> None:
    with simkit.load(_OBJECTS, overrides=overrides) as loaded, simkit.load(_OBJECTS) as varied:
        varied.run(0.2)
        varied.model("box").set_pose(Pose((1.0, 1.0, 1.0)))
        assert apply_overrides(varied, overrides)
        assert model_numbers(varied) == model_numbers(loaded)
        assert state_hash(varied) == state_hash(loaded)
        for joint in ("door::hinge", "door::fixed"):
            names = [sim.engine.names.joint(joint) for sim in (varied, loaded)]
            assert names[0].pose_child == names[1].pose_child and names[0].pose_moved == names[1].pose_moved
        for sim in (loaded, varied):
            sim.run(1.0)
        assert state_hash(varied) == state_hash(loaded)
        assert apply_overrides(varied, [])
        with simkit.load(_OBJECTS) as base:
            assert model_numbers(varied) == model_numbers(base)
            assert state_hash(varied) == state_hash(base)


def test_another_pose_of_a_robot_and_another_kind_of_shape_need_a_new_load() -> None:
    with simkit.load("turtlebot3_world") as sim:
        assert not apply_overrides(sim, [f"{_ROBOT}.pose.x=1"])
    with simkit.load(_OBJECTS) as sim:
        sim.contents.add_weld("w", "box::l", "door::leaf")
        assert apply_overrides(sim, ["box.pose.x=1"])  # the weld belongs to the run, not to the file
        assert sim.model("box").pose.position[0] == 1.0


def test_a_bumper_has_the_torque_about_the_changed_centre_of_mass() -> None:
    bumper = '<plugin name="p" filename="libgazebo_ros_bumper.so"/>'
    sensor = f'<sensor name="s" type="contact"><contact><collision>c</collision></contact>{bumper}</sensor>'
    world, overrides = _OBJECTS.replace("<visual", f"{sensor}<visual", 1), ["box::l.inertial.com=0.03 0 0"]
    with simkit.load(world, overrides=overrides) as loaded, simkit.load(world) as varied:
        assert apply_overrides(varied, overrides)
        received = [sim.subscribe("/bumper_states") for sim in (loaded, varied)]
        for sim in (loaded, varied):
            sim.run(0.4)
        assert received[0].latest.states
        assert msgs.serialize(received[0].latest) == msgs.serialize(received[1].latest)


def test_what_a_run_changed_does_not_stay_in_a_varied_world() -> None:
    overrides = [f"{_ROBOT}::wheel_left_link::tread.surface.friction.ode.mu=0.4"]
    with simkit.load("turtlebot3_world", overrides=overrides) as loaded, simkit.load("turtlebot3_world") as varied:
        varied.link(f"{_ROBOT}::base_link").mass = 3.0
        varied.gravity = (0.0, 0.0, -1.0)
        varied.spawn('<sdf version="1.9"><model name="box"><pose>9 9 1 0 0 0</pose><link name="l"/></model></sdf>')
        varied.run(0.1)
        assert apply_overrides(varied, overrides)
        assert model_numbers(varied) == model_numbers(loaded)
        assert varied.link(f"{_ROBOT}::base_link").mass == loaded.link(f"{_ROBOT}::base_link").mass


class Stiff(simkit.ModelPlugin):
    reads_at_load = ()

    def load(self, model: Any, _params: Any) -> None:
        model.joint("wheel_left_joint").damping = 0.7


def test_what_a_plugin_wrote_while_it_was_loaded_stays_in_a_varied_world() -> None:
    overrides = [f"{_ROBOT}::wheel_right_joint.axis.dynamics.damping=0.2"]
    plugins = [(_ROBOT, Stiff())], [(_ROBOT, Stiff())]
    with simkit.load("turtlebot3_world", plugins=plugins[0]) as varied:
        with simkit.load("turtlebot3_world", plugins=plugins[1], overrides=overrides) as loaded:
            varied.run(0.1)
            assert apply_overrides(varied, overrides)
            assert [varied.joint(f"{_ROBOT}::wheel_{side}_joint").damping for side in ("left", "right")] == [0.7, 0.2]
            assert model_numbers(varied) == model_numbers(loaded)
            for sim in (loaded, varied):
                sim.run(1.0)
            assert state_hash(varied) == state_hash(loaded)
        assert apply_overrides(varied, [])
        with simkit.load("turtlebot3_world", plugins=[(_ROBOT, Stiff())]) as base:
            assert model_numbers(varied) == model_numbers(base)


def test_a_light_of_a_loaded_world_has_the_values_and_pictures_of_a_load() -> None:
    overrides = {"sun.intensity": 0.4, "sun.diffuse": (1, 0.5, 0.2, 1), "sun.pose": (3, 4, 20, 0.5, 0.1, 0)}
    pictures = []
    with simkit.load("turtlebot3_world", overrides=overrides) as loaded, simkit.load("turtlebot3_world") as varied:
        varied.run(0.1)
        assert apply_overrides(varied, overrides)
        varied.light("sun").intensity = 3.0
        varied.reset()
        for sim in (loaded, varied):
            light = sim.light("sun")
            assert light.intensity == 0.4 and tuple(light.pose.position) == (3.0, 4.0, 20.0)
            sim.run(0.1)
            pictures.append(sim.sensor(f"{_ROBOT}::camera_rgb_frame::camera").latest.data)
        assert np.array_equal(*pictures) and np.ptp(pictures[0]) > 50
        assert apply_overrides(varied, [])
        assert varied.light("sun").intensity == 1.0


def test_a_light_on_a_robot_and_another_type_of_light_need_a_new_load() -> None:
    lamp = '<light name="lamp" type="spot"><pose>0 0 2 0 0 0</pose></light>'
    link = f'<link name="l">{lamp}</link>'
    world = f'<sdf version="1.9"><world name="w">{lamp}<model name="m">{link}</model></world></sdf>'
    with simkit.load(world) as sim:
        assert not apply_overrides(sim, {"m::l::lamp.intensity": 0.5})
        assert sim.light("m::l::lamp").intensity == 1.0


def test_a_snapshot_from_before_other_overrides_is_refused() -> None:
    with simkit.load("turtlebot3_world") as sim:
        before = sim.snapshot()
        assert apply_overrides(sim, {"world.gravity": (0, 0, -5)})
        with pytest.raises(ValueError, match="before the world got other overrides"):
            sim.restore(before)


def test_a_change_of_the_structure_needs_a_new_load() -> None:
    with simkit.load("turtlebot3_world") as sim:
        sim.run(0.1)
        assert not apply_overrides(sim, ["ground_plane.static=false"])
        assert sim.time == 0.1


class Heavy(simkit.ModelPlugin):
    def load(self, model: Any, _params: Any) -> None:
        self.weight = 9.8 * model.link("base_link").mass


class Light(Heavy):
    reads_at_load = ()


@pytest.mark.parametrize(("plugin", "is_possible"), [(Heavy, False), (Light, True)])
def test_a_plugin_that_may_have_read_a_number_needs_a_new_load(plugin: type[Heavy], is_possible: bool) -> None:
    with simkit.load("turtlebot3_world", plugins=[(_ROBOT, plugin())]) as sim:
        assert apply_overrides(sim, [f"{_ROBOT}::base_link.mass=2"]) is is_possible


def test_a_varied_world_keeps_its_numbers_after_a_spawn_and_a_reset() -> None:
    with simkit.load("turtlebot3_world") as sim:
        assert apply_overrides(sim, [f"{_ROBOT}::base_link.mass=2", f"{_ROBOT}::wheel_left_joint.damping=0.2"], seed=5)
        assert sim.seed == 5
        sim.spawn('<sdf version="1.9"><model name="box"><pose>9 9 1 0 0 0</pose><link name="l"/></model></sdf>')
        body = sim.engine.names.link(f"{_ROBOT}::base_link").body
        assert sim.mj_model.body_mass[body] == sim.link(f"{_ROBOT}::base_link").mass == 2.0
        assert sim.joint(f"{_ROBOT}::wheel_left_joint").damping == 0.2
        sim.reset()
        assert sim.link(f"{_ROBOT}::base_link").mass == 2.0
        assert sim.run_spec is not None
        assert sim.run_spec.overrides[0] == f"{_ROBOT}::base_link.mass=2"


def test_a_world_without_a_former_xacro_override_is_loaded_anew(tmp_path: Path) -> None:
    (tmp_path / "ball.urdf.xacro").write_text(
        '<robot name="ball" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="m" default="2"/>'
        '<link name="l">'
        '<inertial><mass value="$(arg m)"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        "</link></robot>"
    )
    with simkit.load(tmp_path / "ball.urdf.xacro", overrides=["xacro.m=5"]) as sim:
        assert sim.link("ball::l").mass == 5.0
        assert not apply_overrides(sim, {})
        assert apply_overrides(sim, {"xacro.m": 5})

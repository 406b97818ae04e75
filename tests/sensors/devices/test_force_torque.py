"""Force-torque sensors: wrenches through joints of every kind, their frames, direction and noise."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from sensor_worlds import noise, xyz

import simkit
from simkit.pose import Pose

G = 9.8
SCREW = "<screw_thread_pitch>0.1</screw_thread_pitch>"


def link(name: str, pose: str = "0 0 0 0 0 0", mass: float = 1.0, com: str = "0 0 0", more: str = "") -> str:
    inertia = "<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>"
    return (
        f'<link name="{name}"><pose>{pose}</pose><inertial><pose>{com} 0 0 0</pose><mass>{mass}</mass>{inertia}'
        f"</inertial>{more}</link>"
    )


def ft(
    frame: str = "child",
    direction: str = "parent_to_child",
    pose: str = "0 0 0 0 0 0",
    more: str = "",
    rate: float = 0,
    extra: str = "",
) -> str:
    block = f"<frame>{frame}</frame><measure_direction>{direction}</measure_direction>{more}"
    return (
        f'<sensor name="ft" type="force_torque"><pose>{pose}</pose><update_rate>{rate}</update_rate>{extra}'
        f"<force_torque>{block}</force_torque></sensor>"
    )


def joint(kind: str, parent: str, child: str, inside: str = "", axis: str = "", pose: str = "", name: str = "j") -> str:
    axes = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    if kind == "universal":
        axes += "<axis2><xyz>0 1 0</xyz></axis2>"
    place = f"<pose>{pose}</pose>" if pose else ""
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<joint name="{name}" type="{kind}">{place}{ends}{axes}{inside}</joint>'


def world(*parts: str, model: str = "", top: str = "", others: str = "") -> str:
    inner = "".join(parts)
    return (
        f'<sdf version="1.9"><world name="w"><gravity>0 0 -{G}</gravity>{top}'
        f'<model name="m">{model}{inner}</model>{others}</world></sdf>'
    )


def read(text: str, steps: int = 1, name: str = "m::j::ft") -> tuple[Any, Any]:
    """Return the force and torque after some steps, without noise."""
    with simkit.load(text) as sim:
        sim.step(steps)
        return wrench_of(sim.sensor(name).truth)


def wrench_of(message: Any) -> tuple[Any, Any]:
    return xyz(message.wrench.force), xyz(message.wrench.torque)


# ------------------------------------------------------------------ statics


def test_a_hanging_mass_pulls_with_its_weight_and_the_default_direction_is_to_the_parent() -> None:
    tag = '<sensor name="ft" type="force_torque"/>'
    force, torque = read(world(link("load", mass=2), joint("fixed", "world", "load", tag)))
    np.testing.assert_allclose(force, (0, 0, -2 * G), atol=1e-9)
    np.testing.assert_allclose(torque, 0, atol=1e-9)


def test_a_cantilever_holds_mass_times_arm_times_gravity() -> None:
    """The mass is 2 kg at 0.5 m along x: the wall's force is 19.6 N upwards, and its torque is 9.8 N m."""
    text = world(link("beam", mass=2, com="0.5 0 0"), joint("fixed", "world", "beam", ft()))
    force, torque = read(text)
    np.testing.assert_allclose(force, (0, 0, 2 * G), atol=1e-9)
    np.testing.assert_allclose(torque, (0, -2 * G * 0.5, 0), atol=1e-9)


def test_the_torque_is_about_the_sensor_at_any_position_and_rotation() -> None:
    """The sensor is at 0.3 m on the beam of the previous test, rotated about all axes."""
    pose = "0.3 0 0.1 0.4 -0.7 1.1"
    text = world(link("beam", mass=2, com="0.5 0 0"), joint("fixed", "world", "beam", ft("sensor", pose=pose)))
    force, torque = read(text)
    turn = Pose.from_rpy(0, 0, 0, 0.4, -0.7, 1.1).matrix
    np.testing.assert_allclose(force, (0, 0, 2 * G) @ turn, atol=1e-9)
    np.testing.assert_allclose(torque, (0, -2 * G * 0.2, 0) @ turn, atol=1e-9)
    # in the child's axes, the vector is the same torque about the same point
    text = text.replace("<frame>sensor", "<frame>child")
    np.testing.assert_allclose(read(text)[1], (0, -2 * G * 0.2, 0), atol=1e-9)


@pytest.mark.parametrize("turned", [False, True])
def test_with_gazebos_quirks_the_lever_is_in_the_joint_s_axes(turned: bool) -> None:
    """T_s = R^T T_j - p x F_s is wrong if the sensor is rotated and is not at the joint's origin."""
    angles = (0.4, -0.7, 1.1) if turned else (0.0, 0.0, 0.0)
    pose = "0.3 0 0.1 " + " ".join(map(str, angles))
    quirks = '<simkit:gazebo_quirks xmlns:simkit="x">true</simkit:gazebo_quirks>'
    text = world(
        link("beam", mass=2, com="0.5 0 0"), joint("fixed", "world", "beam", ft("sensor", pose=pose)), top=quirks
    )
    force, torque = read(text)
    turn = Pose.from_rpy(0, 0, 0, *angles).matrix
    expected = (0, -2 * G * 0.5, 0) @ turn - np.cross((0.3, 0, 0.1), force)
    np.testing.assert_allclose(torque, expected, atol=1e-9)
    right = (0, -2 * G * 0.2, 0) @ turn
    assert np.allclose(torque, right, atol=1e-6) is not turned


FRAMES = {"parent": (0.4, 0, 0), "child": (0, 0.3, 0), "sensor": (0, 0.3, 0.7)}


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("direction", ["parent_to_child", "child_to_parent"])
def test_tilted_frames_see_the_same_wrench_in_their_own_axes(frame: str, direction: str) -> None:
    mount = link("mount", "0 0 2 0.4 0 0") + joint("fixed", "world", "mount", name="fix")
    load = link("load", "0 0 2 0 0.3 0", mass=2, com="0 0.25 0")
    text = world(mount, load, joint("fixed", "mount", "load", ft(frame, direction, "0 0 0 0 0 0.7")))
    force, torque = read(text)
    axes = {"parent": (0.4, 0, 0), "child": (0, 0.3, 0)}.get(frame, (0, 0.3, 0))
    turn = Pose.from_rpy(0, 0, 0, *axes).matrix
    if frame == "sensor":
        turn = turn @ Pose.from_rpy(0, 0, 0, 0, 0, 0.7).matrix
    arm = Pose.from_rpy(0, 0, 0, 0, 0.3, 0).rotate((0, 0.25, 0))
    up = np.array((0, 0, 2 * G))
    sign = 1 if direction == "parent_to_child" else -1
    np.testing.assert_allclose(force, sign * up @ turn, atol=1e-9)
    np.testing.assert_allclose(torque, sign * np.cross(arm, up) @ turn, atol=1e-9)


def test_the_parents_axes_turn_with_the_parent() -> None:
    """The whole model rotates by a right angle, so the weight points along -y in the parent's axes."""
    parent = link("arm") + joint("revolute", "world", "arm", axis="1 0 0", name="hinge")
    text = world(parent, link("load", mass=2), joint("fixed", "arm", "load", ft("parent")))
    with simkit.load(text) as sim:
        sim.joint("m::hinge").set_position(math.pi / 2)
        sim.step()
        force, _ = wrench_of(sim.sensor("m::j::ft").latest)
    np.testing.assert_allclose(force, (0, 2 * G, 0), atol=1e-3)


# ------------------------------------------------------------------ motion


def test_a_spinning_mass_is_held_on_its_circle() -> None:
    """The force is m ω² r inwards, and the child's x axis points outwards."""
    text = world(link("arm", mass=2, com="0.5 0 0"), joint("revolute", "world", "arm", ft(), axis="0 0 1"))
    with simkit.load(text) as sim:
        sim.joint("m::j").set_velocity(3.0)
        sim.step(5)
        force, torque = wrench_of(sim.sensor("m::j::ft").latest)
    np.testing.assert_allclose(force, (-2 * 9 * 0.5, 0, 2 * G), atol=1e-6)
    np.testing.assert_allclose(torque, (0, -2 * G * 0.5, 0), atol=1e-6)


def test_the_wrench_includes_a_motors_effort_along_its_axis() -> None:
    """A force of 6 N accelerates 2 kg along a free rail at 3 m/s². The sensor measures this force and the weight."""
    text = world(link("cart", mass=2), joint("prismatic", "world", "cart", ft(), axis="1 0 0"))
    with simkit.load(text) as sim:
        sim.step()
        rail, sensor = sim.joint("m::j"), sim.sensor("m::j::ft")
        rail.set_effort(6.0)
        np.testing.assert_allclose(rail.transmitted_wrench[0], (6, 0, 2 * G), atol=1e-9)
        for _ in range(3):
            rail.set_effort(6.0)
            sim.step()
            np.testing.assert_allclose(wrench_of(sensor.latest)[0], (6, 0, 2 * G), atol=1e-9)
        before = sim.snapshot()
        sim.step()
        np.testing.assert_allclose(wrench_of(sensor.latest)[0], (0, 0, 2 * G), atol=1e-9)
        sim.restore(before)
        np.testing.assert_allclose(wrench_of(sensor.latest)[0], (6, 0, 2 * G), atol=1e-9)
        np.testing.assert_allclose(rail.transmitted_wrench[0], (6, 0, 2 * G), atol=1e-9)


def test_an_arm_that_a_motor_holds_is_not_in_free_fall() -> None:
    """A controller sets an effort at every step, so that the arm stays level: the torque balances the weight."""

    class Hold(simkit.WorldPlugin):
        def load(self, parent: Any, params: Any) -> None:
            self.joint = self.sim.joint("m::j")

        def before_step(self) -> None:
            self.joint.set_effort(-2 * G * 0.5)

    text = world(link("arm", mass=2, com="0.5 0 0"), joint("revolute", "world", "arm", ft(rate=100), axis="0 1 0"))
    with simkit.load(text, plugins=[Hold()]) as sim:
        sim.step(95)
        assert sim.joint("m::j").position == pytest.approx(0, abs=1e-9)
        force, torque = wrench_of(sim.sensor("m::j::ft").latest)
        np.testing.assert_allclose(force, (0, 0, 2 * G), atol=1e-6)
        np.testing.assert_allclose(torque, (0, -2 * G * 0.5, 0), atol=1e-6)


def test_the_joint_transmits_the_force_that_accelerates_its_load() -> None:
    """A servo pulls the cart; the joint transmits exactly the force that the load's acceleration needs."""
    cart = link("cart", mass=3) + joint("prismatic", "world", "cart", axis="1 0 0", name="rail")
    drive = (
        '<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">'
        "<joint_name>rail</joint_name><initial_velocity>0</initial_velocity><use_force_commands>true"
        "</use_force_commands><p_gain>100</p_gain></plugin>"
    )
    text = world(cart, link("load", mass=2), joint("fixed", "cart", "load", ft()), drive)
    with simkit.load(text) as sim:
        sub = sim.subscribe("/world/w/model/m/joint/j/sensor/ft/forcetorque")
        sim.link("m::cart").apply_wrench((10.0, 0, 0))
        force, _ = sim.joint("m::j").transmitted_wrench
        np.testing.assert_allclose(force, (10.0 / 5 * 2, 0, 2 * G), atol=1e-9)
        sim.step(3)
        assert xyz(sub.latest.wrench.force)[2] == pytest.approx(2 * G)


# ------------------------------------------------------------------ joints of every kind

HELD = {
    "fixed": ("", "", (0, 1, 2, 3, 4, 5)),
    "revolute": ("1 0 0", "", (0, 1, 2, 4, 5)),
    "continuous": ("1 0 0", "", (0, 1, 2, 4, 5)),
    "prismatic": ("1 0 0", "", (1, 2, 3, 4, 5)),
    "universal": ("1 0 0", "", (0, 1, 2, 5)),
    "ball": ("", "", (0, 1, 2)),
    "screw": ("1 0 0", SCREW, (1, 2, 4, 5)),
}


@pytest.mark.parametrize("kind", HELD)
@pytest.mark.parametrize("reverse", [False, True])
def test_every_kind_of_joint_transmits_the_wrench_of_the_motion(kind: str, reverse: bool) -> None:
    """By Newton's and Euler's equations, the sum of all forces on the load is its change of momentum."""
    axis, more, _ = HELD[kind]
    ends = ("load", "base") if reverse else ("base", "load")
    base = link("base", "0 0 2 0 0 0") + joint("fixed", "world", "base", name="fix")
    load = link("load", "0.1 0.2 2 0.2 0.1 0.3", mass=2, com="0.05 0.1 0.02")
    tag = ft("sensor", pose="0.02 0.03 0.04 0.5 0.2 0.1")
    text = world(base, load, joint(kind, *ends, more + tag, axis))
    with simkit.load(text) as sim:
        sim.step(40)
        assert sim.engine.names.joint("m::j").is_reversed is reverse
        sensor = sim.sensor("m::j::ft")
        force, torque = wrench_of(sensor.latest)
        place, load_link = sensor.pose, sim.link("m::load")
        force, torque = place.rotate(force), place.rotate(torque)
        if reverse:
            force, torque = -force, -torque
        # free body of the load: the engine gives the acceleration of its centre of mass, its rates and their change
        model, data = sim.mj_model, sim.engine.physics.fresh_accelerations()
        body = sim.engine.names.link("m::load").body
        com = data.xipos[body]
        acceleration, turning = load_link.linear_acceleration, load_link.angular_velocity
        alpha = data.cacc[body][:3]
        arm = com - load_link.pose.position
        acceleration = acceleration + np.cross(alpha, arm) + np.cross(turning, np.cross(turning, arm))
        inertia = np.eye(3) * 0.1
        np.testing.assert_allclose(force, 2 * (acceleration + np.array((0, 0, G))), atol=1e-6)
        about_com = torque + np.cross(place.position - com, force)
        np.testing.assert_allclose(about_com, inertia @ alpha, atol=1e-6)
        assert model.body_mass[body] == pytest.approx(2)


def test_a_joint_that_closes_a_loop_has_its_own_wrench() -> None:
    """A beam is on two legs, one in the kinematic tree and one in the loop: each joint carries half of its weight."""
    legs = "".join(
        link(n, f"0 {y} 0 0 0 0") + joint("fixed", "world", n, name=f"f{n}") for n, y in (("a", -1), ("b", 1))
    )
    beam = link("beam", mass=4)
    left = joint("revolute", "a", "beam", ft(), "1 0 0", "0 -1 0 0 0 0", name="left")
    right = joint("revolute", "b", "beam", ft(), "1 0 0", "0 1 0 0 0 0", name="right")
    text = world(legs, beam, left, right)
    with simkit.load(text) as sim:
        sim.step(300)
        assert sim.engine.names.joint("m::right").is_loop or sim.engine.names.joint("m::left").is_loop
        for name in ("left", "right"):
            force, torque = wrench_of(sim.sensor(f"m::{name}::ft").latest)
            assert force[2] == pytest.approx(2 * G, abs=0.05)
            np.testing.assert_allclose(torque, 0, atol=0.02)


def test_links_without_mass_transmit_the_weight_of_their_children() -> None:
    empty = '<link name="frame"><inertial><mass>0</mass></inertial></link>'
    text = world(
        link("base"),
        joint("fixed", "world", "base", name="fix"),
        empty,
        joint("fixed", "base", "frame", ft()),
        link("load", mass=2, com="0.5 0 0"),
        joint("revolute", "frame", "load", axis="0 0 1", name="hinge"),
    )
    force, torque = read(text, steps=10)
    np.testing.assert_allclose(force, (0, 0, 2 * G), atol=1e-6)
    np.testing.assert_allclose(torque, (0, -G, 0), atol=1e-6)


def test_a_joint_of_a_nested_model_is_found_by_its_scoped_name() -> None:
    nested = f'<model name="inner">{link("load", mass=2)}{joint("fixed", "world", "load", ft(rate=100))}</model>'
    with simkit.load(world(nested)) as sim:
        sim.step(10)
        sensor = sim.sensor("m::inner::j::ft")
        assert sensor.topic == "/world/w/model/m/model/inner/joint/j/sensor/ft/forcetorque"
        assert sensor.latest.header.frame_id == "m::inner::j::ft"
        np.testing.assert_allclose(wrench_of(sensor.latest)[0], (0, 0, 2 * G), atol=1e-9)


def test_a_urdf_robot_names_it_in_an_extension_of_the_joint() -> None:
    inertial = (
        '<inertial><origin xyz="0.5 0 0"/><mass value="2"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    text = f"""<robot name="m"><link name="world"/><link name="beam">{inertial}</link>
<joint name="j" type="fixed"><parent link="world"/><child link="beam"/><origin xyz="0 0 1" rpy="0 0 1"/></joint>
<gazebo reference="j"><provideFeedback>true</provideFeedback><disableFixedJointLumping>true</disableFixedJointLumping>
{ft(rate=100)}</gazebo></robot>"""
    force, torque = read(text, steps=10)
    np.testing.assert_allclose(force, (0, 0, 2 * G), atol=1e-6)
    np.testing.assert_allclose(torque, (0, -G, 0), atol=1e-6)


def test_a_sensor_on_a_static_models_joint_reads_zero_and_warns() -> None:
    text = world(link("a"), link("b"), joint("fixed", "a", "b", ft()), model="<static>true</static>")
    with simkit.load(text) as sim:
        sim.step()
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-050"] == ["warning"]
        np.testing.assert_allclose(wrench_of(sim.sensor("m::j::ft").latest), 0)


def test_on_a_joint_of_the_world_itself_a_sensor_is_left_out_and_reported() -> None:
    tie = joint("fixed", "world", "m::a", ft())
    with simkit.load(world(link("a"), others=tie)) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-053"] == ["warning"]
        assert not sim.contents.sensors


def test_on_a_link_the_sensor_is_left_out_and_reported() -> None:
    with simkit.load(world(link("a", more=ft()))) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-024"] == ["warning"]
        assert not sim.contents.sensors


# ------------------------------------------------------------------ loads

SHAPE = '<collision name="c"><geometry><box><size>0.4 0.4 0.1</size></box></geometry></collision>'


def loaded_scale(frame: str = "child") -> str:
    plate = link("plate", "0 0 1 0 0 0", mass=0.2, more=SHAPE) + joint("fixed", "world", "plate", ft(frame, rate=100))
    weight = f'<model name="weight"><pose>0.05 0 1.1 0 0 0</pose>{link("l", mass=10, more=SHAPE)}</model>'
    return world(plate, others=weight)


def test_the_weight_of_a_load_at_rest_is_constant() -> None:
    """The plate never moves, and a load on it would fall asleep; a sleeping load would have no contact forces."""
    with simkit.load(loaded_scale()) as sim:
        for seconds in (1.0, 3.0):
            sim.run(seconds)
            force, torque = wrench_of(sim.sensor("m::j::ft").latest)
            np.testing.assert_allclose(force, (0, 0, 10.2 * G), atol=1e-3)
            np.testing.assert_allclose(torque, (0, -10 * G * 0.05, 0), atol=1e-3)


def test_two_nested_models_without_a_joint_touch_each_other() -> None:
    """One model contains a scale and its weight, as in Gazebo's own world for this sensor."""
    scale = f'<model name="scale">{link("plate", more=SHAPE)}{joint("fixed", "world", "plate", ft())}</model>'
    weight = f'<model name="weight"><pose>0 0 0.1 0 0 0</pose>{link("l", mass=10, more=SHAPE)}</model>'
    force, _ = read(world(scale, weight), steps=300, name="m::scale::j::ft")
    assert force[2] == pytest.approx(11 * G, abs=1e-3)


# ------------------------------------------------------------------ the sensor itself


def test_topic_rate_and_noise_per_channel() -> None:
    noisy = (
        f"<force><x>{noise(0.5)}</x><z>{noise(0, mean=3)}</z></force><torque><y>"
        '<noise type="gaussian_quantized"><precision>0.25</precision></noise></y></torque>'
    )
    text = world(
        link("beam", mass=2, com="0.5 0 0"),
        joint("fixed", "world", "beam", ft(more=noisy, rate=500, extra="<topic>ft</topic>")),
    )
    with simkit.load(text) as sim:
        sub = sim.subscribe("/ft")
        sim.run(2.0)
        assert sim.topics()["/ft"] == "geometry_msgs/msg/WrenchStamped"
        assert len(sub.messages) == 1001
        forces = np.array([xyz(m.wrench.force) for m in sub.messages])
        torques = np.array([xyz(m.wrench.torque) for m in sub.messages])
        np.testing.assert_allclose(forces.std(axis=0), (0.5, 0, 0), rtol=0.1, atol=1e-9)
        np.testing.assert_allclose(forces[:, 2], 2 * G + 3)
        np.testing.assert_allclose(torques[:, 1], -9.75)
        truth = wrench_of(sim.sensor("m::j::ft").truth)
        np.testing.assert_allclose(truth, ((0, 0, 2 * G), (0, -G, 0)), atol=1e-9)


def test_a_reading_that_is_computed_later_is_the_same() -> None:
    text = world(link("arm", mass=2, com="0.5 0 0"), joint("revolute", "world", "arm", ft(rate=50), axis="0 1 0"))
    with simkit.load(text) as heard, simkit.load(text) as unheard:
        sub = heard.subscribe("/world/w/model/m/joint/j/sensor/ft/forcetorque")
        heard.step(130)
        unheard.step(130)
        late = unheard.sensor("m::j::ft").latest
        assert sub.latest.header.stamp.nanosec == late.header.stamp.nanosec == 120_000_000
        np.testing.assert_array_equal(wrench_of(sub.latest), wrench_of(late))


@pytest.mark.parametrize(
    "wrong", ["<frame>joint</frame>", "<measure_direction>up</measure_direction>", "<frame>Child</frame>"]
)
def test_an_invalid_value_is_an_error(wrong: str) -> None:
    tag = f'<sensor name="ft" type="force_torque"><force_torque>{wrong}</force_torque></sensor>'
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(world(link("a"), joint("fixed", "world", "a", tag)))

"""`<gazebo>` in URDF: sensors, plugins, surfaces, materials, added joints; and robots that SDF files include."""

from __future__ import annotations

import numpy as np
from urdf_robots import LIMIT, MASS, errors, joint, link, robot, with_code

import simkit

BALL = '<collision><geometry><sphere radius="1"/></geometry></collision>'
LOOK = '<visual><geometry><sphere radius="1"/></geometry></visual>'


def gazebo(content: str, reference: str = "") -> str:
    named = f' reference="{reference}"' if reference else ""
    return f"<gazebo{named}>{content}</gazebo>\n"


def test_blocks_with_the_same_reference_are_joined_and_later_values_override_earlier_ones(load):
    text = robot(
        link("l", MASS + BALL)
        + gazebo("<mu1>0.1</mu1><kp>1000</kp>", "l")
        + gazebo('<mu1 value="0.5"/><mu2>0.25</mu2><fdir1>0 1 0</fdir1><selfCollide>true</selfCollide>', "l")
        + gazebo("<turnGravityOff>true</turnGravityOff><dampingFactor>0.1</dampingFactor>", "l")
    )
    model = load(text)[0].model
    surface = model.links[0].collisions[0].surface
    assert (surface.mu, surface.mu2, surface.kp, surface.fdir1) == (0.5, 0.25, 1000, (0, 1, 0))
    assert (model.links[0].self_collide, model.links[0].gravity) == (True, False)
    assert model.links[0].velocity_decay == (0.1, 0.1)


def test_sensors_stay_on_their_own_link_after_a_fixed_joint(load):
    text = robot(
        link("a")
        + link("mast", "")
        + joint("m", "a", "mast", '<origin xyz="0 0 2"/>', "fixed")
        + gazebo('<sensor name="eye" type="imu"><update_rate>50</update_rate><pose>1 0 0 0 0 0</pose></sensor>', "mast")
        + gazebo('<sensor name="rel" type="imu"><pose relative_to="a">0 0 5 0 0 0</pose></sensor>', "mast")
    )
    scene, found = load(text)
    eye, rel = scene.model.links[1].sensors
    assert (eye.scoped, eye.rate) == ("r::mast::eye", 50)
    np.testing.assert_allclose(eye.pose_world.position, (1, 0, 2))
    np.testing.assert_allclose(rel.pose_world.position, (0, 0, 5))
    assert not errors(found)


def test_a_sensor_on_a_joint_and_the_spring_of_a_joint(load):
    text = robot(
        link("a")
        + link("b")
        + joint("j", "a", "b")
        + gazebo(
            '<sensor name="ft" type="force_torque"/><springStiffness>2</springStiffness>'
            "<springReference>0.5</springReference><provideFeedback>true</provideFeedback>",
            "j",
        )
    )
    scene, found = load(text)
    (j,) = scene.model.joints
    assert (j.sensors[0].scoped, j.sensors[0].on_joint) == ("r::j::ft", True)
    assert (j.axes[0].stiffness, j.axes[0].spring_ref) == (2, 0.5)
    assert "<provideFeedback>" in with_code(found, "SK-URDF-022")[0].message


def test_a_force_sensor_on_a_joint_without_load_is_refused(load):
    text = robot(
        link("a")
        + link("b", "")
        + joint("j", "a", "b", "", "fixed")
        + gazebo('<sensor name="ft" type="force_torque"/>', "j")
    )
    assert "it would always read zero" in with_code(load(text)[1], "SK-URDF-023")[0].message


def test_gazebo_blocks_can_contain_sdf_materials_and_surfaces(load):
    text = robot(
        link("l", MASS + BALL + LOOK)
        + gazebo("<material>Gazebo/Red</material>", "l")
        + gazebo(
            "<visual><transparency>0.5</transparency></visual><collision><surface><friction><ode><mu>0.3</mu>"
            "</ode></friction></surface></collision><laserRetro>7</laserRetro>",
            "l",
        )
    )
    body = load(text)[0].model.links[0]
    assert body.visuals[0].material.diffuse == (1, 0, 0, 1)
    assert (body.visuals[0].transparency, body.collisions[0].surface.mu) == (0.5, 0.3)
    assert body.collisions[0].laser_retro == 7


def test_the_robot_has_plugins_in_order_and_can_be_static(load):
    text = robot(
        link("l")
        + gazebo('<plugin name="one" filename="a.so"/><static>true</static>')
        + gazebo('<plugin name="two" filename="b.so"/>')
    )
    model = load(text)[0].model
    assert [p.name for p in model.plugins] == ["one", "two"]
    assert model.static


def test_an_sdf_joint_in_a_gazebo_block_closes_a_loop(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + joint("ab", "a", "b")
        + joint("ac", "a", "c")
        + gazebo('<joint name="rod" type="ball"><parent>b</parent><child>c</child></joint>')
    )
    scene, found = load(text)
    rod = scene.model.joints[-1]
    assert (rod.scoped, rod.type, rod.parent_link, rod.child_link) == ("r::rod", "ball", "r::b", "r::c")
    assert not errors(found)


def test_unknown_gazebo_elements_are_reported_once_with_the_closest_name(load):
    text = robot(link("l", MASS + BALL) + gazebo("<mu11>1</mu11>", "l") + gazebo("<mu11>2</mu11>", "l"))
    (problem,) = with_code(load(text)[1], "SK-URDF-010")
    assert "2 times" in problem.message
    assert problem.hint.startswith("did you mean 'mu")


def test_a_sensor_of_a_urdf_robot_publishes_measurements():
    text = robot(
        link("l", MASS + BALL)
        + gazebo('<sensor name="imu" type="imu"><always_on>1</always_on><update_rate>100</update_rate></sensor>', "l")
    )
    with simkit.load(text, base="fixed") as sim:
        sim.run(0.1)
        assert abs(sim.sensor("r::l::imu").latest.linear_acceleration.z - 9.8) < 1e-6


# ---------------------------------------------------------------------- inside SDF


def test_an_sdf_world_can_include_robots_with_poses_and_joints(load, write):
    text = robot(link("base") + link("arm") + joint("j", "base", "arm", f'<origin xyz="0 0 1"/>{LIMIT}'), "bot")
    root = write("models/bot/bot.urdf", text).parents[1]
    write("models/bot/model.config", "<model><name>bot</name><urdf>bot.urdf</urdf></model>")
    world = """<sdf version="1.9"><world name="w">
      <include><uri>model://bot</uri><name>a</name><pose>1 2 3 0 0 1.5707963267948966</pose></include>
      <include><uri>model://bot/bot.urdf</uri><name>b</name><pose relative_to="a::arm">0 0 1 0 0 0</pose>
        <placement_frame>arm</placement_frame><plugin name="p" filename="p.so"/><static>1</static></include>
      <joint name="hold" type="fixed"><parent>world</parent><child>a::base</child></joint></world></sdf>"""
    scene, found = load(world, (root,))
    a, b = scene.world.models
    np.testing.assert_allclose(a.links[1].pose_world.position, (1, 2, 4), atol=1e-12)
    np.testing.assert_allclose(b.links[1].pose_world.position, (1, 2, 5), atol=1e-12)
    assert (a.links[1].scoped, a.links[1].inertial.mass) == ("a::arm", 1)
    assert (b.static, [p.filename for p in b.plugins]) == (True, ["p.so"])
    assert scene.world.joints[0].child_link == "a::base"
    assert not errors(found)
    assert not with_code(found, "SK-URDF-017")


def test_a_robot_that_is_fixed_by_a_link_named_world_can_be_included(load, write):
    text = robot(link("base") + '<link name="world"/>' + joint("mount", "world", "base", "", "fixed"), "bot")
    file = write("bot.urdf", text)
    world = '<sdf version="1.9"><world name="w"><include><uri>bot.urdf</uri><pose>0 0 1 0 0 0</pose></include>'
    scene, found = load(world + "</world></sdf>", (file.parent,))
    assert not errors(found)
    (bot,) = scene.world.models
    assert bot.joints[0].type == "fixed"
    np.testing.assert_allclose(bot.links[0].pose_world.position, (0, 0, 1), atol=1e-12)


def test_a_nested_robot_has_the_scoped_name_of_the_outer_model(load, write):
    root = write("models/bot/bot.urdf", robot(link("base"), "bot")).parents[1]
    text = """<sdf version="1.9"><model name="cart"><link name="l"/><include><uri>model://bot</uri></include>
      <joint name="j" type="fixed"><parent>l</parent><child>bot::base</child></joint></model></sdf>"""
    scene, found = load(text, (root,))
    assert scene.model.models[0].links[0].scoped == "cart::bot::base"
    assert not errors(found)

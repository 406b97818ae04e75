"""Elements of a model: mass, shapes, surfaces, materials, joints, sensors, lights, worlds."""

from __future__ import annotations

import math

import numpy as np
import pytest


def body(inside: str, version: str = "1.11") -> str:
    return f'<sdf version="{version}"><model name="m"><link name="l">{inside}</link></model></sdf>'


def joint(inside: str, kind: str = "revolute", version: str = "1.9") -> str:
    return (
        f'<sdf version="{version}"><model name="m"><link name="a"/><link name="b"/>'
        f'<joint name="j" type="{kind}"><parent>a</parent><child>b</child>{inside}</joint></model></sdf>'
    )


def codes(found: list) -> set[str]:
    return {d.code for d in found if d.severity != "note"}


def test_a_link_without_inertial_has_a_mass_of_1_kg(load):
    scene, found = load(body(""))
    inertial = scene.model.links[0].inertial
    assert (inertial.mass, inertial.inertia[:3], inertial.given) == (1.0, (1.0, 1.0, 1.0), False)
    assert [(d.code, d.severity) for d in found] == [("SK-SDF-015", "note")]


def test_the_inertia_is_turned_into_link_axes(load):
    scene, _ = load(
        body("""<inertial><mass>2</mass><pose>0.1 0 0 0 0 1.5707963267948966</pose>
        <inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia></inertial>""")
    )
    inertial = scene.model.links[0].inertial
    assert inertial.com == (0.1, 0, 0)
    np.testing.assert_allclose(inertial.inertia, (2, 1, 2.5, 0, 0, 0), atol=1e-12)


def test_automatic_inertia_of_two_boxes_uses_parallel_axes_and_the_mass_of_the_file(load):
    box = '<collision name="{}"><pose>{} 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry></collision>'
    scene, _ = load(body('<inertial auto="true"><mass>4</mass></inertial>' + box.format("c", -1) + box.format("d", 1)))
    inertial = scene.model.links[0].inertial
    assert inertial.mass == 4
    np.testing.assert_allclose(inertial.com, (0, 0, 0), atol=1e-12)
    np.testing.assert_allclose(inertial.inertia, (4 / 6, 4 / 6 + 4, 4 / 6 + 4, 0, 0, 0), atol=1e-12)


@pytest.mark.parametrize(
    ("inertial", "code", "severity"),
    [
        ("<mass>-1</mass>", "SK-SDF-013", "error"),
        ("<mass>0</mass>", "SK-SDF-029", "warning"),
        ("<mass>nan</mass>", "SK-PARAM-002", "error"),
        ("<inertia><ixx>-1</ixx></inertia>", "SK-SDF-013", "error"),
        ("<inertia><ixx>1</ixx><iyy>1</iyy><izz>3</izz></inertia>", "SK-SDF-014", "warning"),
    ],
)
def test_impossible_masses_are_reported(load, inertial, code, severity):
    _, found = load(body(f"<inertial>{inertial}</inertial>"))
    assert [(d.code, d.severity) for d in found] == [(code, severity)]


@pytest.mark.parametrize(
    "shape",
    ["<box><size>0 1 1</size></box>", "<sphere><radius>-1</radius></sphere>", "<plane><normal>0 0 0</normal></plane>"],
)
def test_shapes_without_a_positive_size_are_errors(load, shape):
    _, found = load(body(f'<collision name="c"><geometry>{shape}</geometry></collision>'))
    assert codes(found) == {"SK-SDF-009"}


def test_friction_falls_back_to_the_other_engine_and_to_one(load):
    shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    scene, _ = load(
        body(
            f'<collision name="a">{shape}<surface><friction><bullet><friction>0.3</friction><friction2>0.2</friction2>'
            f"</bullet></friction><contact><ode><kp>1e6</kp></ode><collide_bitmask>0x02</collide_bitmask></contact></surface>"
            f'</collision><collision name="b">{shape}</collision>'
        )
    )
    first, second = (c.surface for c in scene.model.links[0].collisions)
    assert (first.mu, first.mu2, first.kp, first.kd, first.collide_bitmask) == (0.3, 0.2, 1e6, None, 2)
    assert (second.mu, second.kp, second.collide_bitmask) == (1.0, None, 0xFFFF)


def test_a_material_script_is_a_colour_and_three_numbers_are_opaque(load):
    shape = "<geometry><empty/></geometry>"
    scene, _ = load(
        body(
            f'<visual name="a">{shape}<material><script><name>Gazebo/Red</name></script></material></visual>'
            f'<visual name="b">{shape}<material><diffuse>0.1 0.2 0.3</diffuse></material></visual>'
            f'<visual name="c">{shape}</visual>'
        )
    )
    red, own, none = (v.material for v in scene.model.links[0].visuals)
    assert (red.diffuse, own.diffuse, none) == ((1, 0, 0, 1), (0.1, 0.2, 0.3, 1), None)


@pytest.mark.parametrize("lower", ["-1e16", "-inf", "-1e308"])
def test_every_spelling_of_no_limit_is_infinite(load, lower):
    scene, _ = load(joint(f"<axis><limit><lower>{lower}</lower><effort>-1</effort></limit></axis>"))
    axis = scene.model.joints[0].axes[0]
    assert (axis.lower, axis.upper, axis.effort, axis.velocity) == (-math.inf, math.inf, math.inf, math.inf)


def test_an_old_thread_pitch_is_turned_into_metres_per_turn(load):
    scene, _ = load(joint("<thread_pitch>-62.83185307179586</thread_pitch><axis/>", "screw", "1.6"))
    assert scene.model.joints[0].thread_pitch == pytest.approx(0.1)


def test_a_mimic_names_its_leader(load):
    scene, found = load("""<sdf version="1.11"><model name="m"><link name="a"/><link name="b"/><link name="c"/>
      <joint name="j" type="revolute"><parent>a</parent><child>b</child><axis/></joint>
      <joint name="k" type="revolute"><parent>a</parent><child>c</child><axis>
        <mimic joint="j" axis="axis"><multiplier>2</multiplier><offset>1</offset></mimic>
      </axis></joint></model></sdf>""")
    mimic = scene.model.joints[1].axes[0].mimic
    assert not codes(found)
    assert (mimic.joint, mimic.multiplier, mimic.offset) == ("m::j", 2, 1)


def test_an_unknown_name_is_an_error_with_the_closest_name(load):
    _, found = load(joint("<axis/>").replace("<parent>a<", "<parent>aa<"))
    (error,) = [d for d in found if d.severity == "error"]
    assert (error.code, error.hint) == ("SK-SDF-004", "did you mean 'a'?")


def test_the_links_of_a_joint_with_an_unknown_type_are_also_checked(load):
    _, found = load(joint("<axis/>", "revolut").replace("<parent>a<", "<parent>aa<"))
    assert sorted(d.code for d in found if d.severity == "error") == ["SK-SDF-004", "SK-SDF-008"]


def test_all_problems_are_reported_in_one_pass(load):
    text = joint("<axis><xyz>0 0 0</xyz></axis>").replace(
        '<link name="a"/>', '<link name="a"/><link name="a"/><lnik name="z"/>'
    )
    _, found = load(text)
    assert codes(found) == {"SK-SDF-002", "SK-SDF-011", "SK-SDF-017"}


def test_a_sensor_keeps_its_parameters_and_lists_its_plugins(load):
    scene, found = load(
        body("""<pose>0 0 1 0 0 0</pose><sensor name="s" type="imu"><pose>0 0 1 0 0 0</pose>
        <update_rate>50</update_rate>
        <topic>t</topic><imu><noise/></imu><plugin name="p" filename="libp.so"><k>1</k></plugin></sensor>""")
    )
    (sensor,) = scene.model.all_sensors()
    assert (sensor.scoped, sensor.kind, sensor.rate, sensor.topic) == ("m::l::s", "imu", 50.0, "t")
    assert tuple(sensor.pose_world.position) == (0, 0, 2)
    assert sensor.params.has("imu") and not sensor.params.has("plugin")
    assert (sensor.plugins[0].scoped, sensor.plugins[0].params.number("k")) == ("m::l::s", 1.0)
    assert not codes(found)


def test_a_custom_sensor_has_the_kind_of_its_gz_type(load):
    scene, _ = load(body('<sensor name="s" type="custom" gz:type="solar"/>'))
    assert scene.model.all_sensors()[0].kind == "solar"


def test_a_world_has_its_physics_gravity_and_geographic_position(load):
    scene, _ = load("""<sdf version="1.6"><world name="w"><physics name="a"><max_step_size>0.1</max_step_size></physics>
      <physics name="b" default="true"><max_step_size>0.002</max_step_size></physics><gravity>0 0 -1.6</gravity>
      <magnetic_field>1e-5 0 0</magnetic_field><scene><shadows>false</shadows></scene>
      <spherical_coordinates><latitude_deg>90</latitude_deg></spherical_coordinates>
      <light name="sun" type="directional"><direction>0 0 -2</direction></light></world></sdf>""")
    world = scene.world
    assert (world.physics.max_step_size, world.gravity, world.magnetic_field) == (0.002, (0, 0, -1.6), (1e-5, 0, 0))
    assert world.spherical_coordinates.latitude == pytest.approx(math.pi / 2)
    assert (world.surroundings.shadows, world.lights[0].direction) == (False, (0, 0, -1))


def test_sdf_1_0_with_its_attributes_is_read(load):
    scene, found = (
        load("""<gazebo version="1.0"><world name="w"><physics type="ode"><gravity xyz="0 0 -9.81"/></physics>
      <model name="m" static="false"><origin pose="0 0 2 0 0 0"/><link name="l">
      <inertial mass="10"><inertia ixx="2"/></inertial><collision name="c">
      <geometry><cylinder radius="0.1" length="1"/></geometry></collision></link></model></world></gazebo>""")
    )
    assert not [d for d in found if d.severity == "error"]
    model = scene.world.models[0]
    assert (scene.world.gravity[2], model.pose_world.position[2], model.links[0].inertial.mass) == (-9.81, 2, 10)
    assert model.links[0].collisions[0].geometry.length == 1


def test_an_unknown_root_element_is_an_error_that_lists_the_known_ones(load):
    _, found = load("<wrold/>")
    assert found[0].code == "SK-LOAD-003"
    assert "<sdf>" in found[0].message


def test_a_missing_file_is_an_error(load, tmp_path):
    scene, found = load(tmp_path / "no.sdf")
    assert [d.code for d in found] == ["SK-LOAD-002"]
    assert scene.model is None


def test_a_negative_slip_is_reported_and_becomes_zero(load):
    scene, found = load(
        body("""<collision name="c"><geometry><sphere><radius>1</radius></sphere></geometry><surface><friction><ode>
        <mu>1</mu><mu2>1</mu2><slip1>-0.1</slip1><slip2>0.2</slip2></ode></friction></surface></collision>""")
    )
    surface = scene.model.links[0].collisions[0].surface
    assert (surface.slip1, surface.slip2) == (0.0, 0.2)
    warnings = [d for d in found if d.code == "SK-SDF-030"]
    assert [(d.severity, d.line) for d in warnings] == [("warning", 2)]
    assert "<slip1> is -0.1 and cannot be negative; 0 is used" in warnings[0].message


def test_one_number_scales_a_mesh_along_all_axes_with_a_warning(load, tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    text = f'<visual name="v"><geometry><mesh><uri>{tmp_path}/a.obj</uri><scale>2</scale></mesh></geometry></visual>'
    scene, found = load(body(text))
    assert scene.model.links[0].visuals[0].geometry.scale == (2.0, 2.0, 2.0)
    told = [(d.severity, d.hint) for d in found if d.code == "SK-MESH-017"]
    assert told == [("warning", "write <scale>2 2 2</scale>")]


def test_a_shape_or_sensor_in_an_unknown_frame_stays_in_its_link_with_a_warning(load):
    shape = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    inside = f"""<collision name="c"><pose relative_to="wheel">1 0 0 0 0 0</pose>{shape}</collision>
        <sensor name="s" type="imu"><pose relative_to="ll">0 2 0 0 0 0</pose></sensor>"""
    scene, found = load(body(inside))
    link = scene.model.links[0]
    assert link.collisions[0].pose_link.position.tolist() == [1, 0, 0]
    assert link.sensors[0].pose_link.position.tolist() == [0, 2, 0]
    warnings = sorted((d.code, d.message.split(":")[0]) for d in found if d.severity != "note")
    assert warnings == [("SK-SDF-040", "collision 'c' of link 'l'"), ("SK-SDF-040", "sensor 's'")]

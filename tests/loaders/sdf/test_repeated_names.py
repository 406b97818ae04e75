"""Repeated names: the elements that get another name or are left out with a warning, as in Gazebo."""

from __future__ import annotations

from pathlib import Path

import simkit

SHAPE = "<geometry><sphere><radius>{}</radius></sphere></geometry>"


def world(content: str, version: str = "1.6") -> str:
    return f'<sdf version="{version}"><world name="w">{content}</world></sdf>'


def warnings(found: list, code: str) -> list[str]:
    assert not [d for d in found if d.severity == "error"]
    return [d.message for d in found if d.severity == "warning" and d.code == code]


def test_collisions_and_visuals_of_one_name_are_numbered(load):
    shapes = "".join(
        f'<{kind} name="s">{SHAPE.format(radius)}</{kind}>' for kind in ("collision", "visual") for radius in (1, 2, 3)
    )
    shapes += f'<collision name="s_0">{SHAPE.format(4)}</collision>'
    scene, found = load(f'<sdf version="1.9"><model name="m"><link name="l">{shapes}</link></model></sdf>')
    link = scene.model.links[0]
    assert [(c.name, c.geometry.radius) for c in link.collisions] == [("s", 1), ("s_1", 2), ("s_2", 3), ("s_0", 4)]
    assert [v.scoped for v in link.visuals] == ["m::l::s", "m::l::s_0", "m::l::s_1"]
    assert len(warnings(found, "SK-SDF-002")) == 4


def test_the_second_sensor_of_a_name_is_left_out(load):
    sensors = '<sensor name="s" type="imu"/><sensor name="s" type="altimeter"/>'
    scene, found = load(f'<sdf version="1.9"><model name="m"><link name="l">{sensors}</link></model></sdf>')
    assert [s.kind for s in scene.model.links[0].sensors] == ["imu"]
    assert "left out" in warnings(found, "SK-SDF-002")[0]


def test_models_of_one_name_are_numbered_as_in_gazebo_classic(load):
    wall = '<model name="wall"><static>1</static><pose>{} 0 0 0 0 0</pose><link name="l"/></model>'
    text = world("".join(wall.format(x) for x in range(3)) + wall.format(9).replace('"wall"', '"wall_0"'))
    scene, found = load(text)
    places = {m.name: m.pose_world.position[0] for m in scene.world.models}
    assert places == {"wall": 0, "wall_1": 1, "wall_2": 2, "wall_0": 9}
    assert "this one is named 'wall_2'" in warnings(found, "SK-SDF-002")[1]
    simkit.load(text).close()


def test_the_second_light_of_a_name_is_left_out(load):
    light = '<light name="sun" type="directional"><pose>0 0 {} 0 0 0</pose></light>'
    scene, found = load(world(light.format(10) + light.format(20)))
    assert [light.pose_world.position[2] for light in scene.world.lights] == [10]
    assert warnings(found, "SK-SDF-002")


def test_a_joint_or_frame_with_the_name_of_a_link_gets_the_suffix_of_libsdformat(load):
    content = """<model name="m"><link name="a"/><link name="b"/><frame name="a"/>
      <joint name="b" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>
      <joint name="b_joint" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>
      </model>"""
    for version in ("1.6", "1.9"):
        scene, found = load(world(content, version))
        (model,) = scene.world.models
        assert [j.name for j in model.joints] == ["b_joint0", "b_joint"]
        assert [f.name for f in model.frames] == ["a_frame"]
        assert model.joints[0].child_link == "m::b"
        assert len(warnings(found, "SK-SDF-024")) == 2


def test_a_plugin_finds_the_joint_by_the_name_in_the_file(tmp_path: Path):
    inertial = "<inertial><mass>1</mass></inertial>"
    text = world(f"""<model name="m"><link name="a">{inertial}</link><link name="b">{inertial}</link>
      <joint name="b" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>
      <plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
      <joint_name>b</joint_name><initial_velocity>2</initial_velocity></plugin></model>""")
    with simkit.load(text) as sim:
        sim.run(0.5)
        assert abs(sim.joint("m::b_joint").velocity - 2.0) < 0.05

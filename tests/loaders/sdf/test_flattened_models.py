"""Names with `::` in files before 1.8, which represent nested models."""

from __future__ import annotations

import pytest

FLAT = """<sdf version="{}"><model name="m"><link name="a"/>
  <frame name="arm::__model__" attached_to="arm::hand"><pose relative_to="__model__">1 2 3 0 0 0</pose></frame>
  <link name="arm::hand"><pose relative_to="arm::__model__">0 0 1 0 0 0</pose></link>
  <frame name="arm::tool::__model__" attached_to="arm::tool::tip">
    <pose relative_to="arm::__model__">0 1 0 0 0 0</pose></frame>
  <link name="arm::tool::tip"><pose relative_to="arm::tool::__model__">1 0 0 0 0 0</pose></link>
  <joint name="arm::j" type="revolute"><parent>arm::hand</parent><child>arm::tool::tip</child>
    <axis><xyz expressed_in="arm::__model__">0 0 1</xyz></axis></joint>
  <joint name="k" type="fixed"><parent>a</parent><child>arm::hand</child></joint>
  <plugin name="p" filename="p"><joint_name>arm::j</joint_name></plugin></model></sdf>"""


@pytest.mark.parametrize("version", ["1.6", "1.7"])
def test_a_flattened_model_is_nested_again(load, version):
    scene, found = load(FLAT.format(version))
    assert not [d for d in found if d.severity != "note"]
    m, arm, tool = scene.model.all_models()
    assert [x.scoped for x in (m, arm, tool)] == ["m", "m::arm", "m::arm::tool"]
    assert tuple(arm.pose_world.position) == (1, 2, 3) and arm.canonical_link == "m::arm::hand"
    assert tuple(arm.links[0].pose_world.position) == (1, 2, 4)
    assert tuple(tool.links[0].pose_world.position) == (2, 3, 3)
    assert [(j.scoped, j.parent_link, j.child_link) for j in scene.model.all_joints()] == [
        ("m::k", "m::a", "m::arm::hand"),
        ("m::arm::j", "m::arm::hand", "m::arm::tool::tip"),
    ]
    assert m.plugins[0].params.text("joint_name") == "arm::j"


def test_from_sdf_1_8_on_a_name_with_the_separator_is_an_error(load):
    _, found = load(FLAT.format("1.8"))
    assert {d.code for d in found if d.severity == "error"} == {"SK-SDF-003"}


def test_collisions_and_visuals_keep_names_with_the_separator(load):
    scene, _ = load(
        '<sdf version="1.7"><model name="m"><link name="l"><collision name="a::b"><geometry><box/></geometry>'
        "</collision></link></model></sdf>"
    )
    assert scene.model.links[0].collisions[0].name == "a::b"

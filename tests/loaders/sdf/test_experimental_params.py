"""`<experimental:params>`: an include changes its model."""

from __future__ import annotations

import pytest

ARM = """<sdf version="1.9"><model name="arm">
  <link name="base"><inertial><mass>2</mass></inertial>
    <visual name="look"><geometry><box><size>1 1 1</size></box></geometry></visual>
    <sensor name="eye" type="camera"><update_rate>10</update_rate><topic>eye</topic></sensor></link>
  <link name="tip"><inertial><mass>1</mass></inertial></link>
  <joint name="j" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 0 1</xyz></axis></joint>
  <include><uri>model://box</uri><name>cargo</name></include>
</model></sdf>"""
BOX = '<sdf version="1.9"><model name="box"><link name="l"><inertial><mass>3</mass></inertial></link></model></sdf>'


@pytest.fixture
def arm(load, write):
    """Return a function arm(changes) that returns the changed arm, an unchanged arm, and the errors."""
    root = write("models/arm/model.sdf", ARM).parents[1]
    write("models/box/model.sdf", BOX)

    def _arm(changes: str):
        scene, found = load(
            '<sdf version="1.9"><world name="w"><include><uri>model://arm</uri><name>changed</name>\n'
            f"<experimental:params>{changes}</experimental:params></include>"
            "<include><uri>model://arm</uri></include></world></sdf>",
            (root,),
        )
        changed, unchanged = scene.world.models
        return changed, unchanged, [d for d in found if d.severity == "error"]

    return _arm


def test_children_have_actions_if_the_element_has_none(arm):
    changed, unchanged, errors = arm(
        '<link element_id="base"><visual name="ball" action="add"><geometry><sphere><radius>2</radius></sphere>'
        '</geometry></visual><visual name="look" action="remove"/>'
        '<sensor name="eye" action="modify"><update_rate>30</update_rate></sensor>'
        '<inertial action="replace"><mass>7</mass></inertial></link>'
    )
    assert not errors
    base, same = changed.links[0], unchanged.links[0]
    assert [v.name for v in base.visuals] == ["ball"] and [v.name for v in same.visuals] == ["look"]
    assert (base.sensors[0].rate, base.sensors[0].topic, same.sensors[0].rate) == (30, "eye", 10)
    assert (base.inertial.mass, same.inertial.mass) == (7, 2)


def test_whole_elements_are_added_removed_modified_and_replaced(arm):
    changed, _, errors = arm(
        '<link element_id="" name="extra" action="add"><pose relative_to="tip">0 0 1 0 0 0</pose></link>'
        '<visual element_id="base::look" action="remove"/>'
        '<joint element_id="j" action="replace" type="fixed"><parent>base</parent><child>tip</child></joint>'
        '<link element_id="tip" action="modify"><inertial><mass>9</mass></inertial></link>'
    )
    assert not errors
    assert [link.name for link in changed.links] == ["base", "tip", "extra"]
    assert tuple(changed.links[2].pose_world.position) == (0, 0, 1)
    assert changed.links[0].visuals == ()
    assert [(j.name, j.type) for j in changed.joints] == [("j", "fixed")]
    assert changed.links[1].inertial.mass == 9


def test_a_path_can_lead_into_a_nested_include(arm):
    changed, unchanged, errors = arm(
        '<link element_id="cargo::l"><inertial action="modify"><mass>5</mass></inertial></link>'
    )
    assert not errors
    assert (changed.models[0].links[0].inertial.mass, unchanged.models[0].links[0].inertial.mass) == (5, 3)
    changed, _, errors = arm('<model element_id="cargo" action="remove"/>')
    assert not errors and changed.models == ()


def test_a_removal_with_children_removes_only_these_children(arm):
    changed, _, errors = arm('<sensor element_id="base::eye" action="remove"><topic/></sensor>')
    assert not errors
    assert (changed.links[0].sensors[0].topic, changed.links[0].sensors[0].rate) == ("", 10)


@pytest.mark.parametrize(
    ("change", "expected_text"),
    [
        ('<link action="remove"/>', "needs element_id="),
        ('<link element_id="bas" action="remove"/>', "did you mean 'base'?"),
        ('<link element_id="base::" action="remove"/>', "no name after"),
        ('<link element_id="base" action="delete"/>', "add, modify, remove, replace"),
        ('<link element_id="" action="add"/>', "needs a name"),
        ('<link element_id="" name="tip" action="add"/>', "already"),
        ('<link element_id="base"><inertial><mass>5</mass></inertial></link>', "needs action="),
        ('<link element_id="base"><plugin name="x" action="remove"/></link>', "has no <plugin name='x'>"),
        ('<link element_id="base" action="modify"><gravty>0</gravty></link>', "has no <gravty>"),
        ('<link element_id="base" action="modify"><wind>0</wind></link>', 'action="replace" takes a whole new <link>'),
    ],
)
def test_a_wrong_change_is_an_error_at_its_line_and_changes_nothing(arm, change, expected_text):
    changed, unchanged, errors = arm(change)
    assert [(d.code, d.line) for d in errors] == [("SK-SDF-032", 2)]
    assert expected_text in f"{errors[0].message} {errors[0].hint}"
    assert [link.name for link in changed.links] == [link.name for link in unchanged.links]


def test_added_elements_are_checked_like_all_others(load, write):
    root = write("models/box/model.sdf", BOX).parents[1]
    _, found = load(
        '<sdf version="1.9"><world name="w"><include><uri>model://box</uri><experimental:params>'
        '<link element_id="l"><kinematik action="add">1</kinematik></link>'
        "</experimental:params></include></world></sdf>",
        (root,),
    )
    assert [(d.code, d.hint) for d in found] == [("SK-SDF-011", "did you mean 'kinematic'?")]

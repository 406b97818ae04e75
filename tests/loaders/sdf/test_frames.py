"""Poses: relative poses, attached frames, placement frames, nested and merged models."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit.pose import Pose


def near(pose: Pose, *xyzrpy: float) -> None:
    want = Pose.from_rpy(*xyzrpy)
    np.testing.assert_allclose(pose.position, want.position, atol=1e-12)
    assert abs(float(pose.quaternion @ want.quaternion)) == pytest.approx(1.0, abs=1e-12)


def test_a_link_pose_can_be_relative_to_another_link(load):
    scene, _ = load("""<sdf version="1.7"><model name="m"><pose>0 0 2 0 0 0</pose>
      <link name="a"><pose degrees="true">0.5 0 0 0 0 180</pose></link>
      <link name="b"><pose relative_to="a">0.5 0 1 0 0 0</pose></link></model></sdf>""")
    near(scene.model.links[1].pose_world, 0, 0, 3, 0, 0, math.pi)


def test_a_chain_of_frames_carries_a_joint_and_its_sensor(load):
    scene, found = load("""<sdf version="1.9"><model name="m"><pose>1 0 0 0 0 0</pose><link name="a"/><link name="b"/>
      <frame name="f" attached_to="b"><pose>0 0 1 0 0 0</pose></frame>
      <frame name="g" attached_to="f"><pose>0 2 0 0 0 0</pose></frame>
      <joint name="j" type="fixed"><parent>a</parent><child>g</child><pose>0 0 0.5 0 0 0</pose>
        <sensor name="s" type="force_torque"><pose>0 0 0.25 0 0 0</pose></sensor></joint></model></sdf>""")
    assert not [d for d in found if d.severity == "error"]
    joint = scene.model.joints[0]
    assert (joint.parent_link, joint.child_link) == ("m::a", "m::b")
    near(joint.pose_world, 1, 2, 1.5, 0, 0, 0)
    near(joint.sensors[0].pose_link, 0, 2, 1.75, 0, 0, 0)
    near(joint.sensors[0].pose_world, 1, 2, 1.75, 0, 0, 0)
    assert [f.attached_to for f in scene.model.frames] == ["m::b", "m::b"]


def test_the_model_pose_applies_to_the_placement_frame(load):
    scene, _ = load("""<sdf version="1.9"><model name="m" placement_frame="tip"><pose>0 0 5 0 0 0</pose>
      <link name="a"/><frame name="tip"><pose>0 0 2 0 0 0</pose></frame></model></sdf>""")
    near(scene.model.pose_world, 0, 0, 3, 0, 0, 0)


def test_a_nested_model_moves_as_a_whole_and_has_scoped_names(load):
    scene, _ = load("""<sdf version="1.9"><world name="w"><model name="m"><pose>1 0 0 0 0 0</pose>
      <model name="n"><pose>0 1 0 0 0 0</pose><link name="a"><pose>0 0 1 0 0 0</pose></link></model>
      <link name="b"><pose relative_to="n::a">0 0 1 0 0 0</pose></link></model>
      <frame name="f" attached_to="m::n::a"/></world></sdf>""")
    model = scene.world.models[0]
    near(model.links[0].pose_world, 1, 1, 2, 0, 0, 0)
    assert model.models[0].links[0].scoped == "m::n::a"
    assert model.canonical_link == "m::b"
    assert scene.world.frames[0].attached_to == "m::n::a"
    near(scene.world.frames[0].pose_world, 1, 1, 1, 0, 0, 0)


def test_the_canonical_link_can_be_in_a_nested_model(load):
    scene, _ = load("""<sdf version="1.9"><model name="m"><model name="n"><link name="a"/></model></model></sdf>""")
    assert scene.model.canonical_link == "m::n::a"


def test_a_pose_that_depends_on_itself_is_an_error(load):
    _, found = load("""<sdf version="1.9"><model name="m"><link name="a"><pose relative_to="b"/></link>
      <link name="b"><pose relative_to="a"/></link></model></sdf>""")
    assert "SK-SDF-005" in {d.code for d in found}


@pytest.mark.parametrize(
    ("version", "attributes", "expected_axis"),
    [
        ("1.4", "", (1, 0, 0)),  # before 1.5 in the model frame
        ("1.5", "", (0, 1, 0)),  # then in the joint frame
        ("1.9", 'expressed_in="__model__"', (1, 0, 0)),
    ],
)
def test_the_axis_is_read_in_the_frame_of_its_version(load, version, attributes, expected_axis):
    scene, _ = load(f"""<sdf version="{version}"><model name="m"><link name="a"/>
      <link name="b"><pose>0 0 0 0 0 1.5707963267948966</pose></link>
      <joint name="j" type="revolute"><parent>a</parent><child>b</child>
      <axis><xyz {attributes}>1 0 0</xyz></axis></joint></model></sdf>""")
    np.testing.assert_allclose(scene.model.joints[0].axes[0].xyz_world, expected_axis, atol=1e-12)


def test_use_parent_model_frame_is_used_before_sdf_1_7(load):
    scene, _ = load("""<sdf version="1.6"><model name="m"><link name="a"/>
      <link name="b"><pose>0 0 0 0 0 1.5707963267948966</pose></link>
      <joint name="j" type="prismatic"><parent>a</parent><child>b</child><axis><xyz>3 0 0</xyz>
      <use_parent_model_frame>true</use_parent_model_frame></axis></joint></model></sdf>""")
    np.testing.assert_allclose(scene.model.joints[0].axes[0].xyz_world, (1, 0, 0), atol=1e-12)

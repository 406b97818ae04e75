"""Names that collisions of a URDF robot have in Gazebo."""

from __future__ import annotations

import pytest

import simkit

INERTIAL = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'


def link(name: str, *collisions: str) -> str:
    shape = '<geometry><sphere radius="0.1"/></geometry>'
    parts = "".join(f"<collision{f' name={chr(34)}{c}{chr(34)}' if c else ''}>{shape}</collision>" for c in collisions)
    return f'<link name="{name}">{INERTIAL}{parts}</link>'


def joint(name: str, parent: str, child: str, kind: str = "fixed") -> str:
    limit = '<axis xyz="0 1 0"/>' if kind != "fixed" else ""
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{limit}</joint>'


def robot(on: str, *names: str) -> str:
    """Return a URDF robot with a contact sensor on the link `on`; the sensor names some collisions."""
    named = "".join(f"<collision>{n}</collision>" for n in names)
    return f"""<robot name="r">
      {link("base_footprint")}{link("base_link", "", "", "shell")}{link("bumper", "")}{link("lidar", "body")}
      {link("arm", "arm_tube")}{link("tip", "")}
      {joint("a_base", "base_footprint", "base_link")}{joint("b_lidar", "base_link", "lidar")}
      {joint("a_bumper", "base_link", "bumper")}{joint("hinge", "base_link", "arm", "continuous")}
      {joint("tip_joint", "arm", "tip")}
      <gazebo reference="{on}"><sensor name="s" type="contact"><contact>{named}</contact></sensor></gazebo></robot>"""


@pytest.mark.parametrize(
    ("on", "name", "means"),
    [
        # as simkit calls them
        ("base_link", "base_link_collision", "base_link::base_link_collision"),
        ("base_link", "base_link_collision_1", "base_link::base_link_collision_1"),
        ("base_link", "shell", "base_link::shell"),
        # Gazebo's names: all collisions belong to the root link and are counted in the order of the joints' names
        ("base_link", "base_footprint_fixed_joint_lump__base_link_collision", "base_link::base_link_collision"),
        ("base_link", "base_footprint_fixed_joint_lump__base_link_collision_1", "base_link::base_link_collision_1"),
        ("base_link", "base_footprint_fixed_joint_lump__shell_collision_2", "base_link::shell"),
        ("base_footprint", "base_footprint_fixed_joint_lump__bumper_collision_3", "bumper::bumper_collision"),
        ("bumper", "base_footprint_fixed_joint_lump__bumper_collision_3", "bumper::bumper_collision"),
        ("base_link", "base_footprint_fixed_joint_lump__body_collision_4", "lidar::body"),
        ("arm", "arm_tube_collision", "arm::arm_tube"),
        ("tip", "arm_fixed_joint_lump__tip_collision_1", "tip::tip_collision"),
        # if the joint to the root is preserved
        ("bumper", "base_link_fixed_joint_lump__bumper_collision_3", "bumper::bumper_collision"),
        ("lidar", "lidar_fixed_joint_lump__body_collision", "lidar::body"),
        # counted by another version, or not at all
        ("base_link", "base_footprint_fixed_joint_lump__bumper_collision_1", "bumper::bumper_collision"),
        ("base_link", "bumper_collision", "bumper::bumper_collision"),
        ("base_link", "r::base_link::shell", "base_link::shell"),
    ],
)
def test_a_name_of_gazebos_finds_the_collision(on: str, name: str, means: str) -> None:
    with simkit.load(robot(on, name)) as sim:
        assert sim.sensor(f"r::{on}::s").collisions == (f"r::{means}",)
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-SENSOR")]


@pytest.mark.parametrize(
    ("on", "name"),
    [("base_link", "arm_tube_collision"), ("arm", "base_link_collision"), ("tip", "tip_colision"), ("arm", "bumper")],
)
def test_collisions_behind_a_hinge_do_not_belong_to_the_link(on: str, name: str) -> None:
    with simkit.load(robot(on, name)) as sim:
        assert sim.sensor(f"r::{on}::s").collisions == ()
        assert "SK-SENSOR-040" in {d.code for d in sim.diagnostics}


def test_a_loop_of_fixed_joints_is_followed_once() -> None:
    """The fixed joints of an SDF model may form a loop."""
    links = "".join(
        f'<link name="{n}"><collision name="{n}"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>'
        '<sensor name="s" type="contact"><contact><collision>nothing</collision></contact></sensor></link>'
        for n in "abc"
    )
    joints = "".join(
        f'<joint name="{p}{c}" type="fixed"><parent>{p}</parent><child>{c}</child></joint>'
        for p, c in ("ab", "bc", "ca")
    )
    with simkit.load(f'<sdf version="1.9"><model name="m">{links}{joints}</model></sdf>') as sim:
        assert [d.code for d in sim.diagnostics].count("SK-SENSOR-040") == 3

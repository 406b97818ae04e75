"""A robot as URDF text, with what URDF itself cannot say in `<gazebo>` elements."""

from __future__ import annotations

from collections.abc import Iterator

from robots import UNBOUNDED_SPEED, ZERO, Link, Robot
from robots_text import indented, number, plugin_lines, sensor_lines, urdf_material, urdf_origin, urdf_shape

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py from the numbers in {module}; model.sdf is written from them as well, and both mean the
  same robot. URDF has no ball joint: a caster is fixed here, and its ball slides without friction. Fixed joints are
  preserved, so that every frame keeps its name. {packages}
-->"""

JOINTS = {"fixed": "fixed", "wheel": "continuous", "caster": "fixed"}


def urdf_text(robot: Robot) -> str:
    header = HEADER.format(title=robot.title, about=robot.about, module=robot.module, packages=robot.packages)
    lines = [header, f'<robot name="{robot.name}">', ""]
    looks = dict.fromkeys(visual.look for link in robot.links for visual in link.visuals)
    lines += indented((urdf_material(look) for look in looks), 1)
    for link in robot.links:
        lines += ["", *indented(_link(link), 1)]
        if link.joint:
            lines += indented(_joint(link), 1)
        lines += indented(_extensions(link), 1)
    lines += ["", "  <gazebo>"]
    lines += indented((line for plugin in robot.plugins for line in plugin_lines(plugin)), 2)
    return "\n".join([*lines, "  </gazebo>", "", "</robot>"]) + "\n"


def _link(link: Link) -> Iterator[str]:
    if link.about:
        yield f"<!-- {link.about} -->"
    yield f'<link name="{link.name}">'
    yield "  <inertial>"
    yield f"    {urdf_origin(link.centre, ZERO)}"
    yield f'    <mass value="{number(link.mass)}"/>'
    ixx, iyy, izz = (number(v) for v in link.inertia)
    yield f'    <inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>'
    yield "  </inertial>"
    for collision in link.collisions:
        yield f'  <collision name="{collision.name}">'
        yield f"    {urdf_origin(collision.xyz, collision.rpy)}"
        yield f"    <geometry>{urdf_shape(collision.shape)}</geometry>"
        yield "  </collision>"
    for visual in link.visuals:
        yield f'  <visual name="{visual.name}">'
        yield f"    <geometry>{urdf_shape(visual.shape)}</geometry>"
        yield f'    <material name="{visual.look.name}"/>'
        yield "  </visual>"
    yield "</link>"


def _joint(link: Link) -> Iterator[str]:
    yield f'<joint name="{link.joint}" type="{JOINTS[link.kind]}">'
    yield f'  <parent link="{link.parent}"/>'
    yield f'  <child link="{link.name}"/>'
    yield f"  {urdf_origin(link.xyz, link.rpy)}"
    if link.kind == "wheel":
        yield '  <axis xyz="0 1 0"/>'
        yield f'  <limit effort="20" velocity="{number(UNBOUNDED_SPEED)}"/>'
    yield "</joint>"


def _extensions(link: Link) -> Iterator[str]:
    mu = 0 if link.kind == "caster" else link.mu
    if mu is not None or link.sensors:
        yield f'<gazebo reference="{link.name}">'
        if mu is not None:
            yield f"  <mu1>{number(mu)}</mu1>"
            yield f"  <mu2>{number(mu)}</mu2>"
        for sensor in link.sensors:
            yield from indented(sensor_lines(sensor), 1)
        yield "</gazebo>"
    if link.joint and JOINTS[link.kind] == "fixed":
        yield f'<gazebo reference="{link.joint}"><preserveFixedJoint>true</preserveFixedJoint></gazebo>'

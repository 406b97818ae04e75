"""A robot as URDF text, with what URDF itself cannot say in `<gazebo>` elements."""

from __future__ import annotations

from collections.abc import Iterator

from parts import Link, Robot
from robots_text import indented, number, numbers, plugin_lines, sensor_lines, urdf_material, urdf_origin, urdf_shape
from write_sdf import MOMENTS

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py; the SDF file of the same name is written from the same numbers. Fixed joints are preserved,
  so that every frame keeps its name. The package "{package}" that the meshes name is the folder of this file.
-->"""


def urdf_text(robot: Robot) -> str:
    header = HEADER.format(title=robot.title, about=robot.about, package=robot.package)
    lines = [header, f'<robot name="{robot.name}">', ""]
    looks = dict.fromkeys(visual.look for link in robot.links for visual in link.visuals)
    lines += indented((urdf_material(look) for look in looks), 1)
    for link in robot.links:
        lines += ["", *indented(_link(link), 1)]
        if link.joint:
            lines += indented(_joint(link), 1)
        lines += indented(_extensions(link), 1)
    lines += ["", *indented(robot.control, 1), "", "  <gazebo>"]
    lines += indented((line for plugin in robot.plugins for line in plugin_lines(plugin)), 2)
    return "\n".join([*lines, "  </gazebo>", "", "</robot>"]) + "\n"


def _link(link: Link) -> Iterator[str]:
    if link.about:
        yield f"<!-- {link.about} -->"
    yield f'<link name="{link.name}">'
    yield "  <inertial>"
    yield f"    {urdf_origin(link.centre, (0, 0, 0))}"
    yield f'    <mass value="{number(link.mass)}"/>'
    moments = dict(zip(MOMENTS, link.moments, strict=True))
    yield "    <inertia " + " ".join(f'{name}="{number(moments[name])}"' for name in sorted(MOMENTS)) + "/>"
    yield "  </inertial>"
    for collision in link.collisions:
        yield f'  <collision name="{collision.name}">'
        yield f"    {urdf_origin(collision.xyz, collision.rpy)}"
        yield f"    <geometry>{urdf_shape(collision.shape)}</geometry>"
        yield "  </collision>"
    for visual in link.visuals:
        yield f'  <visual name="{visual.name}">'
        yield f"    {urdf_origin(visual.xyz, visual.rpy)}"
        yield f"    <geometry>{urdf_shape(visual.shape)}</geometry>"
        yield f'    <material name="{visual.look.name}"/>'
        yield "  </visual>"
    yield "</link>"


def _joint(link: Link) -> Iterator[str]:
    yield f'<joint name="{link.joint}" type="{link.kind}">'
    yield f'  <parent link="{link.parent}"/>'
    yield f'  <child link="{link.name}"/>'
    yield f"  {urdf_origin(link.xyz, link.rpy)}"
    if link.kind != "fixed":
        yield f'  <axis xyz="{numbers(link.axis)}"/>'
        yield from indented(_limits(link), 1)
        if link.mimic:
            yield f'  <mimic joint="{link.mimic}" multiplier="{number(link.multiplier)}" offset="0"/>'
        yield f'  <dynamics damping="{number(link.damping)}" friction="{number(link.friction)}"/>'
    yield "</joint>"


def _limits(link: Link) -> Iterator[str]:
    limit = link.limit
    if limit is None:
        return
    force = f'effort="{number(limit.effort)}" velocity="{number(limit.velocity)}"'
    if limit.lower is None or limit.upper is None:
        yield f"<limit {force}/>"
        return
    lower, upper = limit.lower, limit.upper
    yield f'<limit lower="{number(lower)}" upper="{number(upper)}" {force}/>'
    if not (limit.k_position or limit.k_velocity):
        return
    gains = f'k_position="{number(limit.k_position)}" k_velocity="{number(limit.k_velocity)}"'
    soft = f'soft_lower_limit="{number(lower + limit.soft)}" soft_upper_limit="{number(upper - limit.soft)}"'
    yield f"<safety_controller {gains} {soft}/>"


def _extensions(link: Link) -> Iterator[str]:
    if link.contact is not None or link.sensors:
        yield f'<gazebo reference="{link.name}">'
        if link.contact is not None:
            yield f"  <mu1>{number(link.contact.mu)}</mu1>"
            yield f"  <mu2>{number(link.contact.mu)}</mu2>"
            if link.contact.kp is not None and link.contact.kd is not None:
                yield f"  <kp>{number(link.contact.kp)}</kp>"
                yield f"  <kd>{number(link.contact.kd)}</kd>"
        for sensor in link.sensors:
            yield from indented(sensor_lines(sensor), 1)
        yield "</gazebo>"
    if link.joint and link.kind == "fixed":
        yield f'<gazebo reference="{link.joint}">'
        yield "  <preserveFixedJoint>true</preserveFixedJoint>"
        for sensor in link.joint_sensors:
            yield from indented(sensor_lines(sensor), 1)
        yield "</gazebo>"

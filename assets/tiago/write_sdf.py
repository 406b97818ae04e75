"""A robot as SDF 1.12 text."""

from __future__ import annotations

from collections.abc import Iterator

from parts import ZERO, Contact, Link, Robot
from robots_text import indented, number, numbers, plugin_lines, pose_lines, sdf_material, sensor_lines, shape_text

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py; the URDF file of the same name is written from the same numbers. The model's origin is
  {origin}, x forward, y left, z up. Lengths m, masses kg, inertias
  kg m^2, angles rad.
-->"""

MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def sdf_text(robot: Robot) -> str:
    lines = [HEADER.format(title=robot.title, about=robot.about, origin=robot.origin), '<sdf version="1.12">']
    lines.append(f'  <model name="{robot.name}" canonical_link="{robot.links[0].name}">')
    lines += indented(pose_lines((0, 0, robot.height), ZERO), 2)
    for link in robot.links:
        lines += ["", *indented(_link(link), 2)]
        if link.joint:
            lines += indented(_joint(link), 2)
    lines += ["", *indented((line for plugin in robot.plugins for line in plugin_lines(plugin, robot.control)), 2), ""]
    return "\n".join([*lines, "  </model>", "</sdf>"]) + "\n"


def _link(link: Link) -> Iterator[str]:
    if link.about:
        yield f"<!-- {link.about} -->"
    yield f'<link name="{link.name}">'
    if link.parent:
        yield f'  <pose relative_to="{link.parent}">{numbers((*link.xyz, *link.rpy))}</pose>'
    yield "  <inertial>"
    yield from indented(pose_lines(link.centre, ZERO), 2)
    yield f"    <mass>{number(link.mass)}</mass>"
    moments = (f"<{name}>{number(v)}</{name}>" for name, v in zip(MOMENTS, link.moments, strict=True))
    yield f"    <inertia>{''.join(moments)}</inertia>"
    yield "  </inertial>"
    for collision in link.collisions:
        yield f'  <collision name="{collision.name}">'
        yield from indented(pose_lines(collision.xyz, collision.rpy), 2)
        yield f"    <geometry>{shape_text(collision.shape)}</geometry>"
        if link.contact is not None:
            yield f"    <surface>{_surface(link.contact)}</surface>"
        yield "  </collision>"
    for visual in link.visuals:
        yield f'  <visual name="{visual.name}">'
        yield from indented(pose_lines(visual.xyz, visual.rpy), 2)
        yield f"    <geometry>{shape_text(visual.shape)}</geometry>"
        yield from indented(sdf_material(visual.look), 2)
        yield "  </visual>"
    for sensor in link.sensors:
        yield from indented(sensor_lines(sensor), 1)
    yield "</link>"


def _surface(contact: Contact) -> str:
    mu = number(contact.mu)
    text = f"<friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction>"
    if contact.kp is not None and contact.kd is not None:
        text += f"<contact><ode><kp>{number(contact.kp)}</kp><kd>{number(contact.kd)}</kd></ode></contact>"
    return text


def _joint(link: Link) -> Iterator[str]:
    yield f'<joint name="{link.joint}" type="{link.kind}">'
    yield f"  <parent>{link.parent}</parent>"
    yield f"  <child>{link.name}</child>"
    if link.kind != "fixed":
        yield "  <axis>"
        yield f"    <xyz>{numbers(link.axis)}</xyz>"
        yield from indented(_limit(link), 2)
        if link.mimic:
            ratio = f"<multiplier>{number(link.multiplier)}</multiplier><offset>0</offset><reference>0</reference>"
            yield f'    <mimic joint="{link.mimic}">{ratio}</mimic>'
        damping, friction = number(link.damping), number(link.friction)
        yield f"    <dynamics><damping>{damping}</damping><friction>{friction}</friction></dynamics>"
        yield "  </axis>"
    for sensor in link.joint_sensors:
        yield from indented(sensor_lines(sensor), 1)
    yield "</joint>"


def _limit(link: Link) -> Iterator[str]:
    limit = link.limit
    if limit is None:
        return
    ends = ""
    if limit.lower is not None and limit.upper is not None:
        ends = f"<lower>{number(limit.lower)}</lower><upper>{number(limit.upper)}</upper>"
    yield f"<limit>{ends}<effort>{number(limit.effort)}</effort><velocity>{number(limit.velocity)}</velocity></limit>"

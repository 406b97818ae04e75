"""A robot as SDF 1.12 text."""

from __future__ import annotations

from collections.abc import Iterator

from robots import UNBOUNDED_SPEED, ZERO, Link, Robot
from robots_text import indented, number, numbers, plugin_lines, pose_lines, sdf_material, sensor_lines, shape_text

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py from the numbers in {module}; the URDF file of the same name is written from them as well.
  The model's origin is base_footprint: on the ground, midway between the wheels, x forward, y left, z up. Every link
  has its own frame where its part is. Lengths m, masses kg, inertias kg m^2, angles rad.
-->"""

JOINTS = {"fixed": "fixed", "wheel": "continuous", "caster": "ball"}


def sdf_text(robot: Robot) -> str:
    lines = [HEADER.format(title=robot.title, about=robot.about, module=robot.module), '<sdf version="1.12">']
    lines.append(f'  <model name="{robot.name}" canonical_link="{robot.links[0].name}">')
    for link in robot.links:
        lines += ["", *indented(_link(link), 2)]
        if link.joint:
            lines += indented(_joint(link), 2)
    lines += ["", *indented((line for plugin in robot.plugins for line in plugin_lines(plugin)), 2), ""]
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
    moments = (f"<{name}>{number(v)}</{name}>" for name, v in zip(("ixx", "iyy", "izz"), link.inertia, strict=True))
    yield f"    <inertia>{''.join(moments)}</inertia>"
    yield "  </inertial>"
    for collision in link.collisions:
        yield f'  <collision name="{collision.name}">'
        yield from indented(pose_lines(collision.xyz, collision.rpy), 2)
        yield f"    <geometry>{shape_text(collision.shape)}</geometry>"
        if link.mu is not None:
            mu = number(link.mu)
            yield f"    <surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"
        yield "  </collision>"
    for visual in link.visuals:
        yield f'  <visual name="{visual.name}">'
        yield f"    <geometry>{shape_text(visual.shape)}</geometry>"
        yield from indented(sdf_material(visual.look), 2)
        yield "  </visual>"
    for sensor in link.sensors:
        yield from indented(sensor_lines(sensor), 1)
    yield "</link>"


def _joint(link: Link) -> Iterator[str]:
    yield f'<joint name="{link.joint}" type="{JOINTS[link.kind]}">'
    yield f"  <parent>{link.parent}</parent>"
    yield f"  <child>{link.name}</child>"
    if link.kind == "wheel":
        yield "  <axis>"
        yield "    <xyz>0 1 0</xyz>"
        yield f"    <limit><effort>20</effort><velocity>{number(UNBOUNDED_SPEED)}</velocity></limit>"
        yield "  </axis>"
    yield "</joint>"

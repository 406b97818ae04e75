"""A robot as SDF 1.12 text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from parts import ZERO, Contact, Link, Look, Plugin, Robot, Sensor, Shape, Vector

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py; the URDF file of the same name is written from the same numbers. The model's origin is
  base_footprint: on the ground, midway between the wheels, x forward, y left, z up. Lengths m, masses kg, inertias
  kg m^2, angles rad.
-->"""

MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def indented(lines: Iterable[str], depth: int) -> list[str]:
    return ["  " * depth + line for line in lines]


def sdf_text(robot: Robot) -> str:
    lines = [HEADER.format(title=robot.title, about=robot.about), '<sdf version="1.12">']
    lines.append(f'  <model name="{robot.name}" canonical_link="{robot.links[0].name}">')
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
        yield from indented(_material(visual.look), 2)
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
            ratio = "<multiplier>1</multiplier><offset>0</offset><reference>0</reference>"
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


def pose_lines(xyz: Iterable[float], rpy: Vector) -> list[str]:
    """A `<pose>`, none where it is the identity."""
    values = (*xyz, *rpy)
    return [f"<pose>{numbers(values)}</pose>"] if any(values) else []


def shape_text(shape: Shape) -> str:
    """The element inside `<geometry>`."""
    if shape.kind == "mesh":
        return f"<mesh><uri>model://{shape.mesh}</uri></mesh>"
    if shape.kind == "box":
        return f"<box><size>{numbers(shape.sizes)}</size></box>"
    names = {"cylinder": ("radius", "length"), "sphere": ("radius",)}[shape.kind]
    inside = "".join(f"<{name}>{number(v)}</{name}>" for name, v in zip(names, shape.sizes, strict=True))
    return f"<{shape.kind}>{inside}</{shape.kind}>"


def _material(look: Look) -> list[str]:
    colour, shine = numbers(look.colour), numbers((look.shine,) * 3)
    return [
        "<material>",
        f"  <ambient>{colour} 1</ambient><diffuse>{colour} 1</diffuse><specular>{shine} 1</specular>",
        "</material>",
    ]


def sensor_lines(sensor: Sensor) -> Iterator[str]:
    """A `<sensor>`, the same in both formats."""
    yield f'<sensor name="{sensor.name}" type="{sensor.kind}">'
    yield "  <always_on>true</always_on>"
    yield f"  <update_rate>{number(sensor.rate)}</update_rate>"
    yield from indented(sensor.lines, 1)
    yield "</sensor>"


def plugin_lines(plugin: Plugin, control: tuple[str, ...] = ()) -> Iterator[str]:
    """A `<plugin>`; the one that runs controllers holds `<ros2_control>` where the format has no place for it."""
    if plugin.about:
        yield f"<!-- {plugin.about} -->"
    yield f'<plugin name="{plugin.name}" filename="{plugin.filename}">'
    yield from indented(plugin.lines, 1)
    if control and "ros2_control" in plugin.filename:
        yield from indented(control, 1)
    yield "</plugin>"

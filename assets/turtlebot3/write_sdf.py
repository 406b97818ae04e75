"""A robot as SDF 1.12 text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robots import UNBOUNDED_SPEED, ZERO, Link, Look, Plugin, Robot, Sensor, Shape

HEADER = """<?xml version="1.0"?>
<!--
  {title}. {about}

  Written by make_models.py from the numbers in robots.py; the URDF file of the same name is written from them as well.
  The model's origin is base_footprint: on the ground, midway between the wheels, x forward, y left, z up. Every link
  has its own frame where its part is. Lengths m, masses kg, inertias kg m^2, angles rad.
-->"""

JOINTS = {"fixed": "fixed", "wheel": "continuous", "caster": "ball"}


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return str(int(value)) if value == int(value) else repr(float(value))


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
        yield from indented(_material(visual.look), 2)
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


def pose_lines(xyz: Iterable[float], rpy: Iterable[float]) -> list[str]:
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


def plugin_lines(plugin: Plugin) -> Iterator[str]:
    """A `<plugin>`, the same in both formats."""
    if plugin.about:
        yield f"<!-- {plugin.about} -->"
    yield f'<plugin name="{plugin.name}" filename="{plugin.filename}">'
    yield from indented(plugin.lines, 1)
    yield "</plugin>"

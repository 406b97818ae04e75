"""What every robot's script here is written with: shapes, looks, sensors, plugins, and their text in SDF and URDF."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Shape:
    """A box (x, y, z), cylinder (radius, length) or sphere (radius), or the mesh of that name."""

    kind: str
    sizes: tuple[float, ...] = ()
    mesh: str = ""


@dataclass(frozen=True, slots=True)
class Look:
    """A colour (red, green, blue) and how much it shines, both from 0 to 1."""

    name: str
    colour: Vector
    shine: float


@dataclass(frozen=True, slots=True)
class Collision:
    name: str
    shape: Shape
    xyz: Vector = ZERO
    rpy: Vector = ZERO


@dataclass(frozen=True, slots=True)
class Sensor:
    """A sensor at its link's origin: what SDF has inside `<sensor>`, line by line."""

    name: str
    kind: str
    rate: float
    lines: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Plugin:
    """A plugin of the model, with the elements inside it line by line."""

    name: str
    filename: str
    lines: tuple[str, ...]
    about: str = ""


def number(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def numbers(values: Iterable[float]) -> str:
    return " ".join(number(v) for v in values)


def indented(lines: Iterable[str], depth: int) -> list[str]:
    return ["  " * depth + line for line in lines]


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


def sdf_material(look: Look) -> list[str]:
    """A `<material>` of SDF."""
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


def urdf_material(look: Look) -> str:
    """A `<material>` of URDF, for the robot as a whole."""
    return f'<material name="{look.name}"><color rgba="{numbers(look.colour)} 1"/></material>'


def urdf_origin(xyz: Iterable[float], rpy: Vector) -> str:
    """An `<origin>` of URDF."""
    return f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>'


def urdf_shape(shape: Shape) -> str:
    """The element inside `<geometry>` of URDF."""
    if shape.kind == "mesh":
        return f'<mesh filename="package://{shape.mesh}"/>'
    if shape.kind == "box":
        return f'<box size="{numbers(shape.sizes)}"/>'
    names = {"cylinder": ("radius", "length"), "sphere": ("radius",)}[shape.kind]
    inside = " ".join(f'{name}="{number(v)}"' for name, v in zip(names, shape.sizes, strict=True))
    return f"<{shape.kind} {inside}/>"

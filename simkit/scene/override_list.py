"""List of the paths that overrides can set in a world, with their values and units."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from simkit.params import Params
from simkit.scene.entity_paths import AREAS, Entity, EntityPaths
from simkit.scene.model import ScenePlugin, SceneSensor
from simkit.scene.override_fields import fields_of
from simkit.scene.override_poses import pose_of
from simkit.scene.override_values import POSE
from simkit.scene.overrides import XACRO
from simkit.scene.param_paths import parameter_values
from simkit.scene.world import SceneWorld

_UNITS: Final = {
    **dict.fromkeys(("min_angle", "max_angle", "horizontal_fov", "vertical_fov"), "rad"),
    **dict.fromkeys(("near", "far", "wheel_separation", "wheel_radius", "wheel_diameter", "radius"), "m"),
    **dict.fromkeys(("range.min", "range.max", "range.resolution"), "m"),
    **dict.fromkeys(("update_rate", "publish_rate", "odom_publish_frequency", "odometryRate"), "Hz"),
    **dict.fromkeys(("latency", "jitter", "latency_jitter", "phase", "delay"), "s"),
    **dict.fromkeys(("max_linear_velocity", "min_linear_velocity"), "m/s"),
    **dict.fromkeys(("max_angular_velocity", "min_angular_velocity"), "rad/s"),
    **dict.fromkeys(("max_linear_acceleration", "min_linear_acceleration"), "m/s²"),
    **dict.fromkeys(("max_wheel_torque", "wheelTorque"), "N·m"),
    **dict.fromkeys(("width", "height"), "px"),
}
"""Units of free parameters by the last names of their paths; most parameters state no unit."""

_FIELDS_OF_SENSORS: Final = frozenset({"update_rate", "topic", "pose", "gz_frame_id.pose"})


@dataclass(frozen=True, slots=True)
class SettablePath:
    """Path that an override can set.

    Attributes:
        path: path of the value.
        value: present value, as an override writes it.
        unit: unit; empty for a text or a number without a unit, or if the unit is unknown.
        parts: names of the components, which can be set one by one: `pose.x`.
    """

    path: str
    value: str
    unit: str = ""
    parts: tuple[str, ...] = ()


ParameterReader = Callable[[SceneSensor], Params]
"""Function that returns the parameters of a sensor with the defaults of all that it reads."""


def settable_paths(
    world: SceneWorld, arguments: Mapping[str, str] | None = None, read: ParameterReader | None = None
) -> list[SettablePath]:
    """Return every path that overrides can set in a world, in the order of the file.

    Args:
        world: the world.
        arguments: arguments of its xacro file, with their values.
        read: function that returns the parameters of a sensor; None for those in the file only.
    """
    paths = EntityPaths(world)
    values = [(entity, value) for entity in paths.all() for value in _values(paths, entity, read)]
    counts: dict[str, int] = {}
    for entity, value in values:
        path = f"{entity.path}.{value.path}"
        counts[path] = counts.get(path, 0) + 1
    return [SettablePath(f"{XACRO}{name}", text) for name, text in (arguments or {}).items()] + [
        SettablePath(
            f"{entity.qualified if counts[f'{entity.path}.{value.path}'] > 1 else entity.path}.{value.path}",
            *(value.value, value.unit, value.parts),
        )
        for entity, value in values
    ]


def _values(paths: EntityPaths, entity: Entity, read: ParameterReader | None) -> Iterator[SettablePath]:
    """Yield the values of one entity; their paths begin below the entity."""
    item = paths.item(entity)
    if not entity.area:
        if len(entity.location) == 1 and entity.kind == "model":
            yield SettablePath("count", "1")
        pose = pose_of(item, paths.holders(entity))
        if pose is not None:
            yield SettablePath("pose", POSE.format(pose), POSE.unit, POSE.parts)
    for field in AREAS.get(entity.area) or fields_of(item):
        value = field.read(item)
        if value is not None:
            yield SettablePath(field.element, field.kind.format(value), field.kind.unit, field.kind.parts)
    if isinstance(item, (SceneSensor, ScenePlugin)):
        of_sensor = _FIELDS_OF_SENSORS if isinstance(item, SceneSensor) else frozenset()
        for path, text in parameter_values(read(item) if read and isinstance(item, SceneSensor) else item.params):
            if path not in of_sensor and not path.startswith("pose."):
                yield SettablePath(path, text, _unit(path))


def _unit(path: str) -> str:
    names = path.split(".")
    return _UNITS.get(names[-1]) or _UNITS.get(".".join(names[-2:]), "")

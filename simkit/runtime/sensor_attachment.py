"""Sensors that are added to a link or a joint during a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from simkit.errors import InputError
from simkit.runtime.handles.handle import look_up
from simkit.scene import SceneJoint, SceneLink, SceneModel, SceneSensor

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import WorldStructure

_XML_ATTRIBUTES = frozenset(("name", "type"))


def sensor_xml(sensor: str | Mapping[str, object]) -> str:
    """Return a `<sensor>` element as XML.

    Args:
        sensor: element as text, or as a dict with `name`, `type` and its child elements. In the dict, nested dicts are
            nested elements, lists are repeated elements, and tuples are the numbers of one element.
    """
    if isinstance(sensor, str):
        return sensor
    missing = _XML_ATTRIBUTES.difference(sensor)
    if missing:
        raise InputError(f"a sensor needs {' and '.join(map(repr, sorted(missing)))}, got {', '.join(sensor)}")
    attributes = "".join(f" {key}='{_xml_text(sensor[key])}'" for key in sorted(_XML_ATTRIBUTES))
    inside = {key: value for key, value in sensor.items() if key not in _XML_ATTRIBUTES}
    return f"<sensor{attributes}>{''.join(_xml_elements(inside))}</sensor>"


def _xml_elements(values: Mapping[str, object]) -> Iterator[str]:
    for key, value in values.items():
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, Mapping):
                attributes = {k.removeprefix("@"): v for k, v in item.items() if k.startswith("@")}
                inside = {k: v for k, v in item.items() if not k.startswith("@")}
                text = "".join(f" {k}='{_xml_text(v)}'" for k, v in attributes.items())
                yield f"<{key}{text}>{''.join(_xml_elements(inside))}</{key}>"
            else:
                yield f"<{key}>{_xml_text(item)}</{key}>"


def _xml_text(value: object) -> str:
    """Return a value as the text of an element or an attribute."""
    if isinstance(value, bool):
        return str(value).lower()
    text = " ".join(map(str, value)) if isinstance(value, tuple) else str(value)
    return "".join(f"&#{ord(letter)};" if letter in "&<>'" else letter for letter in text)


def sensor_model_xml(sensor: str, on_joint: bool) -> str:
    """Return an SDF file that contains only the sensor, on a link or a joint of a model."""
    joint = f"<joint name='j' type='revolute'><parent>l</parent><child>k</child><axis/>{sensor}</joint><link name='k'/>"
    inside = f"<link name='l'/>{joint}" if on_joint else f"<link name='l'>{sensor}</link>"
    return f"<sdf version='1.11'><model name='m'>{inside}</model></sdf>"


def build_sensor_model(structure: WorldStructure, name: str, read: SceneModel) -> tuple[str, SceneModel, str]:
    """Build a model that adds a sensor to a structure.

    Args:
        structure: present structure.
        name: scoped name of the link or joint.
        read: model read from `sensor_model_xml`.

    Returns:
        Name of the top-level model, model with only the sensor, and scoped name of the sensor.

    Raises:
        KeyError: no link or joint has that name.
        InputError: the link or joint has a sensor of that name.
    """
    top, owner = find_owner(structure, name)
    on_joint = isinstance(owner, SceneJoint)
    sensors = read.joints[0].sensors if on_joint else read.links[0].sensors
    if len(sensors) != 1:
        raise InputError(f"add_sensor needs one <sensor>, got {len(sensors)}")
    scoped = f"{owner.scoped}::{sensors[0].name}"
    if any(sensor.scoped == scoped for sensor in structure.all_sensors()):
        raise InputError("SK-NAME-004", f"a sensor {scoped!r} exists already", shows_code=False)
    sensor = _move_sensor(sensors[0], scoped, owner)
    shell = SceneModel(name=top, scoped=owner.scoped.rpartition("::")[0], pose_world=read.pose_world)
    if isinstance(owner, SceneJoint):
        return top, replace(shell, joints=(replace(owner, sensors=(sensor,), plugins=()),)), scoped
    return top, replace(shell, links=(replace(owner, sensors=(sensor,), plugins=(), visuals=(), lights=()),)), scoped


def find_owner(structure: WorldStructure, name: str) -> tuple[str, SceneLink | SceneJoint]:
    """Return the name of the top-level model and the link or joint with a scoped name.

    Raises:
        KeyError: no link or joint has that name; the message suggests the closest name.
    """
    models = structure.models.items()
    table: dict[str, tuple[str, SceneLink | SceneJoint]] = {}
    for top, model in models:
        table.update({link.scoped: (top, link) for link in model.all_links()})
        table.update({joint.scoped: (top, joint) for joint in model.all_joints()})
    return look_up(table, name, "link or joint")


def _move_sensor(sensor: SceneSensor, scoped: str, owner: SceneLink | SceneJoint) -> SceneSensor:
    """Return the sensor as if it had been read on its new owner."""
    return replace(
        sensor,
        scoped=scoped,
        parent=owner.scoped,
        pose_world=owner.pose_world @ sensor.pose_link,
        plugins=tuple(replace(plugin, scoped=scoped) for plugin in sensor.plugins),
    )

"""A sensor that is fitted to a link or a joint while the simulation runs."""

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
    """The `<sensor>` element that is meant, as XML.

    Args:
        sensor: the element as text, or a dict of it: `name` and `type`, then its elements; nested dicts are elements in
            elements, lists repeated ones, tuples the numbers of one.
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
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, Mapping):
                own = {k.removeprefix("@"): v for k, v in one.items() if k.startswith("@")}
                inside = {k: v for k, v in one.items() if not k.startswith("@")}
                text = "".join(f" {k}='{_xml_text(v)}'" for k, v in own.items())
                yield f"<{key}{text}>{''.join(_xml_elements(inside))}</{key}>"
            else:
                yield f"<{key}>{_xml_text(one)}</{key}>"


def _xml_text(value: object) -> str:
    """A value as the text of an element or an attribute."""
    if isinstance(value, bool):
        return str(value).lower()
    text = " ".join(map(str, value)) if isinstance(value, tuple) else str(value)
    return "".join(f"&#{ord(letter)};" if letter in "&<>'" else letter for letter in text)


def sensor_model_xml(sensor: str, on_joint: bool) -> str:
    """A file with nothing but the sensor, on a link or a joint of a model."""
    joint = f"<joint name='j' type='revolute'><parent>l</parent><child>k</child><axis/>{sensor}</joint><link name='k'/>"
    inside = f"<link name='l'/>{joint}" if on_joint else f"<link name='l'>{sensor}</link>"
    return f"<sdf version='1.11'><model name='m'>{inside}</model></sdf>"


def build_sensor_model(structure: WorldStructure, name: str, read: SceneModel) -> tuple[str, SceneModel, str]:
    """What a structure gets more.

    Args:
        structure: what is there.
        name: scoped name of the link or joint.
        read: what came of `sensor_model_xml`.

    Returns:
        The name of the top-level model, a model with nothing but the sensor, and the sensor's scoped name.

    Raises:
        KeyError: nothing is called so.
        InputError: it has a sensor of that name.
    """
    top, owner = find_owner(structure, name)
    on_joint = isinstance(owner, SceneJoint)
    found = read.joints[0].sensors if on_joint else read.links[0].sensors
    if len(found) != 1:
        raise InputError(f"add_sensor takes one <sensor>, got {len(found)}")
    scoped = f"{owner.scoped}::{found[0].name}"
    if any(sensor.scoped == scoped for sensor in structure.all_sensors()):
        raise InputError(f"there is a sensor {scoped!r} already", "SK-NAME-004")
    sensor = _move_sensor(found[0], scoped, owner)
    shell = SceneModel(name=top, scoped=owner.scoped.rpartition("::")[0], pose_world=read.pose_world)
    if isinstance(owner, SceneJoint):
        return top, replace(shell, joints=(replace(owner, sensors=(sensor,), plugins=()),)), scoped
    return top, replace(shell, links=(replace(owner, sensors=(sensor,), plugins=(), visuals=(), lights=()),)), scoped


def find_owner(structure: WorldStructure, name: str) -> tuple[str, SceneLink | SceneJoint]:
    """A link or joint by its scoped name, after the name of its top-level model; KeyError names the closest."""
    models = structure.models.items()
    table: dict[str, tuple[str, SceneLink | SceneJoint]] = {}
    for top, model in models:
        table.update({link.scoped: (top, link) for link in model.all_links()})
        table.update({joint.scoped: (top, joint) for joint in model.all_joints()})
    return look_up(table, name, "link or joint")


def _move_sensor(sensor: SceneSensor, scoped: str, owner: SceneLink | SceneJoint) -> SceneSensor:
    """The sensor as it would be read on its new owner."""
    return replace(
        sensor,
        scoped=scoped,
        parent=owner.scoped,
        pose_world=owner.pose_world @ sensor.pose_link,
        plugins=tuple(replace(plugin, scoped=scoped) for plugin in sensor.plugins),
    )

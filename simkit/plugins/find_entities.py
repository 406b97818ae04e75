"""Search for joints, links, lights and files that a plugin's parameters name; an error lists the existing names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.options import Options, text
from simkit.scene import SceneJoint, SceneLink, SceneModel, SceneSensor

T = TypeVar("T")
_TWO_AXES = ("universal", "revolute2")

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.plugins.base import Plugin
    from simkit.runtime import Light, Simulation
    from simkit.sensors.base import Sensor


def find_joint(scene: SceneModel, name: str, params: Params) -> SceneJoint | None:
    """Return a joint of the model; None after an error. The name is plain, or scoped from the world or the model."""
    joints = scene.all_joints()
    table = {j.scoped: j for j in joints}
    joint = _find_by_suffix(scene.scoped, name, table)
    if joint is None and _find_by_suffix(
        scene.scoped, name, dict.fromkeys((link.scoped for link in scene.all_links()), True)
    ):
        joint = _find_by_suffix(scene.scoped, f"{name}_joint", table)  # the loader renames a joint with a link's name
    if joint is None:
        _report_unknown("joint", name, scene, (j.name for j in joints), params)
    return joint


def find_link(scene: SceneModel, name: str, params: Params) -> SceneLink | None:
    """Return a link of the model; None after an error. The name is plain, or scoped from the world or the model."""
    links = scene.all_links()
    named_link = _find_by_suffix(scene.scoped, name, {link.scoped: link for link in links})
    if named_link is None:
        _report_unknown("link", name, scene, (link.name for link in links), params)
    return named_link


def find_sensor(scene: SceneModel, name: str, params: Params) -> SceneSensor | None:
    """Return a sensor of the model; None after an error. The name is plain, or scoped from the world or the model."""
    sensors = scene.all_sensors()
    named_sensor = _find_by_suffix(scene.scoped, name, {sensor.scoped: sensor for sensor in sensors})
    if named_sensor is None:
        _report_unknown("sensor", name, scene, (sensor.name for sensor in sensors), params)
    return named_sensor


def find_named_link(scene: SceneModel, element: str, params: Params) -> str:
    """Return the scoped name of the link that a required element names; empty after an error."""
    params.text(element, required=True)
    named = params.child(element)
    link = None if named is None else find_link(scene, named.value, named)
    return "" if link is None else link.scoped


def find_named_joint(scene: SceneModel, element: str, params: Params) -> SceneJoint | None:
    """Return the joint with one axis that a required element names; None after an error."""
    name = params.text(element, required=True)
    named = params.child(element)
    return None if named is None else find_axis_joint(scene, name, named)


def find_named_sensor(scene: SceneModel, element: str, kinds: Sequence[str], params: Params) -> str:
    """Return the scoped name of the sensor that an optional element names; empty without the element or after an error.

    The sensor is one of the model's sensors of the given kinds, by its plain name or a scoped name.
    """
    named = params.child(element)
    if named is None or not named.value:
        return ""
    sensors = {sensor.scoped: sensor.name for sensor in scene.all_sensors() if sensor.kind in kinds}
    scoped_name = _find_by_suffix(scene.scoped, named.value, {scoped: scoped for scoped in sensors})
    if scoped_name is None:
        _report_unknown(f"{kinds[0]} sensor", named.value, scene, sensors.values(), named)
    return scoped_name or ""


def read_required_name(params: Params, element: str) -> str:
    """Return the text of a required element; empty after an error. An empty element is an error, too."""
    name = params.text(element, required=True)
    named = params.child(element)
    if named is not None and not name:
        named.error("SK-PARAM-002", f"found <{element}></{element}>; expected a name")
    return name


def read_topic(params: Params, element: str, default: str) -> str:
    """Return the topic that an element names, in gz-transport's spelling; the default without a name."""
    written = params.text(element, "")
    topic = valid_topic(written or default)
    named = params.child(element)
    if topic == "/" and named is not None:
        problem = f"found <{element}>{written}</{element}>"
        named.error("SK-PARAM-002", f"{problem}; expected a name with a letter or a digit")
    return topic


def find_light(sim: Simulation, name: str, params: Params) -> Light | None:
    """Return a light of the world by its scoped name; None after an error that lists the lights."""
    lights = sim.contents.lights
    if name in lights:
        return lights[name]
    listed = ", ".join(repr(n) for n in sorted(lights)) or "none"
    params.error("SK-PLUGIN-003", f"there is no light {name!r}; the lights are: {listed}", did_you_mean(name, lights))
    return None


def _find_by_suffix(scope: str, name: str, table: dict[str, T]) -> T | None:
    if f"{scope}::{name}" in table:
        return table[f"{scope}::{name}"]
    nested = [value for scoped, value in table.items() if scoped.endswith("::" + name)]
    return nested[0] if nested else table.get(name)


def _report_unknown(what: str, name: str, scene: SceneModel, names: Iterable[str], params: Params) -> None:
    listed = sorted(set(names))
    shown = ", ".join(repr(n) for n in listed[:12]) + (", …" if len(listed) > 12 else "")
    message = f"model {scene.scoped!r} has no {what} {name!r}; it has: {shown or 'none'}"
    params.error("SK-PLUGIN-003", message, did_you_mean(name, listed))


def find_axis_joint(scene: SceneModel, name: str, params: Params) -> SceneJoint | None:
    """Return a joint of which the plugin uses one axis, by its name; None after an error.

    Of a universal or revolute2 joint this is the first axis, as in Gazebo, with a warning.
    """
    joint = find_joint(scene, name, params)
    if joint is not None and joint.type in _TWO_AXES:
        text = f"joint {name!r} is {joint.type}; the plugin uses only its first axis, as in Gazebo"
        params.warning("SK-PLUGIN-003", text, "a joint with one axis says which motion is meant")
    elif joint is not None and len(joint.axes) != 1:
        params.error("SK-PLUGIN-003", f"joint {name!r} is {joint.type}; the plugin needs a joint with one axis")
        return None
    return joint


def find_plugin_file(plugin: Plugin, uri: str, builder: SpecBuilder, places: Sequence[str] = ()) -> Path | None:
    """Return the file that a URI refers to; None if there is no such file.

    If the URI cannot be resolved, a file with the same name is searched next to the file that describes the plugin.

    Args:
        plugin: plugin that needs the file.
        uri: URI of the file, as in the plugin's parameters.
        builder: builder that resolves the URI.
        places: further folders to search, relative to the folder of the file that describes the plugin.
    """
    folder = Path(plugin.where.file).resolve().parent if plugin.where.file else None
    try:
        path = builder.find_file(uri, folder)
        if path is not None and path.is_file():
            builder.files_read.append(path)
            return path
        name = uri.replace("\\", "/").rpartition("/")[2]
        for place in (".", *places) if folder is not None and name else ():
            path = builder.find_file(f"{place}/{name}", folder)
            if path is not None and path.is_file():
                builder.files_read.append(path)
                return path
        return None
    except (OSError, ValueError):  # the URI is not a valid file name
        return None


class SensorFrameOptions(Options):
    """Name of a sensor's frame, in the spelling of ROS 2 or of ROS 1."""

    frame_name: str = text(ros_1="frameName")

    def frame_of(self, sensor: Sensor) -> str:
        """Return the frame that the file names, or else the name of the sensor's link."""
        return self.frame_name or link_name(sensor)


def link_name(sensor: Sensor) -> str:
    """Return the plain name of a sensor's link."""
    scoped: str = sensor.scene.parent
    return scoped.rsplit("::", 1)[-1]

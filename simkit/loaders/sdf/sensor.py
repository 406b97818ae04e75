"""Reader of `<sensor>`: the elements of every sensor type. Elements of one type stay in `params` for its module."""

from __future__ import annotations

from simkit.loaders.sdf.entity_names import scoped as join
from simkit.loaders.sdf.load_context import NamedElement
from simkit.loaders.sdf.plugin import read_plugins
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import SceneSensor


def read_sensors(
    part: NamedElement, scoped: str, link_world: Pose, in_link: Pose = IDENTITY
) -> tuple[SceneSensor, ...]:
    """Return the sensors of a link or joint.

    Args:
        part: the link or joint.
        scoped: name of the link or joint from the world down.
        link_world: pose in the world of the link, or of the joint's child link.
        in_link: pose of the joint in its child link; the identity for a link.
    """
    return tuple(
        _sensor(e, name, scoped, part.frame.kind == "joint", in_link @ part.pose_of(e, f"sensor {name!r}"), link_world)
        for name, e in part.named("sensor")
    )


def _sensor(element: Params, name: str, parent: str, on_joint: bool, pose_link: Pose, link_world: Pose) -> SceneSensor:
    kind = element.attribute("type").strip()
    if kind == "custom":
        kind = next((v for k, v in element.attributes.items() if k.endswith(":type") and v), kind)
    if not kind:
        element.error("SK-SDF-020", f"sensor {name!r} needs a type")
    scoped = join(parent, name)
    elements = [c for c in element.children if c.name != "plugin"]
    params = Params(element.name, element.value, element.attributes, elements, element.where, element.diagnostics)
    for common in ("pose", "always_on", "visualize", "enable_metrics", "update_rate", "topic"):
        params.child(common)
        element.child(common)
    return SceneSensor(
        name=name,
        scoped=scoped,
        kind=kind,
        parent=parent,
        on_joint=on_joint,
        pose_link=pose_link,
        pose_world=link_world @ pose_link,
        rate=_rate(params, scoped),
        topic=params.text("topic", "").replace("__default_topic__", ""),
        params=params,
        plugins=read_plugins(element.all("plugin"), scoped),
        where=element.where,
    )


def _rate(params: Params, sensor: str) -> float:
    """Return the update rate [Hz]; a negative rate becomes 0, which means every step, as in Gazebo."""
    rate = params.number("update_rate", 0.0)
    if rate < 0:
        message = f"sensor {sensor!r}: <update_rate>{rate:g}</update_rate> means every step, the same as 0"
        params.block("update_rate").note("SK-SENSOR-029", message)
    return max(rate, 0.0)

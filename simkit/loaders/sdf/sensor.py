"""`<sensor>`: what all kinds share; the rest stays in its block of parameters for the kind's own module."""

from __future__ import annotations

from simkit.diagnostics import Diagnostics
from simkit.loaders.sdf.entity_names import scoped as join
from simkit.loaders.sdf.plugin import read_plugins
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneSensor


def read_sensor(
    element: Params, name: str, parent: str, on_joint: bool, pose_link: Pose, link_world: Pose, diagnostics: Diagnostics
) -> SceneSensor:
    """A sensor on a link or joint.

    Args:
        parent: scoped name of the link or joint.
        pose_link: in the frame of the link (a joint's child link).
        link_world: pose of that link in the world.
    """
    kind = element.attribute("type").strip()
    if kind == "custom":
        kind = next((v for k, v in element.attributes.items() if k.endswith(":type") and v), kind)
    if not kind:
        diagnostics.error("SK-SDF-020", f"sensor {name!r} needs a type", element.where)
    scoped = join(parent, name)
    own = [c for c in element.children if c.name != "plugin"]
    params = Params(element.name, element.value, element.attributes, own, element.where, element.diagnostics)
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
    """[Hz]; what is below zero is every step, as in Gazebo."""
    rate = params.number("update_rate", 0.0)
    if rate < 0:
        message = f"sensor {sensor!r}: <update_rate>{rate:g}</update_rate> is every step, as 0 is"
        params.diagnostics.note("SK-SENSOR-029", message, params.block("update_rate").where)
    return max(rate, 0.0)

"""Copies of a model whose topics are in a ROS namespace."""

from __future__ import annotations

import copy
import re
from dataclasses import fields, is_dataclass, replace
from typing import Final, TypeVar

from simkit.params import Params
from simkit.scene.model import SceneModel, ScenePlugin, SceneSensor
from simkit.scene.param_paths import set_parameter

T = TypeVar("T")

NAMESPACE: Final = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)
"""Text of a namespace, such as `tb1` or `/fleet/tb1`."""

_GAZEBO_SIM: Final = re.compile(r"(lib)?(gz|ignition)-(sim|gazebo)")
_SHARED_TOPICS: Final = frozenset(("tf_topic", "sub_topic"))
"""Elements that keep their text: `/tf` is shared by all robots, and a `<sub_topic>` is below the name of its model."""


def model_in_namespace(model: SceneModel, namespace: str) -> SceneModel:
    """Return a model with a namespace for its plugins, sensors and nested models.

    Plugins of Gazebo Classic and of simkit get the namespace of their ROS node. Sensors, and plugins of Gazebo Sim,
    get it before each topic that the file names; their default topics contain the name of the model.

    Args:
        model: model.
        namespace: namespace that matches `NAMESPACE`; it replaces the namespaces in the file.
    """
    return _in_namespace(model, namespace.strip("/"))


def _in_namespace(value: T, namespace: str) -> T:
    if isinstance(value, tuple):
        items = tuple(_in_namespace(item, namespace) for item in value)
        is_same = all(new is old for new, old in zip(items, value, strict=True))
        return value if is_same else items  # type: ignore[return-value]
    if not is_dataclass(value) or isinstance(value, type):
        return value
    changed: dict[str, object] = {}
    for field in fields(value):
        before = getattr(value, field.name)
        after = _in_namespace(before, namespace)
        if after is not before:
            changed[field.name] = after
    if isinstance(value, SceneSensor):
        topic = _joined(namespace, value.topic) if value.topic else ""
        changed |= {"topic": topic, "params": _with_topics(value.params, namespace)}
    elif isinstance(value, ScenePlugin):
        is_gazebo_sim = _GAZEBO_SIM.match(value.filename.rpartition("/")[2])
        changed["params"] = (_with_topics if is_gazebo_sim else _with_node_namespace)(value.params, namespace)
    return replace(value, **changed) if changed else value


def _joined(namespace: str, topic: str) -> str:
    return f"/{namespace}/{topic.lstrip('/')}"


def _with_topics(params: Params, namespace: str) -> Params:
    """Return a copy of a block with the namespace before each topic in it; its plugins are left out."""
    block = copy.copy(params)
    is_topic = params.name == "topic" or (params.name.endswith("_topic") and params.name not in _SHARED_TOPICS)
    if params.value and (is_topic or params.name == "robotNamespace"):
        block.value = _joined(namespace, params.value) if is_topic else namespace
    inner = (child if child.name == "plugin" else _with_topics(child, namespace) for child in params.children)
    block.children = list(inner)
    return block


def _with_node_namespace(params: Params, namespace: str) -> Params:
    """Return a copy of a plugin's block with the namespace in the element of ROS 2, or of ROS 1 if the block is such.

    Elements in camel case are those of ROS 1; a block `<ros>` would make them elements of ROS 2.
    """
    names = [child.name for child in params.children]
    is_ros_1 = "ros" not in names and any(name != name.lower() for name in names)
    return set_parameter(params, "robotNamespace" if is_ros_1 else "ros.namespace", namespace, "--spawn")

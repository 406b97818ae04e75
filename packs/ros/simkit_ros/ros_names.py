"""Conversion of the simulation's names to names that ROS 2 accepts."""

from __future__ import annotations

import re

_NAMESPACE = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*/?")
PARAMETER_SERVICES = (
    *("/describe_parameters", "/get_parameter_types", "/get_parameters"),
    *("/list_parameters", "/set_parameters", "/set_parameters_atomically"),
)
"""Ends of the names of a node's parameter services."""
_GLOBAL = frozenset({"/clock", "/parameter_events", "/rosout"})


def is_namespace(text: str) -> bool:
    """Check whether a text is a namespace of ROS 2, with or without a leading slash."""
    return _NAMESPACE.fullmatch(text) is not None and "__" not in text


def ros_name(name: str, namespace: str = "") -> str:
    """Convert an absolute name of the simulation to a valid absolute name of ROS 2.

    Characters that ROS 2 does not accept become `_`, as does a digit's missing prefix: `/world/a.b/2d` becomes
    `/world/a_b/_2d`.

    Args:
        name: name in the simulation.
        namespace: namespace to insert at the front, such as `/robot`; empty for none. The topics that ROS 2 expects
            outside of any namespace, such as `/clock`, get none.
    """
    tokens = [re.sub(r"_{2,}", "_", re.sub(r"[^A-Za-z0-9_]", "_", token)) for token in name.split("/") if token]
    tokens = [f"_{token}" if token[0].isdigit() else token for token in tokens]
    absolute = "/" + "/".join(tokens)
    return absolute if absolute in _GLOBAL else namespace + absolute


def parameter_node(service: str) -> str:
    """Return the node that a parameter service belongs to; empty for another service."""
    return next((service.removesuffix(end) for end in PARAMETER_SERVICES if service.endswith(end)), "")
